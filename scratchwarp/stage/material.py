"""UsdShade materials: the surface, the scratches on it, and what stands in for networks that cannot be rendered."""

from pxr import Usd, UsdShade

from scratchwarp.scene import Material, PreviewSurface, ScratchSurface

from .curves import CurveSets
from .layer import read_layers, read_wave
from .measured import read_measured
from .preview import read_preview
from .reading import Reading, shared_path
from .scratch_surface import read_scratch_surface
from .texture import Textures

RENDER_CONTEXT = "scratchwarp"

UNBOUND = Material(path="", uses_display_color=True)
"""Of geometry without a material: the default UsdPreviewSurface in the geometry's displayColor."""

BLACK = Material(path="", surface=ScratchSurface(base="diffuse", color=(0.0, 0.0, 0.0)))
"""Of the shapes of lights, which reflect nothing."""


class Materials:
    """Materials read so far, each once; ``records`` become ``Scene.materials``."""

    def __init__(self, reading: Reading, textures: Textures, curves: CurveSets) -> None:
        self.records: list[Material] = []
        self._reading, self._textures, self._curves = reading, textures, curves
        self._known: dict[str, int] = {}

    def index(self, prim: Usd.Prim | None) -> int:
        """Index of the material of a prim (None: unbound), read when first asked for."""
        if prim is None:
            return self.fixed(UNBOUND, "unbound")
        key = shared_path(prim)
        if key not in self._known:
            return self.fixed(read_material(self._reading, prim, self._textures, self._curves), key)
        return self._known[key]

    def fixed(self, material: Material, key: str) -> int:
        """Index of a material that no prim describes."""
        if key not in self._known:
            self._known[key] = len(self.records)
            self.records.append(material)
        return self._known[key]


def read_material(reading: Reading, prim: Usd.Prim, textures: Textures, curves: CurveSets) -> Material:
    """Read a UsdShadeMaterial.

    ``outputs:scratchwarp:surface`` goes before ``outputs:surface``. A network whose surface node is neither
    ScratchSurface nor UsdPreviewSurface is replaced, with a warning, by the default UsdPreviewSurface in displayColor.
    """
    surface, colored = _surface(reading, prim, textures)
    return Material(
        path=str(prim.GetPath()),
        surface=surface,
        layers=read_layers(reading, prim, curves, textures),
        wave=read_wave(reading, prim),
        uses_display_color=colored,
        measured=read_measured(reading, prim),
    )


def _surface(reading: Reading, prim: Usd.Prim, textures: Textures) -> tuple[PreviewSurface | ScratchSurface, bool]:
    """(surface, whether displayColor is its diffuse colour)."""
    material = UsdShade.Material(prim)
    shader, _, _ = material.ComputeSurfaceSource(RENDER_CONTEXT)
    path = prim.GetPath()
    if not shader:
        contexts = sorted({o.GetBaseName().rpartition(":")[0] for o in material.GetSurfaceOutputs()} - {""})
        only = f" (only one for {', '.join(contexts)})" if contexts else ""
        reading.warn(path, f"has no surface that can be rendered{only}; a grey UsdPreviewSurface stands in")
        return PreviewSurface(), True
    kind = str(shader.GetShaderId() or "")
    if kind == "UsdPreviewSurface":
        return read_preview(reading, shader.GetPrim(), textures)
    if kind == "ScratchSurface":
        return read_scratch_surface(reading, shader.GetPrim()), False
    reading.warn(path, f"its surface node {kind or shader.GetPath()} is not known; a grey UsdPreviewSurface stands in")
    return PreviewSurface(), True
