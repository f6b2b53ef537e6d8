"""Scratches under a pixel's footprint from Python."""

from typing import Any

import numpy as np

from .arrays import device_array, launch, rules
from .inputs import common_shape, numbers, option

FOOTPRINTS = ("gaussian", "paper", "exact")


def footprint(
    a1: Any, a2: Any, angle: Any, offset: Any, coherence_radius: Any = 60.0, method: str = "gaussian"
) -> np.ndarray:
    """Mean over an elliptic footprint of |eta_s|^2 = 2 A_C e^{-s_b^2 / sigma^2} [um^2] of an endless scratch.

    ``a1``, ``a2`` [um] >= 0: half-axes; ``angle`` [rad]: from the scratch to a1; ``offset`` [um]: from the centre to
    the scratch, across; all broadcast, float64 ``[...]``. "gaussian": a Gaussian footprint of the same second moments,
    in closed form; "exact": the ellipse; "paper": Velinov et al. 2018 Eq. 16 with the pi that its second term lacks,
    and Eq. 15 once A_P >= 2 A_C. Raises ValueError naming the argument.
    """
    from .ellipse_kernels import footprint_kernel

    which = FOOTPRINTS.index(option("method", method, FOOTPRINTS))
    record, shape = _footprints(a1, a2, angle, offset, coherence_radius)
    return launch(footprint_kernel, shape, record, which, rules((16,)))


def coverage(
    a1: Any,
    a2: Any,
    angle: Any,
    offset: Any,
    width: Any,
    method: str = "gaussian",
    coherence_radius: Any = 60.0,
) -> np.ndarray:
    """Scratch area density rho_P of Eq. 18 for one scratch of ``width`` [um], at most 1; arguments as ``footprint``.

    The paper's density: a mean over the footprint of Eq. 17, twice the share of the area that the scratch takes, so
    that its mean over offsets is 2 W / spacing. "paper" is 2 W l / A_P.
    """
    from .ellipse_kernels import coverage_kernel

    which = FOOTPRINTS.index(option("method", method, FOOTPRINTS))
    widths = numbers("width", width, least=0.0)
    record, shape = _footprints(a1, a2, angle, offset, coherence_radius, width=widths.shape)
    flat = device_array(np.broadcast_to(widths, shape).reshape(-1))
    return launch(coverage_kernel, shape, record, flat, which, rules((16,)))


def _footprints(
    a1: Any, a2: Any, angle: Any, offset: Any, coherence_radius: Any, **shapes: tuple[int, ...]
) -> tuple[Any, tuple[int, ...]]:
    from .ellipse_kernels import Footprints

    values = {
        "a1": numbers("a1", a1, least=0.0),
        "a2": numbers("a2", a2, least=0.0),
        "angle": numbers("angle", angle),
        "offset": numbers("offset", offset),
        "coherence_radius": numbers("coherence_radius", coherence_radius, above=0.0),
    }
    shape = common_shape(**{name: value.shape for name, value in values.items()}, **shapes)
    record = Footprints()
    for name, value in values.items():
        field = "sigma" if name == "coherence_radius" else name
        setattr(record, field, device_array(np.broadcast_to(value, shape).reshape(-1)))
    return record, shape
