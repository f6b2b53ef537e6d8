"""How much memory what is read from a stage may take: stages come from strangers."""

import os

from .errors import StageError

UNITS = {"": 1.0, "K": 1e3, "M": 1e6, "G": 1e9, "T": 1e12}


class TooLarge(StageError):
    """Something of a stage would take more memory than it may."""


class Budget:
    """Bytes that the meshes, curves, instances and images of one scene may take together.

    ``limit``: None is three quarters of this machine's memory.
    """

    def __init__(self, limit: float | None = None) -> None:
        self.limit = 0.75 * physical() if limit is None else float(limit)
        self.given = limit is not None
        self.taken = 0.0

    def fresh(self) -> "Budget":
        """The same limit with nothing taken."""
        return Budget(self.limit if self.given else None)

    def take(self, size: float, owner: object, what: str, besides: float = 0.0) -> None:
        """Note ``size`` bytes, with ``besides`` more for a moment; TooLarge naming ``owner`` and ``what`` it is, before
        anything is allocated."""
        if self.taken + size + besides > self.limit:
            room = f"{spelled(self.limit)} are allowed" + (f", {spelled(self.taken)} are taken" if self.taken else "")
            raise TooLarge(
                f"{owner}: {what} would take {spelled(size + besides)}; {room}; make it smaller or raise --max-memory"
            )
        self.taken += size


def physical() -> float:
    """Bytes of memory of this machine; 8 GB where it does not say."""
    try:
        return float(os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE"))
    except (AttributeError, ValueError, OSError):
        return 8e9


def spelled(size: float) -> str:
    """Bytes as text.

    >>> spelled(1.5e9)
    '1.5 GB'
    """
    unit = max((u for u in UNITS if UNITS[u] <= max(size, 1.0)), key=lambda u: UNITS[u])
    return f"{size / UNITS[unit]:.3g} {unit}B" if unit else f"{size:.0f} bytes"


def parsed(text: str) -> float:
    """Bytes from text such as 500M, 8G or 1e9; ValueError on anything else.

    >>> parsed("8G")
    8000000000.0
    """
    plain = text.strip().upper().removesuffix("B")
    unit = plain[-1:] if plain[-1:] in UNITS else ""
    try:
        size = float(plain.removesuffix(unit)) * UNITS[unit]
    except ValueError:
        size = -1.0
    if not 1.0 <= size < 1e18:
        raise ValueError(f"{text!r} is no size such as 500M or 8G")
    return size
