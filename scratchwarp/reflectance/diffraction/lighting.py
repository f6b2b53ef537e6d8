"""The radiance of a scratch under an area light from Python."""

from typing import Any

import numpy as np

from . import slice_device
from .arrays import DEVICE, device_array, launch, outline_array, rules
from .inputs import common_shape, directions, numbers, option
from .light import DomeLight, Light, SphereLight
from .quadrature import quadrature
from .real_device import vec2, vec3, vec4
from .reflection import PHASES
from .round_rules import round_rules
from .scratch import Scratch
from .scratch_device import WaveScratch

METHODS = ("slices", "closed-form", "closed-form-paper", "quadrature")
_MOST_SLICES = 256
_NODES_A_FRINGE = 32


def radiance(
    light: Light,
    omega_o: Any,
    s: Scratch,
    wavelength: Any,
    phase: str = "small-angle",
    method: str = "slices",
    slices: int = 4,
) -> np.ndarray:
    """Radiance towards ``omega_o`` of one scratch under a light of radiance 1: no Fresnel factor, no base.

    ``omega_o`` ``[..., 3]`` unit, ``wavelength`` [nm], the fields of the scratch and the leading dimensions of the
    light broadcast. Methods, all with the same geometry, clipped at the horizon:

    - "slices": the integral over xi_2 in closed form (exact Si, or the table of a profile; numerical where ``phase`` is
      "angle-dependent") at up to ``slices`` values of xi_1. Two do for whole spheres (error 3e-4, 3e-3 at worst) and
      for polygons without a corner in the Gaussian (1e-6); four where there are corners, or where the horizon cuts:
      1e-4 in the median, more than 1 % in one of fifty cases. More than 4 refine everywhere, in as many steps as that
      needs; 64 leave 1e-6.
    - "closed-form": the same at xi_1 = 0 alone (Velinov et al. 2018 Eq. 27, exact Si): only for lights whose edges are
      more than 10 / (sigma k) away from the line xi_1 = 0.
    - "closed-form-paper": Eq. 27 with Eq. 29; may be negative. Rectangles and small angles only.
    - "quadrature": the reference, in NumPy, sharing none of the above; slow.

    A dome is the integral over the half circle xi_1 = 0 in 256 parts of even cosine, for "slices" and the closed forms
    alike: exact where it is even, and good where it changes little over 1 / (sigma k) = 0.001.

    Ends: "slices" integrates the lobe that they widen; the closed forms keep its share of energy alone.
    float64 ``[...]``. Raises ValueError naming the argument and its value.
    """
    if not isinstance(light, Light):
        raise ValueError(f"light must be a SphereLight, a PolygonLight or a DomeLight, got {light!r}")
    if not isinstance(s, Scratch):
        raise ValueError(f"s must be a diffraction.Scratch, got {s!r}")
    option("method", method, METHODS)
    dependent = option("phase", phase, PHASES) == "angle-dependent"
    if isinstance(slices, bool) or not isinstance(slices, int | np.integer) or not 1 <= slices <= _MOST_SLICES:
        raise ValueError(f"slices must be an integer from 1 to {_MOST_SLICES}, got {slices!r}")
    if method == "closed-form-paper" and (dependent or s.profile is not None):
        raise ValueError(f"method {method!r} knows rectangles and small angles only; use 'closed-form' or 'slices'")
    wo, waves = directions("omega_o", omega_o), numbers("wavelength", wavelength, above=0.0) * 1e-3
    shape = common_shape(light=light.shape, omega_o=wo.shape[:-1], wavelength=waves.shape, scratch=s.shape)
    if method == "quadrature":
        return quadrature(light, wo, s, waves, dependent, shape)
    return _on_device(light, wo, s, waves, shape, method, dependent, int(slices))


def _on_device(
    light: Light,
    wo: np.ndarray,
    s: Scratch,
    waves: np.ndarray,
    shape: tuple[int, ...],
    method: str,
    dependent: bool,
    slices: int,
) -> np.ndarray:
    from .radiance_kernels import Queries, polygon_kernel, sphere_kernel

    rows, flat_waves = s.to_rows(shape), np.broadcast_to(waves, shape).reshape(-1)
    q, tables = Queries(), slice_device.LobeTables()
    tables.outlines = outline_array([s])
    where, integrals = np.zeros((len(rows), 2), np.int32), np.zeros((1, 2))
    q.kind = int(slice_device.PAPER if method == "closed-form-paper" else slice_device.EXACT)
    if dependent:
        q.kind = int(slice_device.NUMERIC)
    elif s.profile is not None:
        q.kind = int(slice_device.TABLE)
        where, integrals = _tables(s, rows["width"] / flat_waves, rows["depth"] / flat_waves, tables.outlines)
    tables.integrals = device_array(integrals, vec2)
    q.omega_o = device_array(np.broadcast_to(wo, (*shape, 3)).reshape(-1, 3), vec3)
    q.scratch = device_array(rows, WaveScratch)
    q.wavelength = device_array(flat_waves)
    q.table = device_array(where, int)
    q.method = int(method != "slices")
    q.slices = slices
    rule = rules((8, 16, slices, (3 * slices + 3) // 4, (slices + 1) // 2, (slices + 3) // 4, 16 * slices))
    if isinstance(light, SphereLight):
        tables.rounds = device_array(round_rules(), vec4)
        center = device_array(np.broadcast_to(light.center, (*shape, 3)).reshape(-1, 3), vec3)
        radius = device_array(np.broadcast_to(light.radius, shape).reshape(-1))
        return launch(sphere_kernel, shape, q, tables, rule, center, radius)
    if isinstance(light, DomeLight):
        from .dome_kernels import dome_kernel

        return launch(dome_kernel, shape, q, tables, rule, device_array(light.values))
    corners = light.vertices.shape[-2]
    vertices = np.broadcast_to(light.vertices, (*shape, corners, 3)).reshape(-1, 3)
    return launch(polygon_kernel, shape, q, tables, rule, device_array(vertices, vec3), corners)


def _tables(s: Scratch, widths: np.ndarray, depths: np.ndarray, outlines: Any) -> tuple[np.ndarray, np.ndarray]:
    """For each row the first node and the number of nodes of its table, and the tables of all different lobes one after
    another: the integral from xi_2 = -2 of |P|^2 / lambda^2, and its slope."""
    import warp as wp

    from .point_kernels import outline_integral_kernel

    lobes, which = np.unique(np.stack((widths, depths), axis=1), axis=0, return_inverse=True)
    where, parts, first = np.zeros((len(lobes), 2), np.int32), [], 0
    for i, (width, depth) in enumerate(lobes):
        # a fringe of |P|^2 is at least lambda / width wide
        nodes = max(int(np.ceil(4.0 * width * _NODES_A_FRINGE)), 64) + 1
        out = wp.zeros(nodes, dtype=vec2, device=DEVICE)
        inputs = [outlines, 0, len(s.facets), width, depth, nodes, rules((3,))]
        wp.launch(outline_integral_kernel, nodes, inputs=inputs, outputs=[out], device=DEVICE)
        part = out.numpy()
        part[:, 0] = np.cumsum(part[:, 0])
        parts.append(part)
        where[i] = first, nodes
        first += nodes
    return where[which.reshape(-1)], np.concatenate([*parts, np.zeros((1, 2))])
