"""Device data by part, each built again only when what it is built from has changed."""

import time
from collections.abc import Callable
from typing import Any, TypeVar

Made = TypeVar("Made")


class Parts:
    """What was built last, by name, with what it was built from.

    Sources are compared by ``==``: hand in numbers, texts and digests, which compare by value, and frozen records,
    which compare by identity.

    Attributes:
        seconds: name -> seconds of each part that was built since this was emptied.
    """

    def __init__(self) -> None:
        self.seconds: dict[str, float] = {}
        self._built: dict[str, tuple[tuple[Any, ...], Any]] = {}

    def part(self, name: str, sources: tuple[Any, ...], build: Callable[[], Made]) -> Made:
        """The part ``name``: what is there if it was built from equal ``sources``, else what ``build`` makes."""
        known = self._built.get(name)
        if known is not None and known[0] == sources:
            return known[1]
        start = time.perf_counter()
        made = build()
        self.seconds[name] = time.perf_counter() - start
        self._built[name] = (sources, made)
        return made

    def last(self, name: str) -> tuple[tuple[Any, ...], Any] | None:
        """(sources, what was built from them) of a part; None before it is built."""
        return self._built.get(name)

    def copy(self, but: tuple[str, ...] = ()) -> "Parts":
        """Another one that starts with what is built here, ``but`` for some parts."""
        other = Parts()
        other._built = {name: part for name, part in self._built.items() if name not in but}
        return other
