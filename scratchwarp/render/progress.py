"""A progress bar: samples a second and time left."""

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager

Progress = Callable[[int, int, str], None]


def silent(done: int, total: int, stage: str) -> None:
    """Take progress and show nothing."""


@contextmanager
def bar(quiet: bool = False, title: str = "") -> Iterator[Progress]:
    """Yield ``progress(done, total, stage)``, which draws a bar on stderr.

    It may be called from any thread. A new ``stage`` starts a new line, so that the speed is that of the stage alone;
    the stage "trace" counts samples, the others steps.
    Silent when ``quiet``, or when stderr is no terminal.
    """
    with bars(quiet) as begin:
        yield begin(title)


@contextmanager
def bars(quiet: bool = False) -> Iterator[Callable[[str], Progress]]:
    """Yield ``begin(title)``, which gives the ``progress`` of one of several images that are made at a time, as ``bar``
    has it. A stage "done" takes the lines of its image away."""
    if quiet or not sys.stderr.isatty():
        yield lambda title: silent
        return
    from rich.console import Console
    from rich.progress import (
        BarColumn,
        ProgressColumn,
        Task,
        TaskID,
        TaskProgressColumn,
        TextColumn,
        TimeRemainingColumn,
    )
    from rich.progress import Progress as Bars
    from rich.text import Text

    class Speed(ProgressColumn):
        def render(self, task: Task) -> Text:
            rate = (task.finished_speed or task.speed) if task.fields["in_samples"] else None
            return Text(speed(rate), style="progress.data.speed")

    columns = (TextColumn("{task.description}"), BarColumn(), TaskProgressColumn(), Speed(), TimeRemainingColumn())
    # what is printed meanwhile goes above the bars, unless it goes elsewhere
    with Bars(*columns, console=Console(stderr=True), redirect_stdout=sys.stdout.isatty()) as shown:

        def begin(title: str) -> Progress:
            tasks: dict[str, TaskID] = {}

            def progress(done: int, total: int, stage: str) -> None:
                if stage == "done":
                    for task in tasks.values():
                        shown.remove_task(task)
                    tasks.clear()
                    return
                if stage not in tasks:
                    name = " ".join(word for word in (title, stage) if word)
                    tasks[stage] = shown.add_task(name, total=total, in_samples=stage == "trace")
                shown.update(tasks[stage], completed=done, total=total)

            return progress

        yield begin


def speed(samples_per_second: float | None) -> str:
    """``samples_per_second`` as text with three digits, empty for None.

    >>> speed(1234567.0)
    '1.23 M samples/s'
    """
    if samples_per_second is None:
        return ""
    for factor, letter in ((1e9, "G "), (1e6, "M "), (1e3, "k ")):
        if samples_per_second >= factor:
            return f"{samples_per_second / factor:.3g} {letter}samples/s"
    return f"{samples_per_second:.3g} samples/s"
