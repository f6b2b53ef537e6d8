"""A stage as a scene for Mitsuba 3: meshes, camera and lights in its XML, and a BSDF that reflects by our tables.

Files in the folder:
    scene.xml            the scene
    render.py            renders it: python render.py out.exr
    scratch_plugin/      the BSDF
    meshes/*.ply         world metres, relative to the stage's local origin
    materials/*.npz      a material on an instance: its base and its sets of scratches; tables.npz: what they reflect by
    textures/*.exr       of lights
"""

import shutil
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any
from xml.sax.saxutils import quoteattr

import numpy as np

from scratchwarp.scene import DomeLight, Scene

from .baked_look import Look, Nearest, lay_out
from .fates import LEFT_OUT, Fate, lost
from .mitsuba_lights import Node, Vector, emitters

Array = np.ndarray

_RENDER = '''"""Render scene.xml with Mitsuba 3: python render.py [out.exr] [samples a pixel]; needs LLVM."""

import importlib
import sys
from pathlib import Path

import mitsuba as mi

mi.set_variant("llvm_ad_rgb")
here = Path(__file__).parent
sys.path.insert(0, str(here))
importlib.import_module("scratch_plugin.bsdf").register(here)
given = sys.argv[1:]
image = mi.render(mi.load_file(str(here / "scene.xml")), spp=int(given[1]) if len(given) > 1 else 256)
mi.Bitmap(image).write(given[0] if given else "scene.exr")
'''


def write_scene(
    scene: Scene,
    plan: Any,
    tables: Sequence[Any],
    folder: Path,
    longest: int,
    density: float,
    blur: float = 0.0,
    depth: int = 1,
    rough: Mapping[int, Nearest] | None = None,
) -> tuple[list[str], list[dict[str, Any]]]:
    """Write the folder and return what could not be said in Mitsuba's words, and of each layer how we render it
    (``ours``), how the BSDF does (``bsdf``), and whether that is the same.

    ``tables``: the plan's, simulated. ``longest``, ``density``: of ``baked_look.lay_out``. ``blur``: of the cones of
    scratches [rad]. ``depth``: bounces of light, 1 for direct light. ``rough``: material -> the rough surface that is
    written in place of its scratches.
    """  # fmt: skip
    from scratchwarp.kernels.geometry import instance_arrays

    for name in ("meshes", "materials", "textures"):
        (folder / name).mkdir(parents=True, exist_ok=True)
    plugin = Path(__file__).parent / "mitsuba_plugin"
    shutil.copytree(plugin, folder / "scratch_plugin", ignore=shutil.ignore_patterns("__pycache__"), dirs_exist_ok=True)
    (folder / "render.py").write_text(_RENDER, encoding="utf-8")
    write_tables(tables, folder / "materials" / "tables.npz")
    notes: list[str] = []
    fates: dict[str, Fate] = {}
    rough = rough or {}
    nodes: list[tuple[str, dict[str, Any]]] = []
    exposure = scene.camera.exposure
    for number, instance in enumerate(scene.instances):
        mesh = scene.meshes[instance.mesh]
        if not len(mesh.triangles):
            continue
        arrays = instance_arrays(mesh, instance, scene.materials, False)
        for material in np.unique(arrays["material"]):
            stem = f"i{number}m{material}"
            mine = arrays["material"] == material
            write_ply(folder / "meshes" / f"{stem}.ply", *(arrays[name][mine] for name in ("world", "normals", "uv")))
            look = lay_out(scene, plan, int(material), longest, density, number)
            notes += [*look.notes, *lost(look.fates, rough=False)]
            fates |= {fate.layer: fate for fate in look.fates}
            write_material(look, folder / "materials" / f"{stem}.npz", blur, rough.get(int(material)))
            shape: dict[str, Any] = {"filename": f"meshes/{stem}.ply", "bsdf": _bsdf(look, stem, notes)}
            if instance.light >= 0:
                shape["emitter"] = ("emitter area", {"radiance": exposure * scene.lights[instance.light].radiance})
            elif np.asarray(look.base["emissive"]).max() > 0.0:
                glow = np.asarray(look.base["emissive"]).reshape(-1, 3).mean(0) * exposure
                shape["emitter"] = ("emitter area", {"radiance": glow})
            nodes.append(("shape ply", shape))
    nodes += emitters(scene, folder, notes)
    hidden = any(isinstance(light, DomeLight) and not light.camera_visible for light in scene.lights)
    how = {"hide_emitters": hidden}
    path = ("integrator path", {"max_depth": depth + 1, "rr_depth": 1000, **how})
    document = {
        "integrator": ("integrator direct", how) if depth == 1 else path,
        "sensor": camera(scene, plan, notes),
    }
    (folder / "scene.xml").write_text(xml([*document.values(), *nodes]), encoding="utf-8")
    rows = [
        {
            "layer": fate.layer,
            "ours": fate.ours,
            "bsdf": fate.baked if fate.baked == LEFT_OUT or fate.ours != "Lambert" else fate.ours,
            "same": fate.baked != LEFT_OUT and fate.ours in ("table", "Lambert") and not fate.differs,
        }
        for fate in fates.values()
    ]
    return list(dict.fromkeys(notes)), rows


