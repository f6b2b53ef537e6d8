"""Measured prices: seconds of each unit of work, error of each value of a knob. Shipped, or the user's own.

``scratchwarp study --calibrate`` measures the machine that it runs on and writes ``costs.json`` into the user's cache
folder ($SCRATCHWARP_CACHE, $XDG_CACHE_HOME/scratchwarp or ~/.cache/scratchwarp), where it is found from then on. Errors
do not depend on the machine; with ``--errors`` they are measured anew and written beside the prices.
"""

import json
import os
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path
from typing import Any

FORMAT = 1
_HERE = Path(__file__).parent
# Nanoseconds of units that nothing measured, as they were estimated beside those that were.
UNMEASURED = {
    "diffraction.nodes": 10000.0,
    "base.textures": 60.0, "base.normalMaps": 80.0, "base.opacity": 900.0, "lens": 20.0, "lights.mesh": 500.0,
    "lights.cylinder": 250.0, "lights.disk": 350.0, "scratches.full": 10.0, "scratches.responses": 150.0,
    "lights.coneTaps": 75.0, "base.stencils": 100.0, "base.utia": 200.0, "base.merl": 100.0, "base.rgl": 300.0,
}  # fmt: skip


@dataclass(frozen=True)
class Costs:
    """Prices of one machine.

    Attributes:
        nanoseconds: unit -> processor time of one. machine: what was measured. source: the file.
        cold: (seconds of compiling the smallest kernel, seconds more for each feature of a kernel).
        indirect: price of the work at surfaces that a path meets later, of that at the first.
        spread: factor within which predictions of the stages measured lie, nine of ten.
        efficiency: share of a thread's speed that each of several has.
    """

    nanoseconds: Mapping[str, float]
    machine: str = ""
    source: str = ""
    cold: tuple[float, float] = (4.0, 0.3)
    indirect: float = 1.0
    spread: float = 2.0
    efficiency: float = 0.9

    def of(self, unit: str) -> float:
        """Seconds of one unit; a typical price where it was not measured."""
        return 1e-9 * self.nanoseconds.get(unit, UNMEASURED.get(unit, 100.0))


@dataclass(frozen=True)
class Errors:
    """What knobs leave: ``bias``: knob -> value as text -> relMSE that most stages stay below, of what of the image it
    acts on; ``noise``: relMSE of one sample a pixel, typical, and the power of the samples by which it falls;
    ``noisier``: knob -> value as text -> noise over that at the knob's reference value, of knobs that change it."""

    bias: Mapping[str, Mapping[str, float]]
    noise: tuple[float, float] = (0.5, 1.0)
    noisier: Mapping[str, Mapping[str, float]] = field(default_factory=dict)

    def more_samples(self, knob: str, value: object) -> float:
        """How many times as many samples leave the noise that there is at the knob's reference value."""
        return self.noisier.get(knob, {}).get(str(value), 1.0) ** (1.0 / self.noise[1])


def user_file() -> Path:
    """Where ``--calibrate`` keeps the prices that it measured."""
    own = os.environ.get("SCRATCHWARP_CACHE")
    base = Path(own) if own else Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "scratchwarp"
    return base / "costs.json"


def user_errors() -> Path:
    """Where ``--calibrate --errors`` keeps what it measured."""
    return user_file().with_name("errors.json")


def costs() -> Costs:
    """The user's own prices where they can be read, else those shipped."""
    file = user_file()
    if file.is_file():
        try:
            return _costs(file, file.stat().st_mtime_ns)
        except (OSError, ValueError, KeyError, TypeError):
            return shipped()
    return shipped()


def shipped() -> Costs:
    """The prices that came with the package."""
    return _costs(_HERE / "costs.json", 0)


@lru_cache(maxsize=4)
def _costs(file: Path, _changed: int) -> Costs:
    record: dict[str, Any] = json.loads(file.read_text(encoding="utf-8"))
    if record["format"] != FORMAT:
        raise ValueError(f"{file}: format {record['format']} is not {FORMAT}; run scratchwarp study --calibrate again")
    return Costs(
        {str(k): float(v) for k, v in record["nanoseconds"].items()},
        str(record["machine"]),
        str(file),
        (float(record["cold"][0]), float(record["cold"][1])),
        float(record["indirect"]),
        float(record["spread"]),
        float(record["efficiency"]),
    )


def errors() -> Errors:
    """The user's own errors of knobs where they can be read, else those shipped."""
    file = user_errors()
    if file.is_file():
        try:
            return read_errors(file, file.stat().st_mtime_ns)
        except (OSError, ValueError, KeyError, TypeError, AttributeError):
            return shipped_errors()
    return shipped_errors()


def shipped_errors() -> Errors:
    """The errors of knobs that came with the package."""
    return read_errors(_HERE / "errors.json", 0)


@lru_cache(maxsize=4)
def read_errors(file: Path, _changed: int = 0) -> Errors:
    """A file as ``--calibrate --errors`` writes it; ValueError where it has another format."""
    record: dict[str, Any] = json.loads(file.read_text(encoding="utf-8"))
    if record["format"] != FORMAT:
        raise ValueError(f"{file}: format {record['format']} is not {FORMAT}; run scratchwarp study --calibrate again")
    bias, noisier = ({n: {v: float(x) for v, x in own.items()} for n, own in record[k].items()}
                     for k in ("bias", "noisier"))  # fmt: skip
    return Errors(bias, (float(record["noise"][0]), float(record["noise"][1])), noisier)
