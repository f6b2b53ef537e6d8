"""One rendering of one setting: what it took, and the file in which such measurements lie."""

import json
import os
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

from ..scene.knob import Value
from ..whole import whole

Setting = dict[str, Value]
PARTS = ("plan", "simulate", "build", "trace")


@dataclass(frozen=True)
class Measurement:
    """One rendering.

    Attributes:
        knobs: what is turned away from the defaults. repeat: number of the round, which has a seed of its own.
        seconds: part -> wall-clock seconds of ``PARTS``, and ``compile`` beside them, which only the first has.
        base: seconds of the defaults in the same round.
        error: relMSE against the reference. bias: against the knob's own reference value with the same samples, None
            where several are turned. flip: None where it is not installed. table: error of the tables themselves, where
            only they are turned (see ``table_error``). doubt: standard error of ``error``, from its spread over pixels.
        unsure: standard error of ``bias`` or ``beside``, from its spread over pixels.
        beside: bias of the defaults against this, where it is a knob at its value in the reference.
    """

    knobs: Mapping[str, Value]
    repeat: int
    seconds: Mapping[str, float]
    base: float
    error: float
    bias: float | None = None
    flip: float | None = None
    seed: int = field(default=0)
    table: float | None = None
    doubt: float = 0.0
    beside: float | None = None
    unsure: float = 0.0

    @property
    def total(self) -> float:
        """Seconds without compiling."""
        return sum(self.seconds.get(part, 0.0) for part in PARTS)


def setting_name(knobs: Mapping[str, Value]) -> str:
    """What is turned, as text.

    >>> setting_name({"spp": 4})
    'spp=4'
    """
    return ", ".join(f"{name}={value}" for name, value in sorted(knobs.items())) or "defaults"


class Notebook:
    """Measurements in a file of lines, kept as they come. ``key``: of the study; a file of another one is not read.

    ``chosen``: what else the first line says of it, and what a file must say to be read. Without a folder everything
    stays in memory.
    """

    def __init__(self, folder: Path | None, key: str, chosen: Mapping[str, Any] | None = None) -> None:
        self.rows: list[Measurement] = []
        self.chosen = dict(chosen or {})
        self.file = folder / "measurements.jsonl" if folder is not None else None
        self.resumed = 0
        if self.file is None:
            return
        try:
            self.file.parent.mkdir(parents=True, exist_ok=True)
        except OSError as error:
            raise OSError(f"{folder}: no folder can be made there ({error.strerror}); choose another") from error
        lines = self.file.read_text(encoding="utf-8").splitlines() if self.file.is_file() else []
        if lines and _loaded(lines[0]) == json.loads(json.dumps({"study": key, **self.chosen})):
            known = (_loaded(line) for line in lines[1:])
            self.rows = [Measurement(**row) for row in known if row is not None]
            self.resumed = len(self.rows)
        with whole(self.file) as draft:
            rows = [{"study": key, **self.chosen}, *(asdict(row) for row in self.rows)]
            draft.write_text("".join(json.dumps(row) + "\n" for row in rows), encoding="utf-8")

    def add(self, row: Measurement) -> None:
        """Keep a measurement."""
        self.rows.append(row)
        if self.file is not None:
            with self.file.open("a", encoding="utf-8") as stream:
                stream.write(json.dumps(asdict(row)) + "\n")
                stream.flush()
                os.fsync(stream.fileno())

    def has(self, knobs: Mapping[str, Value], repeat: int) -> bool:
        """Whether a rendering is there already."""
        return any(row.repeat == repeat and dict(row.knobs) == dict(knobs) for row in self.rows)


def header(folder: Path | None) -> dict[str, Any] | None:
    """What the first line of a folder's notebook says; None without one."""
    file = folder / "measurements.jsonl" if folder is not None else None
    if file is None or not file.is_file():
        return None
    with file.open(encoding="utf-8") as stream:
        found = _loaded(stream.readline())
    return found if isinstance(found, dict) else None


def _loaded(line: str) -> Any:
    """A line, or None where an interruption cut it off."""
    try:
        return json.loads(line)
    except ValueError:
        return None
