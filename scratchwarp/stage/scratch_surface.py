"""The ScratchSurface node to a ScratchSurface record."""

from typing import Any

import numpy as np
from pxr import Usd, UsdShade

from scratchwarp.scene import ScratchSurface, StageError

from .color import color
from .reading import Reading
from .shader_input import constant, is_output, source_of

_ALUMINIUM_ETA = (1.3456, 0.9652, 0.6172)
_ALUMINIUM_K = (7.4746, 6.3995, 5.3031)


def read_scratch_surface(reading: Reading, prim: Usd.Prim) -> ScratchSurface:
    """Read the node's inputs, constants all; StageError names the prim and the value that is out of range."""

    node = UsdShade.Shader(prim)

    def read(name: str, otherwise: Any) -> Any:
        source = source_of(node, name)
        if source is None:
            return otherwise
        if is_output(source):
            where = node.GetInput(name).GetAttr().GetPath()
            reading.warn(where, "inputs of ScratchSurface take no textures; its default is used")
            return otherwise
        return constant(reading, source, otherwise)

    tint = node.GetInput("color")
    albedo = np.array(read("color", (0.0, 0.0, 0.0)), np.float64)
    if tint:
        albedo = color(reading, tint.GetAttr(), albedo)
    try:
        return ScratchSurface(
            base=str(read("base", "conductor")),
            metal=str(read("metal", "aluminium")),
            eta=_triple(read("eta", _ALUMINIUM_ETA)),
            k=_triple(read("k", _ALUMINIUM_K)),
            color=_triple(albedo),
            roughness=float(read("roughness", 0.05)),
            anisotropy=float(read("anisotropy", 0.0)),
            rotation=float(read("anisotropyRotation", 0.0)) * 2 * np.pi,
            ior=float(read("ior", 1.5)),
        )
    except ValueError as error:
        raise StageError(f"{reading.path}: {prim.GetPath()}: {error}") from None


def _triple(values) -> tuple[float, float, float]:
    r, g, b = (float(v) for v in values)
    return r, g, b
