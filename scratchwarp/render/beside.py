"""Images beside one another on a farm: the next one begins when every tile of those before it is at a worker."""

import threading
import time
from collections import deque
from collections.abc import Callable, Iterable, Iterator
from typing import Generic, TypeVar

from ..scene.memory import physical
from .farm import Farm
from .interrupt import PATIENCE, Control, Stopped

AHEAD = 8
"""Images that may be under way; fewer where memory does not hold so many."""
COPIES = 4
"""Of an image that this machine holds while it is under way: read, packed, and its film in the making."""
POLL = 0.05
Made = TypeVar("Made")


class _Running(threading.Thread, Generic[Made]):
    """One image in the making."""

    def __init__(self, make: Callable[[Control], Made]) -> None:
        super().__init__(daemon=True)
        self.control = Control()
        self._make = make
        self.failure: BaseException | None = None
        self._made: list[Made] = []
        self.start()

    def run(self) -> None:
        try:
            self._made.append(self._make(self.control))
        except BaseException as error:  # handed on by result()
            self.failure = error
        self.control.handed.set()

    def result(self) -> Made:
        """What was made; raises what kept it from being made."""
        if self.failure is not None:
            raise self.failure
        return self._made[0]


def side_by_side(
    farm: Farm, makers: Iterable[Callable[[Control], Made]], control: Control | None = None
) -> Iterator[Made]:
    """What each of ``makers`` makes, in their order.

    Each runs in a thread of its own and renders on ``farm`` by the Control that it is given, which hears what
    ``control`` hears. At most ``AHEAD`` are under way, and no more than memory holds. Where one fails, those before it
    are yielded, those after it stopped, and its exception is raised.
    """
    control, waiting = control or Control(), iter(makers)
    under: deque[_Running[Made]] = deque()
    more = True
    try:
        while more or under:
            most = min(AHEAD, int((farm.memory or 0.5 * physical()) / max(1, COPIES * farm.largest)))
            room = all(one.control.handed.is_set() and one.failure is None for one in under)
            if more and room and len(under) < max(2, most):
                make = next(waiting, None)
                if make is None:
                    more = False
                else:
                    under.append(_Running(make))
                continue
            if control.stop.is_set():
                raise Stopped
            if control.snapshot.is_set():
                control.snapshot.clear()
                for one in under:
                    one.control.snapshot.set()
            if under:
                under[0].join(POLL)
                if not under[0].is_alive():
                    yield under.popleft().result()
    finally:
        for one in under:
            one.control.stop.set()
        until = time.monotonic() + PATIENCE / 2
        for one in under:
            one.join(max(0.0, until - time.monotonic()))
