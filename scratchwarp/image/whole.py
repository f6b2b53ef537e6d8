"""A file that appears whole or not at all."""

import os
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path


@contextmanager
def whole(path: Path) -> Iterator[Path]:
    """Yield a temporary path beside ``path`` with the same suffix; it takes the place of ``path`` when the block ends
    well, and is removed when the block raises anything, KeyboardInterrupt included.

    OSError naming ``path`` when its folder cannot be written.
    """
    draft = begin(path)
    try:
        yield draft
        draft.chmod(0o666 & ~_umask())
        try:
            os.replace(draft, path)
        except OSError as error:
            raise OSError(f"{path}: cannot be written ({error.strerror})") from error
    finally:
        draft.unlink(missing_ok=True)


def begin(path: Path) -> Path:
    """An empty file beside ``path``, with a name of its own and the same suffix; OSError when there can be none."""
    try:
        handle, name = tempfile.mkstemp(prefix=f".{path.stem}.", suffix=path.suffix, dir=path.parent)
    except OSError as error:
        raise OSError(f"{path}: cannot be written ({error.strerror}); choose another folder") from error
    os.close(handle)
    return Path(name)


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask
