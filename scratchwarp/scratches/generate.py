"""Scratches laid at random over a piece of the pattern plane, as polylines in uv."""

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from ..scene import Curves, Layer
from .along import STEPS, Field, followed, varied

# More than this many would not fit into memory together with their pieces.
MOST = 5_000_000
MOST_CORNERS = 40_000_000
_POINTS_A_RADIAN = 8.0
# Scratches that are laid at once.
PORTION = 1 << 13
# Scratches of very many that are laid first, to tell what all of them come to.
SAMPLE = 1 << 12


def random_scratches(
    layer: Layer,
    low: tuple[float, float],
    high: tuple[float, float],
    scale: tuple[float, float],
    field: Field | None = None,
    varying: bool = False,
    look: Callable[[Curves, int], None] | None = None,
) -> Curves:
    """Scratches of one layer over the rectangle of uv from ``low`` to ``high``.

    ``scale``: units of the layer's lengths a unit of u and of v (1, 1 in space uv; micrometres in space surface).
    As many as ``density`` or ``coverage`` (1 - e^-(number times area)) call for; their middles are spread evenly at
    random, their angles over ``angle_spread`` (all where distribution random has none), their widths and depths over
    the layer's variations, ``varying``: also along each as far as ``variation_length`` says. ``field``: uv ``[n, 2]``
    -> unit vectors of twice the direction that scratches follow from there, zeros for none; the layer's angle and its
    spread turn them further. ``look``: called with ``SAMPLE`` of more than sixteen times as many scratches and how
    many all of them are, before the others are laid. Raises ValueError where that would be more than ``MOST``, or more
    than ``MOST_CORNERS`` corners.
    """
    size = np.array([(high[0] - low[0]) * scale[0], (high[1] - low[1]) * scale[1]])
    length, width = max(layer.length, layer.width), layer.width
    # those that only reach into the rectangle from outside count, too
    margin = np.minimum(0.5 * length, size)
    area = float(np.prod(size + 2.0 * margin))
    if layer.density > 0.0:
        number = layer.density * area * (1e-6 if layer.space == "surface" else 1.0)
    else:
        number = -math.log(max(1.0 - layer.coverage, 1e-4)) * area / (length * width)
    points = 2 + math.ceil(min(abs(layer.curvature) * _POINTS_A_RADIAN, MOST_CORNERS))
    if not number <= MOST:
        raise ValueError(
            f"{layer.label}: its coverage or density calls for {number:.3g} scratches, more than {MOST}; make them "
            "longer or wider, or use a regular distribution"
        )
    corners = STEPS + 1 if field is not None else points
    if number * corners > MOST_CORNERS:
        raise ValueError(
            f"{layer.label}: {number:.3g} scratches of {corners} corners each are more than {MOST_CORNERS}; make them "
            "straighter or fewer"
        )
    rng = np.random.default_rng([layer.seed & 0xFFFFFFFF, *layer.name.encode()])
    n = int(rng.poisson(number)) if number < 1e6 else round(number)
    middle = -margin + rng.random((n, 2)) * (size + 2.0 * margin)
    spread = layer.angle_spread
    if layer.distribution == "random" and spread == 0.0 and field is None:
        spread = math.pi
    angle = layer.angle + spread * (rng.random(n) - 0.5)
    turn = layer.curvature
    at = np.linspace(-0.5, 0.5, points)
    if turn == 0.0:
        along, across = length * at, np.zeros(points)
    else:
        along, across = length / turn * np.sin(turn * at), length / turn * (1.0 - np.cos(turn * at))
    points = corners

    def laid(some: slice) -> tuple[Any, Any]:
        if field is not None:
            own = angle[some]
            x, y = np.moveaxis(followed(middle[some], own, own, length, np.array(low), np.array(scale), field), -1, 0)
        else:
            cosine, sine = np.cos(angle[some])[:, None], np.sin(angle[some])[:, None]
            x = middle[some, :1] + cosine * along - sine * across
            y = middle[some, 1:] + sine * along + cosine * across
        return low[0] + x / scale[0], low[1] + y / scale[1]

    unit = "uv" if layer.space == "uv" else "um"

    def curves(uv: Any, widths: Any, depths: Any) -> Curves:
        counts = np.full(len(uv), points, np.int32)
        every = uv.reshape(-1, 3)
        return Curves(layer.label, every, counts, widths, depths, space="uv", width_unit=unit, depth_unit=unit)

    if look is not None and n > 16 * SAMPLE:
        uv = np.stack([*laid(slice(0, n, n // SAMPLE)), np.zeros((len(range(0, n, n // SAMPLE)), points))], axis=-1)
        look(curves(uv, *(np.full(uv[..., 0].size, mean) for mean in (layer.width, layer.depth))), n)
    uv = np.zeros((n, points, 3))
    for first in range(0, n, PORTION):  # what is in between stays in the processor's cache
        some = slice(first, first + PORTION)
        uv[some, :, 0], uv[some, :, 1] = laid(some)

    varying = varying and layer.variation_length > 0.0

    def sizes(mean: float, variation: float) -> Any:
        if varying:
            return np.full(n * points, mean)
        return np.repeat(mean * (1.0 + variation * (2.0 * rng.random(n) - 1.0)), points)

    made = curves(uv, sizes(layer.width, layer.width_variation), sizes(layer.depth, layer.depth_variation))
    return varied(made, layer, np.array([*scale, 1.0]), True) if varying else made
