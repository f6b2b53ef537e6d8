"""Scene + EffectPlan + simulated tables -> the kernel's key and arguments."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import warp as wp

from .. import lights
from ..lights.light_device import Light
from ..plan import EffectPlan
from ..plan.choice import LayerPlan
from ..plan.knobs import turned, value
from ..reflectance import profile_table
from ..reflectance.responses import RESPONSES
from ..reflectance.responses.pack import pack as pack_responses
from ..reflectance.texture import pack_textures
from ..scene import MeshLight, Scene
from ..scene.digest import digest
from ..scene.light import Light as LightRecord
from ..scratches import KINDS, curves
from ..scratches.knobs import FOOTPRINTS
from . import geometry, glints, grooves, highlights, maps, material
from .camera_device import CameraData
from .key import KernelKey
from .parts import Parts
from .world_device import LightSet, ScratchSet


@dataclass(frozen=True, eq=False)
class Assembled:
    """What a render launches.

    Attributes:
        key: specialisation. inputs: arguments after the window and before the film, in the kernel's order.
        alive: objects that must outlive the launches. warnings: what cannot be honoured. numbers: of what was built,
            for ``Film.stats``.
    """

    key: KernelKey
    inputs: tuple[Any, ...]
    alive: tuple[Any, ...]
    warnings: tuple[str, ...]
    numbers: Mapping[str, int] = field(default_factory=dict)


def light_kinds(plan: EffectPlan) -> tuple[str, ...]:
    """Kinds of light that are on, in the registry's order."""
    return tuple(m.name for m in lights.MODELS.values() if plan.on(f"lights.{m.name}"))


def uneven(light: LightRecord) -> bool:
    """Whether the radiance of a light that is integrated along cones varies over its extent."""
    return lights.MODELS[type(light)].arcs is not None and (
        light.shaping is not None or getattr(light, "texture", -1) >= 0
    )


def kernel_key(scene: Scene, plan: EffectPlan) -> KernelKey:
    """The specialisation that a plan calls for; effects that are off leave no trace in it."""
    on = plan.on
    kinds = light_kinds(plan)
    distributions = tuple(k for k in KINDS if on(f"scratches.{k}")) if on("scratches") else ()
    assert plan.settings.filter is not None
    return KernelKey(
        lights=kinds,
        distributions=distributions,
        filter=plan.settings.filter,
        directed=on("base.direction"),
        lens=on("lens"),
        orthographic=scene.camera.projection == "orthographic",
        shadows=on("shadows"),
        opacity=on("base.opacity"),
        emission=on("base.emission"),
        normal_maps=on("base.normalMaps"),
        display_colors=on("base.displayColor"),
        textures=on("base.textures"),
        preview=on("base.preview"),
        measured=on("base.measured"),
        diffuse_scratches=bool(distributions) and on("scratches.diffuse"),
        sum_coverage=bool(distributions) and on("scratches.sumCoverage"),
        variation=bool(distributions) and on("scratches.variation"),
        masks=bool(distributions) and on("scratches.masks"),
        tints=bool(distributions) and on("scratches.textured"),
        orientations=bool(distributions) and on("scratches.orientation"),
        light_links=on("lights.links"),
        light_multipliers=on("lights.multipliers"),
        mesh_lights="mesh" in kinds,
        path=on("indirect"),
        highlights=on("highlights"),
        **_glint_fields(plan),
        grooves=on("grooves"),
        groove_crossings=on("grooves") and on("grooves.crossings"),
        groove_handover=on("grooves") and on("grooves.handover"),
        groove_tapers=on("grooves") and on("grooves.tapers"),
        groove_bounces=on("grooves") and on("grooves.interreflection"),
        groove_glass=on("grooves") and on("grooves.transmission") and on("base.opacity"),
        responses=tuple(n for n, r in RESPONSES.items() if on(r.effect) and (distributions or r.base)),
        closed_form=bool(distributions) and on("lights.closedForm"),
        cone_taps=bool(distributions) and on("lights.closedForm") and any(uneven(light) for light in scene.lights),
        small_lights=bool(distributions) and on("lights.closedForm") and on("lights.small"),
        sample_lights=bool(distributions) and on("lights.sampleLights"),
        sample_cones=bool(distributions) and on("lights.sampleCones"),
    )


