"""Image files from strangers: sizes are checked before anything is decoded, messages are one line."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from ..scene import Budget, TooLarge

BOMB = 10_000
"""An image that claims more than so many bytes for each byte of its file is none: no codec of ours packs so well."""
SMALL = 64e6


def check_size(path: Path, spec: Any, budget: Budget | None, channels: int = 4) -> None:
    """TooLarge (a ValueError) where the image would take more than ``budget`` leaves (None: most of this machine's
    memory) as floats of ``channels``, or claims a size that its file cannot hold."""
    texels, native = float(spec.width) * spec.height * max(spec.depth, 1), max(spec.nchannels, 1)
    said, claimed = f"{spec.width} x {spec.height} pixels of {native} channels", float(spec.image_bytes(True))
    if claimed > SMALL and claimed > BOMB * path.stat().st_size:
        raise TooLarge(f"{path}: claims {said} in {path.stat().st_size} bytes; it is damaged or a bomb")
    (budget or Budget()).take(4.0 * channels * texels, path, said, besides=4.0 * native * texels)


def one_line(error: Callable[[], str]) -> str:
    """What OpenImageIO says; damaged files leave bytes in it that are no text."""
    try:
        return " ".join(error().split())
    except UnicodeDecodeError as wrong:
        return " ".join(bytes(wrong.object).decode("ascii", "replace").split())


@contextmanager
def legible(path: Path) -> Iterator[None]:
    """OSError naming ``path`` where the names or attributes of a file are no text."""
    try:
        yield
    except UnicodeDecodeError:
        raise OSError(f"{path}: cannot be decoded (names in it are no text)") from None
