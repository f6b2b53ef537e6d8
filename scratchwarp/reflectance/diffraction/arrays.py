"""NumPy arrays to the device and back."""

import functools
from collections.abc import Sequence
from typing import Any

import numpy as np
import warp as wp

from .quadrature_device import Rules
from .real_device import real, vec4
from .scratch import Scratch

DEVICE = "cpu"


def device_array(values: np.ndarray, dtype: Any = real) -> Any:
    """A copy on the device."""
    return wp.array(np.ascontiguousarray(values), dtype=dtype, device=DEVICE)


def launch(kernel: Any, shape: tuple[int, ...], *inputs: Any) -> np.ndarray:
    """One thread for each value of ``shape``; the float64 values that the last argument of the kernel receives."""
    out = wp.zeros(int(np.prod(shape)), dtype=real, device=DEVICE)
    if out.shape[0]:
        wp.launch(kernel, out.shape[0], inputs=list(inputs), outputs=[out], device=DEVICE)
    return out.numpy().reshape(shape)


def outline_array(scratches: Sequence[Scratch]) -> Any:
    """The outlines of scratches one after another; a row of zeros where there is none."""
    rows = [s.facets for s in scratches]
    return device_array(np.concatenate([*rows, np.zeros((1, 4))]), vec4)


@functools.lru_cache(maxsize=16)
def rules(counts: tuple[int, ...]) -> Rules:
    """Gauss-Legendre rules over [0, 1] of these numbers of nodes."""
    first = np.zeros(max(counts) + 1, np.int32)
    nodes: list[np.ndarray] = []
    weights: list[np.ndarray] = []
    for n in sorted(set(counts)):
        x, w = np.polynomial.legendre.leggauss(n)
        first[n] = sum(part.size for part in nodes)
        nodes.append(0.5 + 0.5 * x)
        weights.append(0.5 * w)
    made = Rules()
    made.first = device_array(first, int)
    made.nodes = device_array(np.concatenate(nodes))
    made.weights = device_array(np.concatenate(weights))
    return made