def _glint_fields(plan: EffectPlan) -> dict[str, Any]:
    """What of diffraction is compiled."""
    if not plan.on("diffraction"):
        return {}
    segments = plan.on("diffraction.segments")
    crowds = segments and plan.on("diffraction.crowds")
    method = "closed-form" if plan.on("diffraction.closedForm") else "slices"
    ways = ("paper", "exact", "point")
    footprint = next((way for way in ways if plan.on(f"diffraction.{way}Footprint")), "gaussian")
    return {
        "glints": True,
        "glint_footprint": footprint,
        "glint_segments": segments,
        "glint_lists": segments and plan.on("diffraction.lists") and not crowds,
        "glint_hierarchy": crowds or segments and plan.on("diffraction.hierarchy"),
        "glint_crowds": crowds,
        "glint_bands": plan.on("diffraction.bands"),
        "glint_gratings": plan.on("diffraction.bands") and plan.on("diffraction.coherent"),
        "glint_fringes": plan.on("diffraction.distantLookup"),
        "glint_lookup": plan.on("diffraction.lookup") and not plan.on("diffraction.paperLights"),
        "glint_numeric": plan.on("diffraction.outlines") or plan.on("diffraction.angles"),
        "glint_areas": plan.on("diffraction.areaLights"),
        "glint_pairs": segments and plan.on("diffraction.pairs"),
        "glint_paths": plan.on("indirect"),
        "glint_masks": plan.on("diffraction.masks"),
        "glint_orientations": plan.on("diffraction.bands") and plan.on("diffraction.orientation"),
        "glint_method": "paper" if plan.on("diffraction.paperLights") else method,
    }


def camera_data(scene: Scene, plan: EffectPlan) -> CameraData:
    """The camera's window over the whole image, with the footprint of one of the plan's samples."""
    camera, (width, height) = scene.camera, plan.size
    left, right, bottom, top = camera.window(width, height, scene.options.conform, scene.options.pixel_aspect)
    c = CameraData()
    m = camera.transform
    c.position = wp.vec3(*m[:3, 3].tolist())
    c.right, c.up, c.back = (wp.vec3(*(m[:3, k] / np.linalg.norm(m[:3, k])).tolist()) for k in range(3))
    c.left, c.top = left, top
    c.pixel_x, c.pixel_y = (right - left) / width, (top - bottom) / height
    c.near, c.far = max(camera.near, 0.0), min(camera.far, 1e10)
    c.lens_radius = camera.lens_radius if plan.on("lens") else 0.0
    c.focus_distance, c.exposure = camera.focus_distance, camera.exposure
    assert plan.settings.spp is not None
    # samples share the pixel: each stands for an area of 1 / spp of it
    c.footprint = FOOTPRINTS[str(value(plan.settings.knobs, "scratches.coverageFilter"))]
    c.footprint = c.footprint or 1.0 / np.sqrt(plan.settings.spp)
    return c


