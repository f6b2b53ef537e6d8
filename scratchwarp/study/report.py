"""Report: rows of error against time, the front among them, and files to look at."""

import csv
import io
import json
import os
import platform
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, field, replace
from pathlib import Path
from statistics import median
from typing import Any

import numpy as np

from .. import __version__
from ..image import quick
from ..plan.knobs import KNOBS
from ..scene.knob import Value
from ..whole import whole
from .measurement import PARTS, Measurement, setting_name


@dataclass(frozen=True)
class Row:
    """One setting over all its rounds.

    Attributes:
        name, knobs: what is turned away from the defaults; ``name`` "defaults" for nothing.
        seconds: the median over rounds of its seconds over those of the defaults, times the median of the latter;
            ``fastest``, ``slowest``: of the same. ``parts``: median seconds of each part, ``compile`` not counted.
        error, least_error, most_error: relMSE against the reference, mean and range over rounds.
        bias: relMSE against the knob's reference value with the same samples: what is left without noise.
        flip: mean FLIP. rounds: renderings. front: nothing measured is both faster and closer.
        table: error of the tables themselves, where only they are turned.
        doubt: standard error of ``error``, from its spread over the pixels of one round.
        beside: bias of the defaults against this, where it is a knob at its value in the reference.
        unsure: standard error of ``bias`` or ``beside``, from its spread over the pixels of one round.
    """

    name: str
    knobs: Mapping[str, Value]
    seconds: float
    fastest: float
    slowest: float
    parts: Mapping[str, float]
    error: float
    least_error: float
    most_error: float
    bias: float | None
    flip: float | None
    rounds: int
    front: bool = False
    table: float | None = None
    doubt: float = 0.0
    beside: float | None = None
    unsure: float = 0.0


@dataclass(frozen=True, eq=False)
class Report:
    """What a sweep found.

    Attributes:
        rows: settings, the defaults first. about: the stage, size, threads, seeds, the reference, seconds.
        reference: its image [h, w, 3], linear Rec.709. images: row name -> image of the first round.
    """

    rows: tuple[Row, ...]
    about: Mapping[str, Any]
    reference: np.ndarray
    images: Mapping[str, np.ndarray] = field(default_factory=dict)

    @staticmethod
    def rows_of(measured: Sequence[Measurement]) -> tuple[Row, ...]:
        """Rows of measurements, with the front marked."""
        groups: dict[str, list[Measurement]] = {}
        for one in measured:
            groups.setdefault(setting_name(one.knobs), []).append(one)
        base = median(one.base for one in measured) if measured else 0.0
        rows = [_row(name, own, base) for name, own in groups.items()]
        front = {id(row) for row in rows if not any(_beats(other, row) for other in rows)}
        return tuple(Row(**{**vars(row), "front": id(row) in front}) for row in rows)

    def pareto(self) -> tuple[Row, ...]:
        """The rows that nothing measured beats in both time and error, fastest first."""
        return tuple(sorted((row for row in self.rows if row.front), key=lambda row: row.seconds))

    def knob_rows(self, name: str) -> tuple[Row, ...]:
        """The rows of one knob turned alone, and the defaults at their place with their bias in it, from cheap
        to reference."""
        default = self.about["defaults"].get(name)
        found = {row.knobs[name]: row for row in self.rows if set(row.knobs) == {name}}
        top = next((row for row in found.values() if row.beside is not None), None)
        base = next((row for row in self.rows if not row.knobs), None)
        if base is not None:
            found[default] = base if top is None else replace(base, bias=top.beside, unsure=top.unsure)
        values = sorted(found, key=lambda v: KNOBS[name].values.index(v) if v in KNOBS[name].values else int(v))
        return tuple(found[value] for value in values)

    @property
    def floor(self) -> float | None:
        """relMSE that the noise of the reference alone makes; None where it is not known."""
        return self.about.get("floor")

    def covered(self, row: Row) -> bool:
        """Whether more of a row's error is the noise of the reference than its own."""
        return self.floor is not None and row.error < 2.0 * self.floor

    def sorted_rows(self) -> tuple[Row, ...]:
        """The defaults, then rows by knob and value, then those of several knobs, fastest first."""
        single = [row for name in self.about["defaults"] for row in self.knob_rows(name)]
        order = {row.name: number for number, row in enumerate(single)}

        def key(row: Row) -> tuple[int, float]:
            return min(len(row.knobs), 2), order[row.name] if len(row.knobs) == 1 else row.seconds

        return tuple(sorted(self.rows, key=key))

    def falls(self, name: str) -> bool:
        """Whether a knob's error falls from value to value to the reference, within its noise.

        What a knob does is its bias, where it has one. Noise is what the least and the greatest error of a setting are
        apart, of one round and of biases twice the standard error of the mean over pixels; a tenth of the error (of
        biases, of the greatest) at least. "auto", which is what the plan takes, has no place among the values;
        alternatives have none either, but the last value must be below each.
        """
        default = self.about["defaults"].get(name)
        rows = [row for row in self.knob_rows(name) if row.knobs.get(name, default) != "auto"]
        values = [row.error if row.bias is None else row.bias for row in rows]
        apart = [row.most_error - row.least_error if row.rounds > 1 else 2.0 * row.doubt for row in rows]
        slack = [max(own, 0.1 * value) for own, value in zip(apart, values, strict=True)]
        biased = any(row.bias is not None for row in rows)
        if biased:  # the reference has none of its own
            rows = [row for row in rows if row.bias is not None]
            values = [row.bias for row in rows if row.bias is not None]
        aside = [row.knobs.get(name, default) in KNOBS[name].alternatives for row in rows]
        if biased:
            tenth = 0.1 * max([value for value, other in zip(values, aside, strict=True) if not other], default=0.0)
            slack = [max(2.0 * row.unsure, tenth) for row in rows]
        known = list(zip(values, slack, aside, strict=True))
        order = [one for one in known if not one[2]]
        pairs = [*zip(order, order[1:], strict=False), *((one, order[-1]) for one in known if one[2] and order)]
        return all(b <= a + max(s, t) for (a, s, _), (b, t, _) in pairs)

    def record(self) -> dict[str, Any]:
        """Everything but the images, as what JSON can hold."""
        rows = [
            {**asdict(row), "knobs": dict(row.knobs), "parts": dict(row.parts), "covered": self.covered(row)}
            for row in self.rows
        ]
        knobs = {n: _described(n) | {"falls": self.falls(n)} for n in self.about["defaults"]}
        return {"about": {**self.about, **machine()}, "knobs": knobs, "rows": rows}

    def write(self, folder: str | Path) -> Path:
        """Write report.html (one file that needs no other), report.json, report.csv and the images as PNG into
        ``folder``; the path of the page. OSError where that cannot be done."""
        from .page import page

        target = Path(folder)
        target.mkdir(parents=True, exist_ok=True)
        for name, pixels in {"reference": self.reference, **self.images}.items():
            with whole(target / f"{file_name(name)}.png") as draft:
                draft.write_bytes(quick.png(quick.eight_bit(pixels)))
        _text(target / "report.json", json.dumps(self.record(), indent=1, default=str) + "\n")
        _text(target / "report.csv", _table(self))
        _text(target / "report.html", page(self))
        return target / "report.html"


