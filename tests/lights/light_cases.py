"""Lights of every kind for the tests, and float64 references that share no code with the kernels."""

import numpy as np

from scratchwarp import lights
from scratchwarp.scene import (
    CylinderLight,
    DiskLight,
    DistantLight,
    DomeLight,
    Instance,
    Mesh,
    MeshLight,
    RectLight,
    SphereLight,
    Texture,
)

ONE = (1.0, 1.0, 1.0)
ORIGIN = np.zeros(3)
UP = np.array([0.0, 0.0, 1.0])

QUAD = Mesh(path="/quad", points=[[-1, -1, 0], [1, -1, 0], [1, 1, 0], [-1, 1, 0]], triangles=[[0, 2, 1], [0, 3, 2]])


def gradient(rows=32, columns=64):
    """A smooth latlong image with a bright spot and a black quarter, [rows, columns, 4]."""
    v, u = np.meshgrid((np.arange(rows) + 0.5) / rows, (np.arange(columns) + 0.5) / columns, indexing="ij")
    spot = 20.0 * np.exp(-((u - 0.3) ** 2 + (v - 0.2) ** 2) / 0.005)
    base = np.where(u > 0.75, 0.0, 0.2 + 0.5 * u + 0.3 * (1 - v))
    return np.stack([base + spot, 0.5 * base + spot, base, np.ones_like(base)], -1).astype(np.float32)


def rect(**changes):
    values = dict(path="/rect", radiance=ONE, center=(0.3, 0.4, 0.8), ex=(0.6, 0, 0), ey=(0, 0.5, 0), normal=(0, 0, -1))
    return RectLight(**{**values, **changes})


def disk(**changes):
    values = dict(path="/disk", radiance=ONE, center=(0.3, 0.4, 0.8), ex=(0.6, 0, 0), ey=(0, 0.5, 0), normal=(0, 0, -1))
    return DiskLight(**{**values, **changes})


def sphere(**changes):
    return SphereLight(**{**dict(path="/sphere", radiance=ONE, center=(0.3, 0.4, 1.0), radius=0.5), **changes})


def cylinder(**changes):
    values = dict(path="/cylinder", radiance=ONE, center=(0.3, 0.2, 0.9), axis=(0.7, 0.2, 0.1), radius=0.3)
    return CylinderLight(**{**values, **changes})


def distant(**changes):
    return DistantLight(**{**dict(path="/distant", radiance=ONE, direction=(0.3, 0.2, -1.0), angle=0.6), **changes})


def dome(**changes):
    return DomeLight(**{**dict(path="/dome", radiance=ONE), **changes})


def packed_dome(pixels, **changes):
    return lights.pack_lights([dome(texture=0, **changes)], [Texture("/image", pixels)])


def packed_mesh(mesh=QUAD, transform=None, **changes):
    matrix = np.diag([0.6, 0.5, 1.0, 1.0]) if transform is None else np.asarray(transform, float)
    if transform is None:
        matrix[:3, 3] = (0.3, 0.4, 0.8)
    record = MeshLight(**{**dict(path="/mesh", radiance=ONE, instance=0), **changes})
    return lights.pack_lights([record], (), [Instance("/mesh", 0, matrix, (0,))], [mesh])


TURN = np.array([[0.6, 0.0, 0.8], [0.0, 1.0, 0.0], [-0.8, 0.0, 0.6]])

# name -> light with extent, seen by ``hit``
SEEN = {
    "distant": distant(),
    "sun": distant(angle=np.radians(0.53)),
    "wide": distant(angle=5.0),
    "sphere": sphere(),
    "far_sphere": sphere(center=(30.0, 40.0, 100.0)),
    "rect": rect(),
    "tilted": rect(ex=(0.5, 0.1, 0.2), ey=(-0.2, 0.5, 0.25), normal=np.cross((-0.2, 0.5, 0.25), (0.5, 0.1, 0.2))),
    "sheared": rect(ey=(0.3, 0.5, 0)),
    "near_rect": rect(center=(0.1, 0.2, 0.05)),
    "far_rect": rect(center=(3.0, 4.0, 8.0)),
    "disk": disk(),
    "near_disk": disk(center=(0.1, 0.2, 0.05)),
    "far_disk": disk(center=(3.0, 4.0, 8.0)),
    "sheared_disk": disk(ey=(0.3, 0.5, 0)),
    "cylinder": cylinder(),
    "near_cylinder": cylinder(center=(0.2, 0.0, 0.33)),
    "end_on": cylinder(center=(2.0, 0.0, 0.4), axis=(1.0, 0.0, 0.0)),
    "dome": dome(),
    "image": packed_dome(gradient(), rotation=TURN),
}


def sphere_directions(count, seed=0):
    """Uniform directions on the sphere."""
    w = np.random.default_rng(seed).normal(size=(count, 3))
    return w / np.linalg.norm(w, axis=-1, keepdims=True)


def corners_of(light):
    """The four corners of a rect light, around."""
    return np.array([light.center + a * light.ex + b * light.ey for a, b in ((-1, -1), (1, -1), (1, 1), (-1, 1))])


def polygon_irradiance(corners, x, n):
    """Lambert's formula for a polygon of radiance 1 above the horizon, in float64."""
    d = np.asarray(corners, float) - x
    d /= np.linalg.norm(d, axis=-1, keepdims=True)
    total = 0.0
    for a, b in zip(d, np.roll(d, -1, 0), strict=True):
        cross = np.cross(a, b)
        sine = np.linalg.norm(cross)
        if sine > 0.0:
            total += np.arctan2(sine, a @ b) * (cross @ n) / sine
    return abs(total) / 2.0


def surface_irradiance(points, normals, areas, x, n):
    """Midpoint sum of cos cos / d^2 over patches of radiance 1 that face x, in float64."""
    d = points - x
    d2 = (d * d).sum(-1)
    cosines = np.maximum((d * n).sum(-1), 0.0) * np.maximum(-(d * normals).sum(-1), 0.0)
    return float((cosines / d2**2 * areas).sum())
