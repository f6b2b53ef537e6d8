"""Inter-reflection and transmission inside grooves, from NumPy."""

from dataclasses import dataclass
from typing import Any

import numpy as np
import warp as wp
from numpy.typing import ArrayLike

from ..vectors import directions, to_device, vectors
from . import walk_kernels as kernels
from .facet import facet_materials
from .pattern import Pattern

REACH = 20.0  # depths of the pattern beyond a footprint within which grooves are met


@dataclass(frozen=True)
class Ends:
    """Where the paths of ``trace`` end, [..., samples] each.

    Attributes:
        position: [..., 3] last place; direction: [..., 3] unit, the way the path goes on, into the scene.
        weight: [..., 3] what the radiance found there is multiplied with; its mean over samples is the footprint's.
        inside: the path goes on within the solid. met: surfaces met. left: no other surface is in the way; False: the
            bounces were used up, and what the path would have found is lost.
    """

    position: np.ndarray
    direction: np.ndarray
    weight: np.ndarray
    inside: np.ndarray
    met: np.ndarray
    left: np.ndarray


def follow(
    g: Pattern, center: ArrayLike, axis1: ArrayLike, axis2: ArrayLike, omega_o: ArrayLike, omega_i: ArrayLike,
    reflectance: Any, bounces: int, samples: int, keep: bool,
    ground: Any = None,
) -> tuple[np.ndarray, Ends]:  # fmt: skip
    """(light added by bounces [..., 3], path ends, of which there are none unless ``keep``)."""
    if not isinstance(g, Pattern):
        raise ValueError(f"g must be a grooves.Pattern, got {type(g).__name__}")
    for name, value, most in (("bounces", bounces, 1024), ("samples", samples, 1 << 20)):
        if not (isinstance(value, int) and 1 <= value <= most):
            raise ValueError(f"{name} must be a whole number in [1, {most}], got {value!r}")
    materials, _ = facet_materials(reflectance, ground, g.count)
    plane = [vectors(name, v, 2) for name, v in (("center", center), ("axis1", axis1), ("axis2", axis2))]
    arrays = [*plane, directions("omega_o", omega_o), directions("omega_i", omega_i)]
    lead, inputs = to_device(arrays, [wp.vec2d] * 3 + [wp.vec3d] * 2)
    total = len(inputs[0])
    light = wp.zeros(total, dtype=wp.vec3d, device="cpu")
    shape = (total, samples if keep else 0)
    rows = [wp.zeros(shape, dtype=wp.vec3d, device="cpu") for _ in range(3)]
    state = wp.zeros(shape, dtype=wp.vec3i, device="cpu")
    reach = wp.float64(REACH * float(g.grooves.top - g.grooves.bottom))
    given = [g.grooves, materials, bounces, samples, g.grid.data, reach, *inputs]
    wp.launch(kernels.walks, total, inputs=given, outputs=[light, *rows, state], device="cpu")
    places, ways, weights = (r.numpy().reshape(*lead, shape[1], 3) for r in rows)
    inside, met, left = np.moveaxis(state.numpy().reshape(*lead, shape[1], 3), -1, 0)
    return light.numpy().reshape(*lead, 3), Ends(places, ways, weights, inside == 1, met, left == 1)


def trace(
    g: Pattern,
    center: ArrayLike,
    axis1: ArrayLike,
    axis2: ArrayLike,
    omega_o: ArrayLike,
    reflectance: Any,
    bounces: int = 8,
    samples: int = 256,
    ground: Any = None,
) -> Ends:
    """Follow what a footprint shows through the grooves until it leaves them; arguments as those of ``radiance``.

    One path a sample, from points all over the ellipse towards the surface, then from facet to facet: mirrored
    (``optics.Conductor``), drawn from the reflectance (``GGX``, ``Diffuse``), or reflected or refracted by Fresnel
    (``optics.Dielectric``, total reflection included). The mean over samples of weight times the radiance that arrives
    along ``direction`` at ``position`` is the footprint's radiance. ``bounces``: surfaces met at most. Grooves more
    than ``REACH`` depths beyond the footprint, or more than 512 of them, are taken for solid. Source: Bosch et al.
    2008, section 7, by paths in place of beams. Raises ValueError naming the argument.
    """
    ends = follow(g, center, axis1, axis2, omega_o, [0.0, 0.0, -1.0], reflectance, bounces, samples, True, ground)
    return ends[1]
