"""The ScratchSurface node to a ScratchSurface record."""

import numpy as np
from pxr import Usd, UsdShade

from scratchwarp.scene import ScratchSurface, StageError

from .color import color
from .reading import Reading, fits

_ALUMINIUM_ETA = (1.3456, 0.9652, 0.6172)
_ALUMINIUM_K = (7.4746, 6.3995, 5.3031)


def read_scratch_surface(reading: Reading, prim: Usd.Prim) -> ScratchSurface:
    """Read the node's inputs, constants all; StageError names the prim and the value that is out of range."""

    def constant(name: str, otherwise):
        given = UsdShade.Shader(prim).GetInput(name)
        if not given:
            return otherwise
        sources = given.GetValueProducingAttributes()
        if not sources:
            return otherwise
        if UsdShade.Utils.GetType(sources[0].GetName()) == UsdShade.AttributeType.Output:
            reading.warn(given.GetAttr().GetPath(), "inputs of ScratchSurface take no textures; its default is used")
            return otherwise
        got = sources[0].Get(reading.time)
        if got is not None and not fits(got, otherwise):
            reading.warn(sources[0].GetPath(), f"holds {got!r}, which is of the wrong type; {otherwise} is used")
            return otherwise
        return otherwise if got is None else got

    tint = UsdShade.Shader(prim).GetInput("color")
    albedo = np.array(constant("color", (0.0, 0.0, 0.0)), np.float64)
    if tint:
        albedo = color(reading, tint.GetAttr(), albedo)
    try:
        return ScratchSurface(
            base=str(constant("base", "conductor")),
            metal=str(constant("metal", "aluminium")),
            eta=_triple(constant("eta", _ALUMINIUM_ETA)),
            k=_triple(constant("k", _ALUMINIUM_K)),
            color=_triple(albedo),
            roughness=float(constant("roughness", 0.05)),
            anisotropy=float(constant("anisotropy", 0.0)),
            rotation=float(constant("anisotropyRotation", 0.0)) * 2 * np.pi,
            ior=float(constant("ior", 1.5)),
        )
    except ValueError as error:
        raise StageError(f"{reading.path}: {prim.GetPath()}: {error}") from None


def _triple(values) -> tuple[float, float, float]:
    r, g, b = (float(v) for v in values)
    return r, g, b
