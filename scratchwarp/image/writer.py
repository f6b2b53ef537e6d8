"""write(film, path): the suffix chooses the format."""

import time
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from ..whole import begin
from . import exr, npz, png
from .view import SRGB, View

if TYPE_CHECKING:
    from ..render import Film

SUFFIXES = (".exr", ".png", ".npz")


def write(film: "Film", path: str | Path, *, aovs: Sequence[str] | None = None, view: View = SRGB) -> None:
    """Write a film as multi-layer EXR, as PNG through ``view``, or as NPZ; whole or not at all.

    ``aovs``: names of the layers to write besides color and alpha (EXR, NPZ); None: all of them.
    Adds the seconds it took to ``film.stats["write"]``.
    ValueError on an unknown suffix or layer and on a NaN (naming its pixel), OSError when the file cannot be written.
    """
    target, start = _target(path), time.perf_counter()
    layers = dict(film.aovs)
    if aovs is not None:
        unknown = sorted(set(aovs) - set(layers))
        if unknown:
            raise ValueError(f"aov {unknown[0]!r} is not on the film; it has {', '.join(layers)}")
        layers = {name: values for name, values in layers.items() if name in ("color", "alpha", *aovs)}
    if target.suffix.lower() == ".png":
        png.write(layers, target, film.metadata, view)
    elif target.suffix.lower() == ".npz":
        npz.write(layers, target, film.metadata)
    else:
        exr.write(layers, target, film.metadata, film.crop, film.full_size)
    film.stats["write"] = film.stats.get("write", 0.0) + time.perf_counter() - start


def write_layers(layers: Mapping[str, np.ndarray], path: str | Path, metadata: Mapping[str, Any] | None = None) -> None:
    """Write named arrays [h, w] or [h, w, 3] that are no film, such as a profile table, to EXR or NPZ."""
    target = _target(path)
    if target.suffix.lower() == ".png":
        png.write({"color": layers["color"]}, target, metadata or {}, SRGB)
    elif target.suffix.lower() == ".npz":
        npz.write(layers, target, metadata or {})
    else:
        exr.write(layers, target, metadata or {}, None, None)


def read_layers(path: str | Path) -> tuple[dict[str, np.ndarray], dict[str, Any]]:
    """Layers (name -> [h, w] or [h, w, n]) and header of an EXR or NPZ file; OSError when it cannot be read."""
    source = Path(path)
    if not source.is_file():
        raise FileNotFoundError(f"{source}: no such image file")
    return npz.read(source) if source.suffix.lower() == ".npz" else exr.read(source)


def check_writable(path: str | Path) -> None:
    """Say now, not after the rendering, that ``path`` cannot be written.

    ValueError on an unknown suffix; OSError naming the path when its folder is missing or it may not be written.
    """
    target = _target(path)
    if target.is_dir():
        raise IsADirectoryError(f"{target}: is a folder; name a file in it")
    if not target.parent.is_dir():
        raise FileNotFoundError(f"{target}: cannot be written, there is no folder {target.parent}; create it first")
    draft = begin(target)
    draft.unlink()


def _target(path: str | Path) -> Path:
    target = Path(path)
    if target.suffix.lower() not in SUFFIXES:
        raise ValueError(f"{target}: the suffix {target.suffix!r} is not one of {', '.join(SUFFIXES)}")
    return target
