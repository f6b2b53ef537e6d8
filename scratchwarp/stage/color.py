"""Colours of a stage in linear Rec.709, the space everything is rendered in."""

from functools import cache

import numpy as np
from numpy.typing import ArrayLike
from pxr import Gf, Usd

from .reading import Reading

RENDERING_SPACE = "lin_rec709_scene"
UNTOUCHED = ("", "raw", "data", "identity", "unknown", RENDERING_SPACE)


def space_of(attribute: Usd.Attribute) -> str:
    """Name of the attribute's colour space: its own metadata, else ColorSpaceAPI's on the nearest ancestor, else ""."""
    return str(Usd.ColorSpaceAPI.ComputeColorSpaceName(attribute, None) or "")


def to_rec709(values: ArrayLike, space: str) -> np.ndarray:
    """Convert colours [..., 3] from a USD colour space; ValueError on a name that USD does not know.

    The transfer curve (a power with a linear toe, as Gf.ColorSpace describes it) is undone, then the primaries are
    changed through CIE XYZ.
    """
    colors = np.asarray(values, dtype=np.float64)
    if space in UNTOUCHED:
        return colors
    gamma, bias, matrix = _definition(space)
    if gamma != 1.0:
        colors = _linear(colors, gamma, bias)
    return colors @ matrix.T


def color(reading: Reading, attribute: Usd.Attribute, values: ArrayLike) -> np.ndarray:
    """Colours [..., 3] of an attribute in linear Rec.709; an unknown space leaves them, with a warning."""
    space = space_of(attribute)
    try:
        return to_rec709(values, space)
    except ValueError as error:
        reading.warn(attribute.GetPath(), f"{error}; the values are taken as linear Rec.709")
        return np.asarray(values, dtype=np.float64)


@cache
def _definition(space: str) -> tuple[float, float, np.ndarray]:
    """(gamma, linear bias, matrix to linear Rec.709)."""
    if not Gf.ColorSpace.IsValid(space):
        raise ValueError(f"colour space {space!r} is not known to USD")
    source = Gf.ColorSpace(space)
    to_xyz = np.asarray(source.GetRGBToXYZ(), dtype=np.float64)
    from_xyz = np.linalg.inv(np.asarray(Gf.ColorSpace(RENDERING_SPACE).GetRGBToXYZ(), dtype=np.float64))
    return source.GetGamma(), source.GetLinearBias(), from_xyz @ to_xyz


def _linear(values: np.ndarray, gamma: float, bias: float) -> np.ndarray:
    """Undo a transfer curve ((v + bias) / (1 + bias)) ** gamma with its tangent line below the join."""
    if bias <= 0.0:
        return np.sign(values) * np.abs(values) ** gamma
    join = bias / (gamma - 1.0)
    slope = (1 + bias) ** gamma * (gamma - 1.0) ** (gamma - 1.0) / (bias ** (gamma - 1.0) * gamma**gamma)
    curve = ((np.maximum(values, 0.0) + bias) / (1 + bias)) ** gamma
    return np.where(values <= join, values / slope, curve)
