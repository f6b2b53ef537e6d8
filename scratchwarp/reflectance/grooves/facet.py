"""What facets of grooves are made of, from NumPy to the device."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import warp as wp

from ...optics import Conductor, Dielectric
from ..vectors import numbers
from .facet_device import CLEAR, DIFFUSE, GLOSSY, MIRROR, FacetMaterial, FacetMaterials

SUN = 0.004652  # [rad] angular radius of the light that a mirror facet sees: the sun's


def _color(name: str, value: Any, high: float = np.inf) -> np.ndarray:
    array = numbers(name, value, 0.0, high)
    if array.shape not in ((), (3,)):
        raise ValueError(f"{name} must be a number or three (linear Rec.709), got shape {list(array.shape)}")
    return array


@dataclass(frozen=True)
class Diffuse:
    """Lambert facets; ``albedo`` a number or three (linear Rec.709) in [0, 1]."""

    albedo: Any = 1.0

    def __post_init__(self) -> None:
        _color("albedo", self.albedo, 1.0)


@dataclass(frozen=True)
class GGX:
    """Rough facets: isotropic GGX of roughness ``alpha`` in [1e-4, 1], separable Smith masking.

    ``fresnel``: None reflects everything (F = 1), or an ``optics.Conductor`` of the "exact" model.
    """

    alpha: float
    fresnel: Conductor | None = None

    def __post_init__(self) -> None:
        if numbers("alpha", self.alpha, 1e-4, 1.0).ndim:
            raise ValueError(f"alpha must be one number, got {self.alpha!r}")
        if self.fresnel is not None:
            _exact("fresnel", self.fresnel)


def _exact(name: str, conductor: Any) -> None:
    if not isinstance(conductor, Conductor) or conductor.model != "exact":
        raise ValueError(f"{name} must be an optics.Conductor with model 'exact', got {conductor!r}")


def facet_materials(reflectance: Any, ground: Any, paths: int) -> tuple[FacetMaterials, int]:
    """(what the device takes, channels) of one reflectance for all grooves or one a path, and of the ground.

    ``ground`` None: that of the grooves, which must then be one for all.
    """
    several = isinstance(reflectance, Sequence)
    if several and len(reflectance) != paths:
        raise ValueError(f"reflectance must be one for each of the {paths} paths, got {len(reflectance)}")
    if several and ground is None:
        raise ValueError("ground must be given where reflectance is one for each path")
    of = [*(reflectance if several else [reflectance] * paths), reflectance if ground is None else ground]
    made = {key: facet_material(r) for key, r in {id(r): r for r in of}.items()}
    record: Any = FacetMaterial
    rows = np.zeros(len(made), dtype=record.numpy_dtype())
    for row, (material, _) in enumerate(made.values()):
        for name in record.vars:
            rows[name][row] = getattr(material, name)
    place = {key: row for row, key in enumerate(made)}
    table = rows[[place[id(r)] for r in of]]
    materials = FacetMaterials()
    materials.of = wp.array(table, dtype=FacetMaterial, device="cpu")
    return materials, max(channels for _, channels in made.values())


def facet_material(reflectance: Any) -> tuple[FacetMaterial, int]:
    """(what the device takes, channels 0 for a scalar result or 3) of a reflectance; ValueError on another one."""
    made = FacetMaterial()
    made.albedo, made.eta, made.k = (wp.vec3d(1.0, 1.0, 1.0),) * 3
    made.alpha, made.cos_source = wp.float64(1.0), wp.float64(np.cos(SUN))
    metal = None
    channels = 0
    if isinstance(reflectance, Diffuse):
        made.kind = int(DIFFUSE)
        albedo = np.asarray(reflectance.albedo, np.float64)
        channels = 3 if albedo.shape == (3,) else 0
        made.albedo = wp.vec3d(*np.broadcast_to(albedo, 3))
    elif isinstance(reflectance, GGX):
        made.kind, made.alpha, metal = int(GLOSSY), wp.float64(reflectance.alpha), reflectance.fresnel
    elif isinstance(reflectance, Conductor):
        _exact("reflectance", reflectance)
        made.kind, metal = int(MIRROR), reflectance
    elif isinstance(reflectance, Dielectric):
        if reflectance.model != "exact":
            raise ValueError(f"reflectance must have model 'exact', got {reflectance!r}")
        made.kind, made.metal = int(CLEAR), 2
        made.eta = wp.vec3d(reflectance.ior, 1.0, 1.0)
    else:
        raise ValueError(
            "reflectance must be grooves.Diffuse, grooves.GGX, optics.Conductor or optics.Dielectric, "
            f"got {reflectance!r}"
        )
    if metal is not None:
        made.metal = 1
        channels = 3 if metal.channels == 3 else 0
        made.eta = wp.vec3d(*np.broadcast_to(np.asarray(metal.eta, np.float64), 3))
        made.k = wp.vec3d(*np.broadcast_to(np.asarray(metal.k, np.float64), 3))
    return made, channels
