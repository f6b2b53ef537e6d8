"""Coverage computed beforehand, beside the stage: thresholds of the noise that lays out scratches.

``cup.bake/coverage.json`` holds them by a hash of what decides them: the coverage that is wanted, how widths vary, and
the code that computes it. What is not there, or does not fit its SHA-256, is computed, and said.
"""

import hashlib
import json
from collections.abc import Iterable
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path
from typing import Any

from ..scene.digest import digest
from ..scratches import worley

FILE = "coverage.json"


def bake_folder(stage: str | Path) -> Path:
    """The folder of what is baked for a stage."""
    return Path(stage).with_suffix(".bake")


@lru_cache(maxsize=1)
def _code() -> str:
    return hashlib.sha256(Path(worley.__file__).read_bytes()).hexdigest()


def key(wanted: float, variation: float) -> str:
    """The hash that a threshold is kept under."""
    return digest(_code(), float(wanted), float(variation))


def _sum(thresholds: dict[str, float]) -> str:
    return hashlib.sha256(json.dumps(thresholds, sort_keys=True).encode()).hexdigest()


@dataclass
class Thresholds:
    """Thresholds of a stage; ``known``: baked ones by key, None without a bake. ``warnings``: what was stale."""

    folder: Path
    known: dict[str, float] | None = None
    warnings: list[str] = field(default_factory=list)

    def find(self, wanted: float, variation: float, label: str) -> float:
        """The threshold for a coverage, baked or computed; ``label``: the layer that asks."""
        if self.known is None:
            return worley.threshold(wanted, variation)
        found = self.known.get(key(wanted, variation))
        if found is None:
            said = f"{self.folder}: the bake of the coverage of {label} is stale; it was computed, run scratchwarp bake"
            if f"{said} again" not in self.warnings:
                self.warnings.append(f"{said} again")
            return worley.threshold(wanted, variation)
        return found


def baked_thresholds(stage: str | Path) -> Thresholds:
    """What is baked for a stage; a file that is damaged counts as none, and is said to be."""
    folder = bake_folder(stage) if str(stage) else Path()
    file = folder / FILE
    if not str(stage) or not file.is_file():
        return Thresholds(folder)
    try:
        held = json.loads(file.read_text(encoding="utf-8"))
        known = {str(name): float(value) for name, value in held["thresholds"].items()}
        if held["sha256"] == _sum(known):
            return Thresholds(folder, known)
        why = "is not the file that was baked"
    except (OSError, ValueError, KeyError, AttributeError, TypeError) as error:
        why = f"cannot be read ({error})"
    return Thresholds(folder, None, [f"{file}: {why}; coverage was computed, run scratchwarp bake again"])


def thresholds_of(plans: Iterable[Any]) -> dict[str, float]:
    """Key -> threshold of the sublayers of plans, as they were laid out."""
    found = {}
    for sub in (one.sublayer for plan in plans for own in plan.layers for one in own):
        if sub.distribution == "worley" and sub.layer.density <= 0.0:
            found[key(min(sub.coverage, worley.MOST), sub.layer.width_variation)] = sub.radius
    return dict(sorted(found.items()))


def text_of(thresholds: dict[str, float]) -> str:
    """The content of the file that ``baked_thresholds`` reads."""
    return json.dumps({"thresholds": thresholds, "sha256": _sum(thresholds)}, indent=1) + "\n"
