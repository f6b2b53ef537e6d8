"""What an author should hear of a scene as a whole."""

from collections.abc import Sequence

from pxr import UsdGeom

from scratchwarp.scene import Instance, Material, Mesh, PreviewSurface, ScratchSurface, TextureInput

from .reading import Reading


def complain(
    reading: Reading, meshes: Sequence[Mesh], instances: Sequence[Instance], materials: Sequence[Material]
) -> None:
    """Warn of missing geometry, uv sets and units where something depends on them."""
    if not instances:
        reading.warn(reading.path, "there is no geometry to render")
    scratched = [m for m in materials if m.layers]
    if scratched and not UsdGeom.StageHasAuthoredMetersPerUnit(reading.stage):
        reading.warn(
            reading.path,
            f"metersPerUnit is not authored; {reading.metres:g} is used, and the size of scratches depends on it",
        )
    seen = set()
    for instance in instances:
        for index in instance.materials:
            if (instance.mesh, index) not in seen:
                seen.add((instance.mesh, index))
                _material(reading, instance.path, meshes[instance.mesh], materials[index])


def _material(reading: Reading, path: str, mesh: Mesh, material: Material) -> None:
    if not mesh.uvs:
        in_uv = [layer.name for layer in material.layers if layer.space == "uv"]
        anisotropic = isinstance(material.surface, ScratchSurface) and material.surface.anisotropy != 0
        if in_uv:
            reading.warn(path, f"layer {in_uv[0]!r} of {material.path} lies in uv space, but there is no primvars:st")
        elif (material.layers or anisotropic) and mesh.tangents is None:
            reading.warn(
                path, f"has no primvars:st; the directions of {material.path} follow a stable fallback tangent"
            )
    for layer in material.layers:
        for name in {layer.mask_primvar, layer.orientation_primvar} - {"", *mesh.primvars}:
            reading.warn(path, f"has no primvars:{name}, which layer {layer.name!r} of {material.path} reads")
        if not mesh.uvs and (layer.mask_texture >= 0 or layer.orientation_texture >= 0):
            reading.warn(path, f"has no primvars:st; the maps of layer {layer.name!r} of {material.path} have no place")
    if isinstance(material.surface, PreviewSurface):
        inputs = [v for v in vars(material.surface).values() if isinstance(v, TextureInput)]
        for missing in sorted({i.uv_set for i in inputs} - set(mesh.uvs)):
            reading.warn(path, f"has no primvars:{missing}, which the textures of {material.path} are read with")
