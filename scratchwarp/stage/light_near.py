"""Lights with a place: sphere, rectangle, disk and cylinder."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from pxr import Usd

from scratchwarp.scene import CylinderLight, DiskLight, Light, Mesh, RectLight, SphereLight

from .light import common, radiance, through
from .light_shape import cylinder_area, cylinder_mesh, ellipsoid_area, sphere_mesh
from .reading import Reading
from .texture import Textures

_ROUND = 1e-4  # relative difference of scales up to which a sphere or cylinder counts as round


@dataclass(frozen=True, eq=False)
class EmittingShape:
    """A light whose shape has no record of its own: a mesh in the light's space that shines from its outside.

    ``fields`` are those of a MeshLight, but for its instance.
    """

    mesh: Mesh
    fields: dict[str, Any]


def sphere(reading: Reading, prim: Usd.Prim, metric: np.ndarray, textures: Textures) -> Light | EmittingShape | None:
    """A sphere; stretched to an ellipsoid it becomes a mesh, of no radius or treated as a point a point.

    A sphere of radiance L has the radiant intensity pi r^2 L in every direction.
    """
    radius = _length(reading, prim, "inputs:radius", 0.5)
    linear = metric[:3, :3] * radius
    unit = reading.metres
    fields = common(reading, prim, 180.0)
    axis = _direction(metric[:3, :3] @ (0.0, 0.0, -1.0))
    if radius == 0:
        if not reading.value(prim, "inputs:normalize", False):
            reading.warn(prim.GetPath(), "its radius is 0 and normalize is off; it gives no light")
            return None
        intensity = radiance(reading, prim, 1.0) / 4 * unit**2
        return SphereLight(**fields, radiance=intensity, center=metric[:3, 3], radius=0.0, axis=axis, point=True)
    area = ellipsoid_area(linear)
    if area == 0:
        reading.warn(prim.GetPath(), "the light has no area; it gives no light")
        return None
    emitted = radiance(reading, prim, area / unit**2)
    scales = np.linalg.svd(linear, compute_uv=False)
    if bool(reading.value(prim, "treatAsPoint", False)):
        intensity = emitted * area / 4
        return SphereLight(**fields, radiance=intensity, center=metric[:3, 3], radius=0.0, axis=axis, point=True)
    if scales[-1] < (1 - _ROUND) * scales[0]:
        return _emitting(reading, prim, sphere_mesh(str(prim.GetPath()), radius), emitted)
    size = float(np.sqrt(area / (4 * np.pi)))
    return SphereLight(**fields, radiance=emitted, center=metric[:3, 3], radius=size, axis=axis)


def rect(reading: Reading, prim: Usd.Prim, metric: np.ndarray, textures: Textures) -> Light | None:
    """A parallelogram."""
    ex = metric[:3, 0] * _length(reading, prim, "inputs:width", 1.0) / 2
    ey = metric[:3, 1] * _length(reading, prim, "inputs:height", 1.0) / 2
    normal, area = _plane(ex, ey, metric)
    if area == 0:
        reading.warn(prim.GetPath(), "the light has no area; it gives no light")
        return None
    texture = -1
    asset = reading.value(prim, "inputs:texture:file")
    if asset and asset.path:
        attribute = prim.GetAttribute("inputs:texture:file")
        texture = textures.index(attribute.GetPath(), asset, attribute.GetColorSpace() or "auto")
    emitted = radiance(reading, prim, 4 * area / reading.metres**2)
    return RectLight(
        **common(reading, prim, 90.0),
        radiance=through(reading, prim, emitted, textures, texture),
        center=metric[:3, 3],
        ex=ex,
        ey=ey,
        normal=normal,
        texture=texture,
    )


def disk(reading: Reading, prim: Usd.Prim, metric: np.ndarray, textures: Textures) -> Light | None:
    """An ellipse; its half-axes are the principal ones of the transformed circle."""
    radius = _length(reading, prim, "inputs:radius", 0.5)
    ex, ey = metric[:3, 0] * radius, metric[:3, 1] * radius
    normal, area = _plane(ex, ey, metric)
    if area == 0:
        reading.warn(prim.GetPath(), "the light has no area; it gives no light")
        return None
    if abs(ex @ ey) > 1e-9 * (ex @ ex + ey @ ey):
        axes, sizes, _ = np.linalg.svd(np.stack([ex, ey], axis=1), full_matrices=False)
        ex, ey = axes[:, 0] * sizes[0], axes[:, 1] * sizes[1]
    return DiskLight(
        **common(reading, prim, 90.0),
        radiance=radiance(reading, prim, np.pi * area / reading.metres**2),
        center=metric[:3, 3],
        ex=ex,
        ey=ey,
        normal=normal,
    )


def cylinder(reading: Reading, prim: Usd.Prim, metric: np.ndarray, textures: Textures) -> Light | EmittingShape | None:
    """A tube without caps; stretched across its axis or sheared it becomes a mesh."""
    length = _length(reading, prim, "inputs:length", 1.0)
    radius = _length(reading, prim, "inputs:radius", 0.5)
    if length == 0 or (radius == 0 and not reading.value(prim, "inputs:normalize", False)):
        reading.warn(prim.GetPath(), "the light has no area; it gives no light")
        return None
    radius = max(radius, 1e-3 * length)
    along, y, z = metric[:3, 0] * length / 2, metric[:3, 1] * radius, metric[:3, 2] * radius
    emitted = radiance(reading, prim, cylinder_area(along, y, z) / reading.metres**2)
    square = np.array([[y @ y, y @ z], [y @ z, z @ z]]) / max(float(y @ y), 1e-300)
    tilt = np.array([along @ y, along @ z]) / max(float(np.linalg.norm(along) * np.linalg.norm(y)), 1e-300)
    if np.abs(square - np.eye(2)).max() > 2 * _ROUND or np.abs(tilt).max() > _ROUND:
        return _emitting(reading, prim, cylinder_mesh(str(prim.GetPath()), length, radius), emitted)
    return CylinderLight(
        **common(reading, prim, 180.0),
        radiance=emitted,
        center=metric[:3, 3],
        axis=along,
        radius=float(np.linalg.norm(y)),
        forward=_direction(metric[:3, :3] @ (0.0, 0.0, -1.0)),
    )


def _emitting(reading: Reading, prim: Usd.Prim, mesh: Mesh, emitted: np.ndarray) -> EmittingShape:
    return EmittingShape(mesh, {**common(reading, prim), "radiance": emitted})


def _length(reading: Reading, prim: Usd.Prim, name: str, otherwise: float) -> float:
    got = reading.number(prim, name, otherwise)
    if got < 0:
        reading.warn(prim.GetPath(), f"{name} is {got:g}; 0 is used")
    return max(got, 0.0)


def _direction(vector: np.ndarray) -> np.ndarray:
    return vector / max(float(np.linalg.norm(vector)), 1e-300)


def _plane(ex: np.ndarray, ey: np.ndarray, metric: np.ndarray) -> tuple[np.ndarray, float]:
    """(unit normal on the side of the prim's -Z, area of the parallelogram ex, ey)."""
    cross = np.cross(ex, ey)
    area = float(np.linalg.norm(cross))
    normal = cross / max(area, 1e-300)
    return normal if normal @ metric[:3, 2] < 0 else -normal, area
