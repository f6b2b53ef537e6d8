"""Colours of single scratches under wide lights from Python, no wavelengths sampled."""

import functools
from typing import Any

import numpy as np
import warp as wp

from .arrays import DEVICE, device_array
from .color import spectral_samples
from .inputs import common_shape, numbers
from .real_device import vec3
from .wide_color_device import WideTable

DEEPEST = 8.0
"""Depth [um] up to which there is a table."""

_REACH = 12.0  # um
_COLUMNS, _ROWS = 768, 1024


def wide_rgb(width: Any, depth: Any, q0: Any, q1: Any, offset: Any = 0.0, coherence_radius: Any = 60.0) -> np.ndarray:
    """Colour of one scratch under white light that fills xi_2 from ``q0`` to ``q1`` on the line xi_1 = 0: linear
    Rec.709 ``[..., 3]`` of its radiance, the light's being 1 at all wavelengths; not clamped, illuminant E adapted to
    D65.

    Velinov et al. 2018 Eq. 27 with exact Si, integrated over wavelengths in advance: for lights whose edges are more
    than 10 / (sigma k) away from the line, 0.011 to 0.02 at 60 um. ``width``, ``depth``, ``offset`` [um], the depth at
    most 8; error 1e-4 of the whole lobe. Arguments broadcast. Raises ValueError naming the argument.
    """
    from .wide_color_kernels import WideQueries, wide_color_kernel

    w, d = numbers("width", width, least=0.0), numbers("depth", depth, least=0.0)
    if np.any(d > DEEPEST):
        raise ValueError(f"depth must be at most {DEEPEST:g} um, got {d.max()}; use radiance at wavelengths")
    lo, hi = numbers("q0", q0), numbers("q1", q1)
    s, sigma = numbers("offset", offset), numbers("coherence_radius", coherence_radius, above=0.0)
    shape = common_shape(width=w.shape, depth=d.shape, q0=lo.shape, q1=hi.shape, offset=s.shape, radius=sigma.shape)
    q = WideQueries()
    for name, value in (("width", w), ("depth", d), ("q0", lo), ("q1", hi)):
        setattr(q, name, device_array(np.broadcast_to(value, shape).reshape(-1)))
    count = int(np.prod(shape))
    out = wp.zeros(count, dtype=vec3, device=DEVICE)
    if count:
        wp.launch(wide_color_kernel, count, inputs=[wide_table(), q], outputs=[out], device=DEVICE)
    scale = np.broadcast_to(w / (np.pi**1.5 * sigma) * np.exp(-((s / sigma) ** 2)), shape)
    return out.numpy().reshape(*shape, 3) * scale[..., None]


@functools.cache
def wide_table() -> WideTable:
    """The table of ``wide_color_device`` for the CIE 1931 observer, made once: 19 MB."""
    from .lobe_kernels import lobe_integrals

    # even in 1 / lambda, so that the fringes of depth and width are; a cycle of the fastest takes 20 samples
    at, weights = spectral_samples(2400)
    wave = at * 1e-3
    depth = np.linspace(0.0, DEEPEST, _ROWS)
    reach = np.linspace(0.0, _REACH, _COLUMNS)
    seen = 1.0 - np.cos(4.0 * np.pi * depth[:, None] / wave)
    lobe = lobe_integrals(reach[:, None] / wave)
    table: Any = WideTable()
    table.depth_step, table.reach_step = depth[1], reach[1]
    values = np.stack([(seen * weights[:, c]) @ lobe.T for c in range(3)], axis=-1)
    table.values = device_array(values, vec3)
    table.limit = device_array(0.5 * np.pi * (seen @ weights), vec3)
    return table