def _bsdf(look: Look, stem: str, notes: list[str]) -> Node:
    node: Node = ("bsdf twosided", {"nested": ("bsdf scratchwarp", {"data": f"materials/{stem}.npz"})})
    opacity = float(np.asarray(look.base["opacity"]).mean())
    if opacity < 1.0:
        if np.ndim(look.base["opacity"]):
            notes.append(f"{look.path}: its opacity counts with its mean")
        node = ("bsdf mask", {"opacity": opacity, "nested": node})
    if look.base["normal"] is not None:
        notes.append(f"{look.path}: its normal map is left out")
    return node


def write_material(look: Look, file: Path, blur: float, rough: Nearest | None = None) -> None:
    """One archive of the plugin: the base, and the shares and directions of its sets of scratches; or the base and the
    ``rough`` surface that stands for them."""
    base = look.base
    turn = (np.cos(2.0 * base["rotation"]), np.sin(2.0 * base["rotation"]))
    skew = base["anisotropy"]
    data = _surface(look, base["color"], base["metallic"], np.asarray(base["alpha"], float), skew) | {"turn": turn}
    if rough is not None:
        second = file.with_name(f"{file.stem}_rough.npz")
        own = np.asarray(base["color"], float).reshape(-1, 3).mean(0)
        metallic = float(np.mean(base["metallic"]))
        color = (1 - rough.matte) * (metallic * rough.color + (1 - metallic) * own) + rough.matte * rough.matte_color
        over = _surface(look, color, metallic * (1 - rough.matte), rough.wide, 0.0)
        over |= {"turn": rough.two, "alpha": np.stack([rough.wide, rough.narrow], -1), "fresnel": 0}
        _save(second, over)
        _save(file, data | {"fresnel": min(base["fresnel"], 0), "second": second.name, "coverage": rough.coverage})
        return
    plans = [laid.plan for laid in look.layers]
    data |= {
        "table": np.array([p.table if not p.lambert else -1 for p in plans], np.int32),
        "weight": np.array([p.weight for p in plans]),
        "keeps": np.array([p.keeps_diffuse for p in plans]),
        "albedo": np.array([p.diffuse for p in plans]).reshape(-1, 3),
        "share": np.zeros(0),
        "two": np.zeros((0, 2)),
        "blur": blur,
        "tables": "tables.npz",
    }
    if plans:
        shares = np.stack([laid.share for laid in look.layers], -1)
        data["share"] = shares if np.ptp(shares.reshape(-1, len(plans)), axis=0).max() > 1e-4 else shares[0, 0]
        twos = np.stack([laid.two for laid in look.layers], -2)
        turned = np.ptp(twos.reshape(-1, len(plans), 2), axis=0).max() > 0.02
        data["two"] = twos if turned else np.stack([_mean_two(x.two) for x in look.layers])
    _save(file, data)


