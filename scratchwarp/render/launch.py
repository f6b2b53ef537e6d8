"""One kernel over tiles of one film."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import warp as wp

from ..kernels import Assembled, KernelKey
from ..kernels.film_device import FilmArrays, Window
from ..plan import EffectPlan
from .progress import Progress, silent
from .tiles import Tile

# Samples of one launch: long enough to hide its overhead, short enough to stop between launches.
SAMPLES_A_LAUNCH = 32
# What the kernel leaves for each pixel.
SUMS = {
    "color": wp.vec3,
    "base": wp.vec3,
    "scratches": wp.vec3,
    "square": float,
    "albedo": wp.vec3,
    "normal": wp.vec3,
    "position": wp.vec3,
    "depth": float,
    "alpha": float,
    "hits": int,
    "nearest": float,
    "instance": int,
    "rays": int,
    "invalid": int,
}
_compiled: set[KernelKey] = set()


def film_arrays(width: int, height: int, device: str) -> FilmArrays:
    """Sums of a film without samples, on the device."""
    film = FilmArrays()
    for name, dtype in SUMS.items():
        setattr(film, name, wp.zeros((height, width), dtype=dtype, device=device))
    film.nearest.fill_(1e30)
    film.instance.fill_(-1)
    return film


def loaded(key: KernelKey, device: str, progress: Progress = silent) -> tuple[Any, bool]:
    """(the kernel of a key, compiled and loaded; whether this process loads it for the first time)."""
    from ..kernels.render_device import make_kernel

    kernel: Any = make_kernel(key)
    fresh = key not in _compiled
    if fresh:
        progress(0, 1, "compile")
    wp.load_module(kernel.module, device=device)
    _compiled.add(key)
    if fresh:
        progress(1, 1, "compile")
    return kernel, fresh


def compiled(key: KernelKey) -> bool:
    """Whether a kernel is loaded, or lies in Warp's cache from an earlier process."""
    from ..kernels.render_device import make_kernel

    if key in _compiled:
        return True
    module: Any = make_kernel(key).module
    return any(Path(wp.config.kernel_cache_dir or "").glob(f"wp_{module.name}_*/*.o"))


def launcher(
    kernel: Any, built: Assembled, plan: EffectPlan, film: FilmArrays, device: str, alone: bool = False
) -> Callable[[Tile, int, int], None]:
    """``launch(tile, first, count)``: add samples ``first`` to ``first + count - 1`` of a tile's pixels to the film,
    which is that of the window, or where ``alone`` of one tile.

    The sums of a pixel do not depend on how its samples are split into launches, as long as they come in order. One
    launcher serves one thread.
    """
    settings = plan.settings
    window: Any = Window()
    window.x0, window.y0, window.seed = plan.window[0], plan.window[2], settings.seed or 0
    window.filter_width, window.max_depth = settings.filter_width, settings.max_depth
    if settings.integrator == "direct" or not plan.on("indirect"):
        window.max_depth = 1
    command = wp.launch(
        kernel, dim=1, inputs=[window, *built.inputs, film], device=device, record_cmd=True, record_tape=False
    )

    def launch(tile: Tile, first: int, count: int) -> None:
        if alone:
            window.x0, window.y0 = plan.window[0] + tile.x, plan.window[2] + tile.y
        else:
            window.tile_x, window.tile_y = tile.x, tile.y
        window.tile_w, window.tile_h = tile.width, tile.height
        window.first, window.count = first, count
        command.set_dim(tile.width * tile.height)
        command.set_param_at_index(0, window)
        command.launch()

    return launch
