"""Mean radiance of footprints over grooves, from NumPy."""

from typing import Any

import numpy as np
import warp as wp
from numpy.typing import ArrayLike

from ..vectors import directions, to_device, vectors
from . import footprint_kernels as kernels
from .facet import facet_materials
from .footprint_device import Footprint
from .pattern import Pattern
from .walks import follow

CHORDS = ("axis", "exact")


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
    ground: Any = None,
) -> tuple[np.ndarray, np.ndarray]:
    """(``radiance`` as [..., 3], share of each footprint [...] in which a surface was found: 1, or rays were lost)."""
    if not isinstance(g, Pattern):
        raise ValueError(f"g must be a grooves.Pattern, got {type(g).__name__}")
    if chord not in CHORDS:
        raise ValueError(f"chord must be one of {', '.join(CHORDS)}, got {chord!r}")
    if not (isinstance(slices, int) and 1 <= slices <= 4096):
        raise ValueError(f"slices must be a whole number in [1, 4096], got {slices!r}")
    materials, _ = facet_materials(reflectance, ground, g.count)
    plane = [vectors(name, v, 2) for name, v in (("center", center), ("axis1", axis1), ("axis2", axis2))]
    arrays = [*plane, directions("omega_o", omega_o), directions("omega_i", omega_i)]
    lead, inputs = to_device(arrays, [wp.vec2d] * 3 + [wp.vec3d] * 2)
    total = len(inputs[0])
    out = wp.zeros(total, dtype=wp.vec3d, device="cpu")
    found = wp.zeros(total, dtype=wp.float64, device="cpu")
    given = [materials, slices, CHORDS.index(chord), g.grid.data]
    wp.launch(kernels.means, total, inputs=[g.grooves, *given, *inputs], outputs=[out, found], device="cpu")
    result, share = out.numpy(), found.numpy()
    crowded = np.flatnonzero(share < 0.0)  # more grooves than there was room for
    if len(crowded):
        room, ids = g.room(g.size + 4), wp.zeros(g.size + 4, dtype=int, device="cpu")
        rows = [x.numpy() for x in inputs]
        for k in crowded:
            one, one_share = wp.zeros(1, dtype=wp.vec3d, device="cpu"), wp.zeros(1, dtype=wp.float64, device="cpu")
            f: Any = Footprint()
            f.center, f.a1, f.a2 = (wp.vec2d(*x[k]) for x in rows[:3])
            where = [f, *(wp.vec3d(*x[k]) for x in rows[3:])]
            wp.launch(kernels.mean_wide, 1, inputs=[room, *given, ids, *where], outputs=[one, one_share], device="cpu")
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
    bounces: int = 0,
    samples: int = 256,
    ground: Any = None,
) -> np.ndarray:
    """Mean radiance of an elliptic footprint over grooves under unit perpendicular irradiance, [...] or [..., 3].

    The mean over the ellipse ``center [..., 2]``, half-axis vectors ``axis1``, ``axis2 [..., 2]`` in the plane z = 0
    (the pattern's unit; any of them may be 0) of what is seen through it towards ``omega_o [..., 3]``: groove facets
    and the flat ground between, with their ``reflectance``. Light comes from ``omega_i [..., 3]``; a facet of
    normal m that is lit sends f (m . omega_i). Leading dimensions broadcast. Colours give a last axis of 3.

    ``reflectance``: ``Diffuse(albedo)``, ``GGX(alpha)``, or ``optics.Conductor``, ``optics.Dielectric``: mirrors that
    see the irradiance spread evenly over a disc of the sun's angular radius (``facet.SUN``) about ``omega_i``. One
    for all, or a sequence of one a path; ``ground``: that of the flat ground, where it is another one.
    ``chord``: where grooves are parallel and do not end nearby, "exact" weights what lies across them by the ellipse's
    area, "axis" evenly over the axis that reaches further, as in the paper. ``slices``: lines over the
    footprint elsewhere. ``bounces``: light by way of as many further facets, by ``samples`` paths a footprint
    (``trace``).

    Masking, shadowing, crossings, ends and corners are exact along each line (``footprint_device``); grooves outside
    the ellipse that hide or darken it count. Directions below the plane give 0. Source: Bosch et al. 2008, with the
    cosine inside. Raises ValueError naming the argument.
    """
    result, _ = means(g, center, axis1, axis2, omega_o, omega_i, reflectance, chord, slices, ground)
    if bounces != 0:
        added, _ = follow(g, center, axis1, axis2, omega_o, omega_i, reflectance, bounces, samples, False, ground)
        result = result + added
    return result if facet_materials(reflectance, ground, g.count)[1] == 3 else result[..., 0]