def _surface(look: Look, color: Any, metallic: Any, alpha: Array, skew: float) -> dict[str, Any]:
    """The lobes of a surface without scratches."""
    base, color = look.base, np.asarray(color, float)
    metallic = np.asarray(metallic, float)[..., None]
    r2 = min(((1 - base["ior"]) / (1 + base["ior"])) ** 2, 1.0)
    data: dict[str, Any] = {
        "fresnel": base["fresnel"], "ior": base["ior"], "specular": base["specular"],
        "clearcoat": float(np.mean(base["clearcoat"])), "clearcoat_alpha": float(np.mean(base["clearcoat_alpha"])),
        "clearcoat_f0": r2, "eta": base["eta"], "k": base["k"], "diffuse": color * (1 - metallic),
        "window": look.window, "scale": look.scale,
    }  # fmt: skip
    if base["specular_color"] is not None:
        data |= {"diffuse": color, "f0": base["specular_color"], "f90": np.ones(3)}
    else:
        data["f90"] = 1 + metallic * (color - 1)
        data["f0"] = (r2 + metallic * (1 - r2)) * data["f90"]
    data["alpha"] = np.stack([np.minimum(alpha * (1 + skew), 1.0), np.minimum(alpha * (1 - skew), 1.0)], -1)
    for name in ("diffuse", "f0", "f90"):
        data[name] = _map(data[name], 3)
    return data


def _save(file: Path, data: Mapping[str, Any]) -> None:
    arrays = {name: np.asarray(value) for name, value in data.items()}
    narrow: Any = {name: a.astype(np.float32) if a.dtype == np.float64 else a for name, a in arrays.items()}
    np.savez_compressed(file, **narrow)


def _mean_two(two: Array) -> Array:
    mean = two.reshape(-1, 2).mean(0)
    return mean / max(float(np.linalg.norm(mean)), 1e-12)


def _map(values: Any, channels: int) -> Array:
    values = np.asarray(values, float)
    return np.broadcast_to(values, (*values.shape[:2], channels)) if values.ndim == 3 else np.broadcast_to(values, 3)


def write_tables(tables: Sequence[Any], file: Path) -> None:
    """The tables as the renderer packs them."""
    from scratchwarp.reflectance.profile_table import pack

    packed = pack(tables)
    names = ("mirror", "cdf", "slices", "first", "steps", "shift")
    np.savez_compressed(file, **{name: getattr(packed, name).numpy() for name in names})


def write_ply(file: Path, world: Array, normals: Array, uv: Array) -> None:
    """Triangles [m, 3, 3] with normals and uv at each corner, binary."""
    count = 3 * len(world)
    rows = np.concatenate([world.reshape(count, 3), normals.reshape(count, 3), uv.reshape(count, 2)], 1)
    faces = np.zeros(len(world), dtype=[("n", "u1"), ("v", "<i4", 3)])
    faces["n"], faces["v"] = 3, np.arange(count, dtype=np.int32).reshape(-1, 3)
    names = "".join(f"property float {name}\n" for name in ("x", "y", "z", "nx", "ny", "nz", "u", "v"))
    head = f"ply\nformat binary_little_endian 1.0\nelement vertex {count}\n{names}element face {len(world)}\n"
    head += "property list uchar int vertex_indices\nend_header\n"
    file.write_bytes(head.encode("ascii") + rows.astype("<f4").tobytes() + faces.tobytes())


def _filter(settings: Any) -> Node:
    """The pixel filter: a Gaussian of the same variance stands for the Blackman-Harris window."""
    if settings.filter == "box":
        return "rfilter box", {"radius": 0.5 * settings.filter_width}
    return "rfilter gaussian", {"stddev": settings.filter_width * (0.1388 if settings.filter != "gaussian" else 1 / 6)}


