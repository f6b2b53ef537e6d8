"""The reflectance of scratches from Python."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from .arrays import device_array, launch, outline_array
from .inputs import common_shape, directions, numbers, option
from .real_device import vec3
from .scratch import Scratch, row_dtype
from .scratch_device import WaveScratch

PHASES = ("small-angle", "angle-dependent")


def brdf(omega_i: Any, omega_o: Any, s: Scratch, wavelength: Any, phase: str = "small-angle") -> np.ndarray:
    """|S|^2 / (A_C lambda^2) of one scratch [1/sr]: no Fresnel factor, no base (Velinov et al. 2018 Eq. 1 to 11).

    Directions ``[..., 3]`` unit in the shading frame (n = +z); ``wavelength`` [nm]; they broadcast with the fields of
    the scratch. ``phase``: depth phase k g depth with g = 2 ("small-angle", Eq. 4) or gamma_i + gamma_o
    ("angle-dependent"). 0 at and below the horizon. float64 ``[...]``. Raises ValueError naming the argument.
    """
    from .point_kernels import brdf_kernel

    pairs, shape = _pairs(omega_i, omega_o, wavelength, scratch=_checked("s", s).shape)
    scratch = device_array(s.to_rows(shape), WaveScratch)
    dependent = int(option("phase", phase, PHASES) == "angle-dependent")
    return launch(brdf_kernel, shape, pairs, scratch, outline_array([s]), dependent)


def brdf_coherent(
    omega_i: Any,
    omega_o: Any,
    scratches: Sequence[Scratch],
    wavelength: Any,
    phase: str = "small-angle",
    base: bool = True,
) -> np.ndarray:
    """|B - sum of S_m|^2 / (A_C lambda^2) [1/sr]: Eq. 1 with all cross terms, of scratches that do not overlap.

    ``base``: with the flat mirror B around them, else the scratches among themselves. All share one coherence radius;
    depths that spread have no amplitude (``depth_spread`` must be 0). Otherwise as ``brdf``.
    """
    from .point_kernels import coherent_kernel

    if isinstance(scratches, Scratch) or not all(isinstance(s, Scratch) for s in scratches):
        raise ValueError(f"scratches must be a sequence of Scratch, got {scratches!r}")
    for s in scratches:
        if np.any(s.depth_spread > 0.0):
            raise ValueError(f"scratches must have depth_spread 0, got {s.depth_spread}")
    radii = [s.coherence_radius for s in scratches] or [np.float64(60.0)]
    sigma = radii[0]
    for radius in radii[1:]:
        if np.any(radius != sigma):
            raise ValueError(f"scratches must share one coherence_radius, got {sigma} and {radius}")
        sigma = sigma + 0.0 * radius
    own = common_shape(**{f"scratches[{i}]": s.shape for i, s in enumerate(scratches)})
    pairs, shape = _pairs(omega_i, omega_o, wavelength, scratches=own)
    rows, first = [], 0
    for s in scratches:
        rows.append(s.to_rows(shape if own else (), first))
        first += len(s.facets)
    columns = int(np.prod(shape)) if own else 1
    table = np.stack(rows) if rows else np.zeros((0, columns), row_dtype())
    sigmas = device_array(np.broadcast_to(sigma, shape).reshape(-1))
    dependent = int(option("phase", phase, PHASES) == "angle-dependent")
    arguments = device_array(table, WaveScratch), outline_array(scratches), dependent, sigmas, float(bool(base))
    return launch(coherent_kernel, shape, pairs, *arguments)


def _checked(name: str, s: Any) -> Scratch:
    if not isinstance(s, Scratch):
        raise ValueError(f"{name} must be a diffraction.Scratch, got {s!r}")
    return s


def _pairs(omega_i: Any, omega_o: Any, wavelength: Any, **shapes: tuple[int, ...]) -> tuple[Any, tuple[int, ...]]:
    from .point_kernels import Pairs

    wi, wo = directions("omega_i", omega_i), directions("omega_o", omega_o)
    waves = numbers("wavelength", wavelength, above=0.0)
    shape = common_shape(omega_i=wi.shape[:-1], omega_o=wo.shape[:-1], wavelength=waves.shape, **shapes)
    pairs = Pairs()
    pairs.omega_i = device_array(np.broadcast_to(wi, (*shape, 3)).reshape(-1, 3), vec3)
    pairs.omega_o = device_array(np.broadcast_to(wo, (*shape, 3)).reshape(-1, 3), vec3)
    pairs.wavelength = device_array(np.broadcast_to(waves * 1e-3, shape).reshape(-1))  # micrometres
    return pairs, shape
