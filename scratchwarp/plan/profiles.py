"""A ScratchProfile record and a layer's size -> the cross-section to simulate."""

import numpy as np

from .. import profiles
from ..scene import Layer, Profile


def cross_section(record: Profile, layer: Layer) -> profiles.Profile:
    """The profile at the layer's aspect (depth over width), in widths.

    Raises ValueError naming the profile prim and the value that cannot be simulated.
    """
    aspect = layer.depth / layer.width if layer.width > 0.0 else 0.0
    values = dict(record.parameters)
    apex = values.get("apex", 0.5)
    floor = {"vGroove": 0.0, "trapezoid": values.get("floorWidth", 0.5)}.get(record.shape)
    try:
        if record.shape == "points":
            assert record.points is not None
            return profiles.Profile(record.points * np.array([1.0, aspect]), isolated=not record.periodic)
        if floor is not None and apex != 0.5:
            left = apex * (1.0 - floor)
            points = np.array([[0.0, 0.0], [left, -1.0], [left + floor, -1.0], [1.0, 0.0]])
            points = points[[True, True, floor > 0.0, True]]
            if record.rim > 0.0:
                points = _with_rims(points, record.rim, record.rim_width)
            return profiles.Profile(points * np.array([1.0, aspect]), isolated=not record.periodic)
        parameters = {}
        if record.shape == "trapezoid":
            parameters["floor"] = values.get("floorWidth", 0.5)
        if record.shape == "gaussian":
            parameters["sigma"] = values.get("sigma", 1.0 / 6.0)
        return profiles.shape(
            record.shape,
            depth=aspect,
            rim=record.rim,
            rim_width=record.rim_width,
            isolated=not record.periodic,
            **parameters,
        )
    except ValueError as error:
        raise ValueError(f"{record.path} (for {layer.label}): {error}") from None


def _with_rims(points: np.ndarray, rim: float, width: float) -> np.ndarray:
    """The groove squeezed between two ridges rim sin^2(pi x / width)."""
    x = np.linspace(0.0, width, 33)
    ridge = np.stack([x, rim * np.sin(np.pi * x / width) ** 2], 1)
    inner = np.stack([width + (1.0 - 2.0 * width) * points[:, 0], points[:, 1]], 1)
    right = np.stack([1.0 - x[::-1], ridge[::-1, 1]], 1)
    return np.concatenate([ridge[:-1], inner, right[1:]])