def camera(scene: Scene, plan: Any, notes: list[str]) -> Node:
    """The sensor that sees what ours does."""
    c = scene.camera
    width, height = plan.size
    left, right, bottom, top = c.window(width, height, scene.options.conform, scene.options.pixel_aspect)
    place = c.transform @ np.diag([-1.0, 1.0, -1.0, 1.0])
    film = ("film hdrfilm", {
        "width": width, "height": height, "rfilter": _filter(plan.settings), "pixel_format": "rgb",
        "component_format": "float32",
    })  # fmt: skip
    shared = {"near_clip": max(c.near, 1e-4), "far_clip": min(c.far, 1e7), "film": film, "sampler": _SAMPLER}
    if abs((right - left) * height - (top - bottom) * width) > 1e-3 * (right - left) * height:
        notes.append(f"{c.path}: pixels that are no squares are shown as squares")
    if c.projection == "orthographic":
        half = 0.5 * (right - left)
        shift = np.eye(4)
        shift[:2, 3] = 0.5 * (left + right), 0.5 * (bottom + top)
        turned = c.transform @ shift @ np.diag([-half, half, -1.0, 1.0])
        return "sensor orthographic", {"to_world": turned, **shared}
    own: dict[str, Any] = {"fov": float(np.degrees(2 * np.arctan(0.5 * (right - left)))), "fov_axis": "x"}
    off = -0.5 * (left + right) / (right - left), 0.5 * (top + bottom) / (top - bottom)
    if max(abs(off[0]), abs(off[1])) > 1e-6:
        own |= {"principal_point_offset_x": off[0], "principal_point_offset_y": off[1]}
    if c.lens_radius > 0.0 and plan.on("lens"):
        lens = {"aperture_radius": c.lens_radius, "focus_distance": c.focus_distance}
        return "sensor thinlens", {"to_world": place, **own, **lens, **shared}
    return "sensor perspective", {"to_world": place, **own, **shared}


_SAMPLER: Node = ("sampler multijitter", {"sample_count": 256})


def xml(nodes: Sequence[Node]) -> str:
    """A Mitsuba scene file of nested nodes; arrays of 3 are colours, 4 x 4 are transforms."""
    lines = ['<?xml version="1.0" encoding="utf-8"?>', '<scene version="3.0.0">']
    for node in nodes:
        lines += _lines(node, None, 1)
    return "\n".join([*lines, "</scene>", ""])


def _lines(value: Any, name: str | None, depth: int) -> list[str]:
    pad = "  " * depth
    said = f" name={quoteattr(name)}" if name else ""
    if isinstance(value, tuple) and len(value) == 2 and isinstance(value[1], Mapping):
        tag, _, plugin = value[0].partition(" ")
        own = f" name={quoteattr(name)}" if name and name in ("to_world", "radiance") else ""
        inner = [line for key, part in value[1].items() for line in _lines(part, key, depth + 1)]
        return [f"{pad}<{tag} type={quoteattr(plugin)}{own}>", *inner, f"{pad}</{tag}>"]
    if isinstance(value, bool | np.bool_):
        return [f'{pad}<boolean{said} value="{str(bool(value)).lower()}"/>']
    if isinstance(value, int | np.integer):
        return [f'{pad}<integer{said} value="{value}"/>']
    if isinstance(value, float | np.floating):
        return [f'{pad}<float{said} value="{float(value)!r}"/>']
    if isinstance(value, Vector):
        return [f"{pad}<{'vector' if name == 'direction' else 'point'}{said} value={quoteattr(value)}/>"]
    if isinstance(value, str):
        return [f"{pad}<string{said} value={quoteattr(value)}/>"]
    array = np.asarray(value, float)
    text = " ".join(repr(float(x)) for x in array.ravel())
    if array.shape == (4, 4):
        return [f"{pad}<transform{said}>", f'{pad}  <matrix value="{text}"/>', f"{pad}</transform>"]
    return [f'{pad}<rgb{said} value="{text}"/>']
