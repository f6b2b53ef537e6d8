"""A study from the command line: sweep, report, and what is printed of it."""

import json
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from ..render.progress import bar
from ..scene import Scene, Settings
from .sweeping import sweep


@dataclass(frozen=True)
class Written:
    """The report's page, the front as text, everything as JSON."""

    page: Path
    text: str
    json: str


def run(
    scene: Scene,
    knobs: tuple[str, ...] | None,
    repeats: int,
    settings: Settings,
    budget: float | None,
    folder: str,
    quiet: bool = False,
    widths: Sequence[int] = (),
    begun: float | None = None,
) -> Written:
    """Sweep and write the report; arguments and errors as of ``sweep``."""
    with bar(quiet, Path(scene.path).name) as progress:
        how: dict[str, Any] = {"settings": settings, "budget": budget, "folder": folder, "widths": widths}
        report = sweep(scene, knobs, repeats=repeats, progress=progress, begun=begun, **how)
    page = report.write(folder)
    lines = [f"{row.seconds:9.3g} s  relMSE {row.error:<9.3g} {row.name}" for row in report.pareto()]
    return Written(page, "\n".join([*lines, str(page)]), json.dumps(report.record(), default=_plain))


def _plain(value: Any) -> Any:
    return value.tolist() if hasattr(value, "tolist") else str(value)
