"""One tile at a time, into sums of its own: what a thread, or a worker of a farm, does."""

import time
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
import warp as wp

from ..kernels import Assembled
from ..plan import EffectPlan
from .interrupt import Stopped
from .launch import SAMPLES_A_LAUNCH, SUMS, film_arrays, launcher
from .tiles import Tile

Sums = dict[str, np.ndarray]
Shoot = Callable[[Tile, int, int, Mapping[str, np.ndarray] | None], Sums]

LAUNCH_SECONDS = 0.3
"""Launches that take longer are made smaller, so that a render can be stopped."""


def blank(width: int, height: int) -> Sums:
    """Sums of an image without samples, as NumPy arrays [h, w] and [h, w, 3]."""
    film = film_arrays(width, height, "cpu")
    return {name: getattr(film, name).numpy() for name in SUMS}


def part(sums: Mapping[str, np.ndarray], tile: Tile) -> Sums:
    """Views of a tile's pixels in sums of the whole window."""
    return {name: v[tile.y : tile.y + tile.height, tile.x : tile.x + tile.width] for name, v in sums.items()}


def shooter(
    kernel: Any,
    built: Assembled,
    plan: EffectPlan,
    device: str,
    stopped: Callable[[], bool] = lambda: False,
    launched: Callable[[], None] = lambda: None,
) -> Shoot:
    """``shoot(tile, first, count, earlier)``: the sums of a tile with samples ``first`` to ``first + count - 1`` added
    to ``earlier`` (None: to nothing), as NumPy arrays that the next call does not touch.

    ``stopped`` is asked between launches, and Stopped raised when it says so; ``launched`` is called after each. One
    shooter serves one thread.
    """
    edge = plan.settings.tile
    width, height = min(edge, plan.window[1] - plan.window[0]), min(edge, plan.window[3] - plan.window[2])
    film = film_arrays(width, height, device)
    empty = film_arrays(width, height, device)
    launch = launcher(kernel, built, plan, film, device, alone=True)
    most = [SAMPLES_A_LAUNCH]

    def shoot(tile: Tile, first: int, count: int, earlier: Mapping[str, np.ndarray] | None) -> Sums:
        for name in SUMS:
            wp.copy(getattr(film, name), getattr(empty, name))
        if earlier is not None:
            for name, values in earlier.items():
                begun = getattr(film, name).numpy()  # the film itself on the CPU, a copy of it elsewhere
                begun[: tile.height, : tile.width] = values
                getattr(film, name).assign(begun)
        at = first
        while at < first + count:
            if stopped():
                raise Stopped
            some = min(most[0], first + count - at)
            clock = time.perf_counter()
            launch(tile, at, some)
            launched()
            at += some
            if time.perf_counter() - clock > LAUNCH_SECONDS and some == most[0]:
                most[0] = max(1, most[0] // 2)
        wp.synchronize_device(device)
        return {name: getattr(film, name).numpy()[: tile.height, : tile.width].copy() for name in SUMS}

    return shoot
