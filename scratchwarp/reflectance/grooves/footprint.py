"""Mean radiance of footprints over grooves, from NumPy."""

from dataclasses import dataclass
from typing import Any

import numpy as np
import warp as wp
from numpy.typing import ArrayLike

from ...optics import Conductor
from ..vectors import directions, numbers, to_device, vectors
from . import footprint_kernels as kernels
from .facet_device import DIFFUSE, GLOSSY, MIRROR, FacetMaterial
from .pattern import Pattern

CHORDS = ("axis", "exact")
ROOM = 64  # grooves near a footprint, before a larger list is made for it
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
    else:
        raise ValueError(f"reflectance must be grooves.Diffuse, grooves.GGX or optics.Conductor, got {reflectance!r}")
    if metal is not None:
        made.metal = 1
        channels = 3 if metal.channels == 3 else 0
        made.eta = wp.vec3d(*np.broadcast_to(np.asarray(metal.eta, np.float64), 3))
        made.k = wp.vec3d(*np.broadcast_to(np.asarray(metal.k, np.float64), 3))
    return made, channels


def means(
    g: Pattern,
    center: ArrayLike,
    axis1: ArrayLike,
    axis2: ArrayLike,
    omega_o: ArrayLike,
    omega_i: ArrayLike,
    reflectance: Any,
    chord: str = "exact",
    slices: int = 127,
) -> tuple[np.ndarray, np.ndarray]:
    """(``radiance`` as [..., 3], share of each footprint [...] in which a surface was found: 1, or rays were lost)."""
    if not isinstance(g, Pattern):
        raise ValueError(f"g must be a grooves.Pattern, got {type(g).__name__}")
    if chord not in CHORDS:
        raise ValueError(f"chord must be one of {', '.join(CHORDS)}, got {chord!r}")
    if not (isinstance(slices, int) and 1 <= slices <= 4096):
        raise ValueError(f"slices must be a whole number in [1, 4096], got {slices!r}")
    material, _ = facet_material(reflectance)
    plane = [vectors(name, v, 2) for name, v in (("center", center), ("axis1", axis1), ("axis2", axis2))]
    arrays = [*plane, directions("omega_o", omega_o), directions("omega_i", omega_i)]
    lead, inputs = to_device(arrays, [wp.vec2d] * 3 + [wp.vec3d] * 2)
    total = len(inputs[0])
    out = wp.zeros(total, dtype=wp.vec3d, device="cpu")
    found = wp.zeros(total, dtype=wp.float64, device="cpu")
    near = wp.zeros((total, min(max(len(g.table), 1), ROOM)), dtype=int, device="cpu")
    given = [g.grooves, material, slices, CHORDS.index(chord), g.grid.data]
    wp.launch(kernels.means, total, inputs=[*given, near, *inputs], outputs=[out, found], device="cpu")
    result, share = out.numpy(), found.numpy()
    for k in np.flatnonzero(share < 0.0):  # more grooves than there was room for
        near = wp.zeros((1, len(g.table)), dtype=int, device="cpu")
        one, one_share = wp.zeros(1, dtype=wp.vec3d, device="cpu"), wp.zeros(1, dtype=wp.float64, device="cpu")
        rows = [x[int(k) : int(k) + 1] for x in inputs]
        wp.launch(kernels.means, 1, inputs=[*given, near, *rows], outputs=[one, one_share], device="cpu")
        result[k], share[k] = one.numpy()[0], one_share.numpy()[0]
    return result.reshape(*lead, 3), share.reshape(lead)


def radiance(
    g: Pattern,
    center: ArrayLike,
    axis1: ArrayLike,
    axis2: ArrayLike,
    omega_o: ArrayLike,
    omega_i: ArrayLike,
    reflectance: Any,
    chord: str = "exact",
    slices: int = 127,
) -> np.ndarray:
    """Mean radiance of an elliptic footprint over grooves under unit perpendicular irradiance, [...] or [..., 3].

    The mean over the ellipse ``center [..., 2]``, half-axis vectors ``axis1``, ``axis2 [..., 2]`` in the plane z = 0
    (the pattern's unit; any of them may be 0) of what is seen through it towards ``omega_o [..., 3]``: groove facets
    and the flat ground between, of one ``reflectance``. Light comes from ``omega_i [..., 3]``; a facet of normal m that
    is lit sends f (m . omega_i). Leading dimensions broadcast. Colours give a last axis of 3.

    ``reflectance``: ``Diffuse(albedo)``, ``GGX(alpha)``, or ``optics.Conductor``: mirrors that see the irradiance
    spread evenly over a disc of the sun's angular radius (``SUN``) about ``omega_i``.
    ``chord``: where grooves are parallel and do not end nearby, "exact" weights what lies across them by the ellipse's
    area, "axis" evenly over the axis that reaches further, as in the paper. ``slices``: lines over the
    footprint elsewhere.

    Masking, shadowing, crossings, ends and corners are exact along each line (``footprint_device``); grooves outside
    the ellipse that hide or darken it count. Directions below the plane give 0. Source: Bosch et al. 2008, with the
    cosine inside. Raises ValueError naming the argument.
    """
    result, _ = means(g, center, axis1, axis2, omega_o, omega_i, reflectance, chord, slices)
    return result if facet_material(reflectance)[1] == 3 else result[..., 0]
