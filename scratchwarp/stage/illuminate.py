"""All lights of a stage, and the geometry that shines."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from pxr import Usd, UsdLux

from scratchwarp.scene import DomeLight, Instance, Light, Material, Mesh, MeshLight, PreviewSurface, TextureInput

from .light import common, held, radiance
from .light_near import EmittingShape
from .lights import is_mesh_light, linked, read_light
from .material import BLACK, Materials
from .place import check_finite, to_metres
from .reading import Reading
from .texture import Textures
from .traverse import Placed


@dataclass(frozen=True, eq=False)
class Lit:
    """Lights, and the meshes and instances with the shapes of lights added to them."""

    lights: list[Light]
    meshes: list[Mesh]
    instances: list[Instance]


def read_lights(
    reading: Reading,
    places: Sequence[Placed],
    origin: np.ndarray,
    meshes: Sequence[Mesh],
    instances: Sequence[Instance],
    materials: Materials,
    textures: Textures,
) -> Lit:
    """Read every light among ``places``; a stage without any gets an even dome of radiance 1, with a warning."""
    out = Lit([], list(meshes), list(instances))
    paths = [instance.path for instance in instances]
    number = {path: i for i, path in enumerate(paths)}
    for placed in places:
        prim = placed.prim
        if not prim.HasAPI(UsdLux.LightAPI):
            continue
        found: Light | EmittingShape | None
        if is_mesh_light(prim):
            found = _mesh_light(reading, placed, number.get(placed.path), out, materials)
        else:
            check_finite(reading, placed)
            metric = to_metres(reading, placed.world, origin)
            if not metric[:3, :3].any(axis=0).all():
                reading.warn(placed.path, "its transform has a scale of 0; it gives no light")
                continue
            found = read_light(reading, prim, metric, textures)
            if isinstance(found, EmittingShape):
                found = _emitter(found, metric, out, materials)
        if found is None:
            continue
        found = replace(
            found,
            path=placed.path,
            linked=linked(prim, "lightLink", paths),
            shadow_linked=linked(prim, "shadowLink", paths),
        )
        out.lights.append(found)
    if not out.lights:
        reading.warn(reading.path, "the stage has no light; a white dome of radiance 1 lights it")
        out.lights.append(DomeLight(path="", radiance=np.ones(3), camera_visible=False))
    return out


def _emitter(shape: EmittingShape, metric: np.ndarray, out: Lit, materials: Materials) -> MeshLight:
    """Add the shape of a light to the geometry."""
    out.meshes.append(shape.mesh)
    black = materials.fixed(BLACK, "black")
    instance = Instance(shape.mesh.path, len(out.meshes) - 1, metric, (black,), light=len(out.lights))
    out.instances.append(instance)
    return MeshLight(**shape.fields, instance=len(out.instances) - 1)


def _mesh_light(
    reading: Reading, placed: Placed, index: int | None, out: Lit, materials: Materials
) -> MeshLight | None:
    """MeshLightAPI on a mesh.

    materialSyncMode noMaterialResponse makes the mesh black. materialGlowTintsLight multiplies the light by the
    material's emissiveColor and shows the product to every ray; a material without glow leaves the light as it is.
    """
    if index is None:
        return None
    prim = placed.prim
    instance = out.instances[index]
    size = _area(out.meshes[instance.mesh], placed.world)
    emitted = radiance(reading, prim, size)
    mode = str(reading.value(prim, "light:materialSyncMode", "noMaterialResponse"))
    kept = instance.materials
    if mode == "noMaterialResponse":
        kept = tuple(materials.fixed(BLACK, "black") for _ in kept)
    elif mode == "materialGlowTintsLight":
        emitted, kept = _tinted(reading, prim, emitted, kept, materials)
    out.instances[index] = replace(instance, materials=kept, light=len(out.lights))
    return MeshLight(**common(reading, prim), radiance=emitted, instance=index)


def _tinted(
    reading: Reading, prim: Usd.Prim, emitted: np.ndarray, kept: tuple[int, ...], materials: Materials
) -> tuple[np.ndarray, tuple[int, ...]]:
    """(radiance times the material's glow, materials with that glow taken out)."""
    surface = materials.records[kept[0]].surface
    glow = surface.emissive_color if isinstance(surface, PreviewSurface) else (0.0, 0.0, 0.0)
    if isinstance(glow, TextureInput):
        reading.warn(prim.GetPath(), "a textured glow does not tint the light; it shines evenly")
        return emitted, tuple(_unlit(materials, i) for i in kept)
    if not any(glow):
        return emitted, kept
    emitted = emitted * np.array(glow)
    return emitted * held(reading, prim, float(np.abs(emitted).max())), tuple(_unlit(materials, i) for i in kept)


def _unlit(materials: Materials, index: int) -> int:
    """Index of a material's twin that does not glow."""
    material = materials.records[index]
    if not isinstance(material.surface, PreviewSurface):
        return index
    twin: Material = replace(material, surface=replace(material.surface, emissive_color=(0.0, 0.0, 0.0)))
    return materials.fixed(twin, f"unlit {index}")


def _area(mesh: Mesh, world: np.ndarray) -> float:
    """World-space area of a mesh [scene units squared]."""
    p = (mesh.points @ world[:3, :3].T)[mesh.triangles]
    return float(np.linalg.norm(np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0]), axis=1).sum() / 2)
