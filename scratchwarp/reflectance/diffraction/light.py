"""The area lights that Python describes, in the tangent frame of the shading point."""

from dataclasses import dataclass
from typing import Any

from .inputs import common_shape, numbers, vectors


@dataclass(frozen=True, eq=False)
class SphereLight:
    """Spheres of radiance 1: ``center`` ``[..., 3]`` and ``radius`` ``[...]`` >= 0 in any one unit of length, the
    shading point at the origin and its normal +z. One that contains the origin surrounds it. Raises ValueError."""

    center: Any
    radius: Any

    def __post_init__(self) -> None:
        object.__setattr__(self, "center", vectors("center", self.center))
        object.__setattr__(self, "radius", numbers("radius", self.radius, least=0.0))
        _ = self.shape

    @property
    def shape(self) -> tuple[int, ...]:
        """Leading shape."""
        return common_shape(center=self.center.shape[:-1], radius=self.radius.shape)


@dataclass(frozen=True, eq=False)
class PolygonLight:
    """Simple polygons of radiance 1 on both sides: ``vertices`` ``[..., k, 3]``, k >= 3, in order either way round, in
    any one unit of length, the shading point at the origin and its normal +z. Concave ones are allowed; one that is
    seen edge-on or has no area gives nothing. Raises ValueError."""

    vertices: Any

    def __post_init__(self) -> None:
        vertices = vectors("vertices", self.vertices)
        if vertices.ndim < 2 or vertices.shape[-2] < 3:
            raise ValueError(f"vertices must have shape [..., k, 3] with k >= 3, got {list(vertices.shape)}")
        object.__setattr__(self, "vertices", vertices)

    @property
    def shape(self) -> tuple[int, ...]:
        """Leading shape."""
        return self.vertices.shape[:-2]


@dataclass(frozen=True, eq=False)
class DomeLight:
    """Light from all around: ``values`` ``[h, w]``, radiance >= 0, constant within its cells. Rows run from the normal
    +z down to -z, columns around from +x over +y, both in even angles. Raises ValueError."""

    values: Any

    def __post_init__(self) -> None:
        values = numbers("values", self.values, least=0.0)
        if values.ndim != 2 or 0 in values.shape:
            raise ValueError(f"values must have shape [h, w], got {list(values.shape)}")
        object.__setattr__(self, "values", values)

    @property
    def shape(self) -> tuple[int, ...]:
        """Leading shape: none."""
        return ()


Light = SphereLight | PolygonLight | DomeLight
