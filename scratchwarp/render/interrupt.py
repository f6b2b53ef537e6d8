"""Signals: an end within two seconds, and snapshots, of a render that is under way."""

import os
import signal
import socket
import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field

PATIENCE = 1.0
"""Seconds between a signal that ends a render and the end of the process, whatever it is at."""
_WORDS = 0.4
"""Seconds that the last words of a process may take: who reads them may have stopped reading."""


class Stopped(KeyboardInterrupt):
    """A render was asked to end while it traced tiles."""


@dataclass(frozen=True)
class Control:
    """What a running render is asked from outside, by any thread. ``stop``: end, keeping the checkpoint; ``snapshot``:
    show the image as it is. ``handed`` is set by the render: every tile is at a worker of a farm, so that there is room
    for another image."""

    stop: threading.Event = field(default_factory=threading.Event)
    snapshot: threading.Event = field(default_factory=threading.Event)
    handed: threading.Event = field(default_factory=threading.Event)


@contextmanager
def signals(late: Callable[[], None]) -> Iterator[Control]:
    """Yield a Control that follows this process's signals until the block ends.

    SIGINT and SIGTERM set ``stop`` and raise KeyboardInterrupt; where the block has not ended ``PATIENCE`` seconds
    later, as while a kernel is compiled, ``late()`` is called in another thread and the process ends with status 130.
    SIGUSR1 sets ``snapshot``. Does nothing but yield when called from a thread that is not the main one.
    """
    control = Control()
    if threading.current_thread() is not threading.main_thread():
        yield control
        return
    ends = {signal.SIGINT, signal.SIGTERM}
    shows = {signal.SIGUSR1} if hasattr(signal, "SIGUSR1") else set()
    over = threading.Event()
    told: list[int] = []  # no event: a second signal may interrupt the handler of the first while it holds a lock

    def interrupt(number: int, frame: object) -> None:
        told.append(number)
        if len(told) == 1:  # a second one does not disturb what the first one ends
            raise KeyboardInterrupt

    def watch() -> None:
        """Hears of a signal at once, even while the main thread is in native code and its handlers have to wait."""
        while heard := reader.recv(16):
            if any(number in heard for number in shows):
                control.snapshot.set()
            if any(number in heard for number in ends):
                control.stop.set()
                if over.wait(PATIENCE):
                    return
                words = threading.Thread(target=late, name="last words", daemon=True)
                words.start()
                words.join(_WORDS)
                os._exit(130)

    reader, writer = socket.socketpair()
    writer.setblocking(False)
    before = {number: signal.signal(number, interrupt) for number in ends}
    # the watcher does what there is to do: a handler that waits for a lock may wait for the line that it interrupts
    before |= {number: signal.signal(number, lambda *_: None) for number in shows}
    for number in shows:  # nor is a file that native code reads or writes cut off
        signal.siginterrupt(number, False)
    wakeup = signal.set_wakeup_fd(writer.fileno(), warn_on_full_buffer=False)
    watcher = threading.Thread(target=watch, name="signals", daemon=True)
    watcher.start()
    try:
        yield control
    finally:
        over.set()
        signal.set_wakeup_fd(wakeup)
        for number, handler in before.items():
            late_one = number in shows and handler == signal.SIG_DFL  # would end the process
            signal.signal(number, signal.SIG_IGN if late_one else handler)
        writer.close()
        watcher.join()
        reader.close()