def assemble(
    scene: Scene,
    plan: EffectPlan,
    tables: Sequence[Any],
    device: str = "cpu",
    parts: Parts | None = None,
    progress: Callable[[int, int, str], None] | None = None,
) -> Assembled:
    """Build the device data that the plan's effects need, and nothing else.

    ``parts``: what was built for an earlier scene or plan on this device; what is the same is taken from there.
    ``progress``: called with (done, total, what) by what takes long.
    """
    changing = parts is not None
    parts = parts or Parts()
    key = kernel_key(scene, plan)
    with_mesh_lights = any(isinstance(r, MeshLight) for r in scene.lights)
    placed = tuple((i.mesh, i.transform.tobytes(), i.materials, i.light) for i in scene.instances)
    filtered = key.cone_taps or (key.glints and "dome" in key.lights)
    packed = parts.part(
        "lights",
        (digest(scene.lights), scene.textures, (placed, scene.meshes) if with_mesh_lights else (), filtered),
        lambda: lights.pack(scene, device, filtered=filtered),
    )
    kinds = [k for k in packed.kinds if k in key.lights]
    order = {name: i for i, name in enumerate(key.lights)}
    row_type: Any = Light
    rows = [packed.lights[k].numpy() if k in kinds else np.zeros(0, row_type.numpy_dtype()) for k in key.lights]
    starts = np.concatenate([[0], np.cumsum([len(r) for r in rows])]).astype(np.int32)
    flat = np.full(max(len(scene.lights), 1), -1, np.int32)
    for number, (record, slot) in enumerate(zip(scene.lights, packed.slots, strict=True)):
        name = lights.MODELS[type(record)].name
        if name in order:
            flat[number] = starts[order[name]] + slot
    table = np.concatenate(rows) if len(rows) and starts[-1] else np.zeros(1, row_type.numpy_dtype())
    links = np.ones((max(len(scene.lights), 1), max(len(scene.instances), 1)), np.uint8)
    for number, record in enumerate(scene.lights):
        if record.linked is not None:
            links[number] = [i in record.linked for i in range(links.shape[1])]

    emitters = {r.instance: int(flat[n]) for n, r in enumerate(scene.lights) if isinstance(r, MeshLight)}
    shape = parts.part(
        "geometry",
        (
            scene.meshes,
            placed,
            tuple(geometry.uv_set(m) for m in scene.materials),
            key.directed,
            key.display_colors,
            tuple(sorted(emitters.items())),
        ),
        lambda: geometry.pack(scene, key.directed, key.display_colors, emitters, device),
    )
    explicit = scene.curves if "curves" in key.distributions else ()
    strokes, sets = parts.part(
        "curves", (explicit, key.variation), lambda: curves.pack(explicit, device, key.variation)
    )
    atlas = parts.part(
        "textures", (scene.textures,), lambda: pack_textures([t.pixels for t in scene.textures], device=device)
    )

    def layers() -> material.PackedMaterials:
        packed_layers = None
        if key.distributions:
            numbers = iter(range(sum(len(own) for own in plan.layers)))

            def packed_layer(p: LayerPlan) -> Any:
                strip = sets[p.sublayer.curves] if p.sublayer.curves >= 0 else None
                return material.pack_layer(p, strip, next(numbers) if maps.has_maps(p.sublayer.layer) else -1)

            packed_layers = [[packed_layer(p) for p in own] for own in plan.layers]
        bases = {n: (r, plan.responses[r].albedo) for n, r in enumerate(plan.bases) if r >= 0 and key.responses}
        return material.pack(scene, packed_layers or [[] for _ in scene.materials], atlas, device, bases, glass)

    glass = {n for n, own in enumerate(plan.grooves) if own is not None and own.refracts and key.groove_glass}
    described = digest(scene.materials, plan.layers, plan.bases, key, sorted(glass))
    stuff = parts.part("layers", (described, scene.textures, explicit), layers)
    light_set, scratch_set = LightSet(), ScratchSet()
    light_set.lights = wp.array(table, dtype=Light, device=device)
    light_set.starts = wp.array(starts, dtype=int, device=device)
    light_set.links = wp.array(links, dtype=wp.uint8, device=device)
    light_set.arrays = packed.arrays
    light_set.taps = plan.settings.cone_taps or 1
    light_set.tap_width = 0.125 / (plan.settings.spp or 1)
    scratch_set.layers, scratch_set.segments = stuff.layers, strokes
    last = parts.last("tables")
    earlier = None if last is None or last[0][0] != key.closed_form else (last[0][1:], last[1])
    scratch_set.tables = parts.part(
        "tables",
        (key.closed_form, *tables),
        lambda: profile_table.pack(tables, device, earlier, key.closed_form, roomy=changing),
    )
    used = plan.responses if key.responses else ()
    responding = parts.part(
        "responses", (digest(used), scene.textures), lambda: pack_responses(used, device, scene.textures)
    )
    scratch_set.responses = responding.arrays
    scratch_set.maps = parts.part(
        "maps",
        maps.sources(scene, plan.layers, placed, key.masks, key.orientations),
        lambda: maps.pack_maps(scene, plan.layers, shape.arrays, key.masks, key.orientations, device),
    )
    scratch_set.variations = material.pack_variations(plan.layers if key.variation else (), device)
    waved = tuple(tuple(x.layer.label for x in w.layers) if w is not None else () for w in plan.waves)
    knobs = plan.settings.knobs
    sliced = sorted((turned(knobs, "wave") | turned(knobs, "glint")).items())
    crowded = plan.effects["diffraction.crowds"].prims if key.glint_crowds else ()
    sparkle = parts.part(
        "glints",
        (digest(scene.materials, key, waved, sliced, crowded), scene.curves, scene.meshes, scene.textures, placed)
        if key.glints
        else (),
        lambda: glints.pack(scene, plan, key, shape, device, progress),
    )
    scratch_set.glints = sparkle.arrays
    laid = tuple(tuple((x.layer.label, x.slack) for x in w.layers) if w is not None else () for w in plan.grooves)
    cut_by = (plan.settings.spp, sorted(turned(plan.settings.knobs, "groove").items()), laid)
    cut = parts.part(
        "grooves",
        (digest(plan.grooves, key, cut_by), scene.curves, scene.meshes, placed) if key.grooves else (),
        lambda: grooves.pack(scene, plan, key, shape, device),
    )
    scratch_set.grooves = cut.arrays
    numbers = dict(cut.numbers)
    camera = camera_data(scene, plan)
    if key.highlights:
        corners = packed.arrays.triangles.numpy() if key.mesh_lights else np.zeros((0, 3))
        light_set.highlights, numbers["highlights"] = highlights.pack(
            highlights.View(camera, key.orthographic),
            plan,
            shape,
            stuff.arrays.materials,
            highlights.lamps(key.lights, table, starts, corners),
            device,
        )
    inputs = (camera, shape.arrays, stuff.arrays, scratch_set, light_set)
    return Assembled(key, inputs, (shape, stuff, packed, sets, sparkle, responding, cut), packed.warnings, numbers)
