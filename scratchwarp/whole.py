"""A file that appears whole or not at all."""

import os
import uuid
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
        try:
            os.replace(draft, path)
        except OSError as error:
            raise OSError(f"{path}: cannot be written ({error.strerror})") from error
    finally:
        draft.unlink(missing_ok=True)


def begin(path: Path) -> Path:
    """An empty file beside ``path``, with a name of its own and the same suffix; OSError when there can be none."""
    draft = path.with_name(f".{path.stem}.{uuid.uuid4().hex[:12]}{path.suffix}")
    try:
        draft.open("xb").close()
    except OSError as error:
        raise OSError(f"{path}: cannot be written ({error.strerror}); choose another folder") from error
    return draft
