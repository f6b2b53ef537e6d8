"""Masking and shadowing in a cross-section, exact, from NumPy."""

from typing import Any

import numpy as np
import warp as wp
from numpy.typing import ArrayLike

from ..vectors import numbers
from . import masking_kernels as kernels
from .masking_device import Section
from .section import section_points

GRAZING = 1e-7  # [rad] how near to the plane a direction is taken; nearer, the limit differs by less


def _directions(name: str, theta: ArrayLike) -> np.ndarray:
    angle = numbers(name, theta, -np.pi / 2 - 1e-12, np.pi / 2 + 1e-12)
    angle = np.clip(angle, GRAZING - np.pi / 2, np.pi / 2 - GRAZING)
    return np.stack([np.sin(angle), np.cos(angle)], -1)


def visibility(
    points: ArrayLike, theta_o: ArrayLike, theta_i: ArrayLike | None = None, periodic: bool = False
) -> np.ndarray:
    """Share of the base line through which each facet of a cross-section is seen (and lit); ``[..., n - 1]``.

    The base line is z = 0 from the first to the last x of ``points [n, 2]`` (any one unit; the solid is below). A ray
    through it towards ``theta_o`` sees the facet that it meets first. ``theta_i`` given, only what light from there
    reaches counts: the exact common part of both, not a product. Angles [rad] lie in the cross-section's plane, from
    the normal, positive towards +x; they broadcast. ``periodic``: the section repeats; else it lies in flat ground at
    z = 0, where a first or last point off z = 0 makes a wall that belongs to no facet.

    Exact to rounding (interval arithmetic on the facets, no sampling), overhangs and walls included; at +-90 degrees
    the limit. Without ``theta_i`` the shares sum to 1. Bosch et al. 2008, section 5, whose running maximum holds for
    height fields alone. Raises ValueError naming the argument on senseless points and angles beyond 90 degrees.
    """
    p = section_points("points", points)
    width = p[-1, 0] - p[0, 0]
    if periodic:
        closed, first = np.concatenate([p, [[p[-1, 0], p[0, 1]]]]), 0
    else:
        closed, first = np.concatenate([[[p[0, 0], 0.0]], p, [[p[-1, 0], 0.0]]]), 1
    keep = np.concatenate([[True], np.any(np.diff(closed, axis=0) != 0, axis=1)])
    position = np.cumsum(keep) - 1  # of each closed vertex among the kept ones
    facet = position[first : first + len(p) - 1]
    degenerate = position[first + 1 : first + len(p)] == facet

    given = [_directions("theta_o", theta_o), _directions("theta_i", 0.0 if theta_i is None else theta_i)]
    try:
        lead = np.broadcast_shapes(*(g.shape[:-1] for g in given))
    except ValueError:
        raise ValueError(
            f"shapes of theta_o and theta_i, {given[0].shape[:-1]} and {given[1].shape[:-1]}, do not broadcast"
        ) from None
    flat = [np.ascontiguousarray(np.broadcast_to(g, (*lead, 2))).reshape(-1, 2) for g in given]
    section = Section()
    section.points = wp.array(closed[keep], dtype=wp.vec2d, device="cpu")
    section.first, section.count = 0, int(keep.sum())
    section.reach = 1 + int(np.ceil(max(p[0, 0] - p[:, 0].min(), p[:, 0].max() - p[-1, 0]) / width)) if periodic else 0
    section.period = wp.float64(width if periodic else 0.0)
    out = wp.zeros((len(flat[0]), len(facet)), dtype=wp.float64, device="cpu")
    arrays: list[Any] = [wp.array(f, dtype=wp.vec2d, device="cpu") for f in flat]
    inputs = [
        section,
        *arrays,
        int(theta_i is not None),
        wp.array(np.where(degenerate, 0, facet), dtype=int, device="cpu"),
    ]
    wp.launch(kernels.fractions, out.shape, inputs=inputs, outputs=[out], device="cpu")
    return np.where(degenerate, 0.0, out.numpy()).reshape(*lead, len(facet))