def machine() -> dict[str, Any]:
    """Hardware and versions."""
    import warp

    return {
        "machine": f"{_processor()}, {os.cpu_count()} processors, {platform.system()} {platform.release()}",
        "versions": f"scratchwarp {__version__}, Warp {warp.config.version}, NumPy {np.__version__}, "
        f"Python {platform.python_version()}",
    }


def file_name(name: str) -> str:
    """A row's name as that of a file."""
    return "".join(c if c.isalnum() or c in "=.-" else "_" for c in name)


def _processor() -> str:
    info = Path("/proc/cpuinfo")
    lines = info.read_text(encoding="utf-8", errors="replace").splitlines() if info.is_file() else []
    names = [line.partition(":")[2].strip() for line in lines if line.startswith("model name")]
    return names[0] if names else platform.processor() or platform.machine()


def _row(name: str, own: Sequence[Measurement], base: float) -> Row:
    ratios = [one.total / one.base if one.base > 0.0 else 1.0 for one in own]
    errors = [one.error for one in own]
    biases = [one.bias for one in own if one.bias is not None]
    flips = [one.flip for one in own if one.flip is not None]
    return Row(
        name=name,
        knobs=dict(own[0].knobs),
        seconds=median(ratios) * base,
        fastest=min(ratios) * base,
        slowest=max(ratios) * base,
        parts={part: median(one.seconds.get(part, 0.0) for one in own) for part in (*PARTS, "compile")},
        error=float(np.mean(errors)),
        least_error=min(errors),
        most_error=max(errors),
        bias=float(np.mean(biases)) if biases else None,
        flip=float(np.mean(flips)) if flips else None,
        rounds=len(own),
        table=next((one.table for one in own if one.table is not None), None),
        unsure=float(np.sqrt(np.mean([one.unsure**2 for one in own]) / len(own))),
        beside=float(np.mean(beside)) if (beside := [one.beside for one in own if one.beside is not None]) else None,
        doubt=float(np.sqrt(np.mean([one.doubt**2 for one in own]) / len(own))),
    )


def _beats(other: Row, row: Row) -> bool:
    no_worse = other.seconds <= row.seconds and other.error <= row.error
    return no_worse and (other.seconds < row.seconds or other.error < row.error)


def _described(name: str) -> dict[str, Any]:
    knob = KNOBS[name]
    named = {"values": knob.values, "alternatives": knob.alternatives, "reference": knob.reference}
    return {"error": knob.error, "source": knob.source, **named}


def _table(report: Report) -> str:
    head = ("name", "seconds", "fastest", "slowest", *PARTS, "compile", "error", "least_error", "most_error", "doubt")
    tail = ("bias", "flip", "table", "rounds", "front", "covered")
    stream = io.StringIO()
    writer = csv.writer(stream, lineterminator="\n")
    writer.writerow((*head, *tail))
    for row in report.rows:
        values = {**vars(row), **row.parts, "covered": report.covered(row)}
        writer.writerow([values[name] for name in (*head, *tail)])
    return stream.getvalue()


def _text(path: Path, text: str) -> None:
    with whole(path) as draft:
        draft.write_text(text, encoding="utf-8")
