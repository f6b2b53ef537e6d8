"""A measured BRDF, the stencil model fitted to it and its rivals, each with its error: the rows of a fit's report."""

import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from ..reflectance import measured, stencils
from .fit_metrics import metrics

Progress = Callable[[int, int, str], None]
LABELS = {
    "stencils": "Highlight stencils",
    "kurt": "Kurt",
    "ward": "Ward",
    "ashikhmin-shirley": "Ashikhmin-Shirley",
    "ggx": "GGX",
}


@dataclass(frozen=True, eq=False)
class Candidate:
    """One fitted model: ``values`` [288, 288, 3] on the grid of the measurement, its ``metrics``, how many
    ``parameters`` were fitted, over how many lobes or modes, and the seconds that it took."""

    name: str
    model: Any
    values: np.ndarray
    metrics: dict[str, float]
    parameters: int
    lobes: int
    seconds: float

    @property
    def label(self) -> str:
        """The name as people read it."""
        what = "mode" if self.name == "stencils" else "lobe"
        return f"{LABELS[self.name]}, {self.lobes} {what}{'s' if self.lobes > 1 else ''}"


def candidates(
    brdf: Any,
    modes: int | None = None,
    refine: bool = True,
    retro: bool = False,
    rivals: Sequence[str] = measured.RIVALS,
    parameters: int | None = None,
    progress: Callable[[int, int, str], None] | None = None,
) -> list[Candidate]:
    """The stencil model fitted to ``brdf`` (``measured.Brdf`` or values [288, 288, 3]), then each of ``rivals``.

    ``modes``, ``refine``, ``retro``: as ``stencils.fit`` has them. ``parameters``: rivals get as many lobes as it takes
    to have at least so many numbers (at most 4 lobes), 0 meaning as many as the stencil model; None: two lobes for
    Kurt, one for the others. Raises ValueError on a BRDF that is none, ImportError where scipy is missing.
    """
    reference = np.asarray(brdf, np.float64)
    told = progress or _silent
    steps = 1 + len(rivals)
    told(0, steps, "fit")
    start = time.perf_counter()
    model = stencils.fit(brdf, modes, refine=refine, retro=retro)
    spent = time.perf_counter() - start
    values = stencils.unfolded(model)
    wanted = model.parameters if parameters == 0 else parameters
    off = metrics(reference, values)
    found = [Candidate("stencils", model, values, off, model.parameters, len(model.modes), spent)]
    for number, name in enumerate(rivals, 1):
        told(number, steps, "fit")
        start = time.perf_counter()
        rival = measured.fit_rival(brdf, name, None if wanted is None else measured.lobes_for(name, wanted))
        spent = time.perf_counter() - start
        values = rival.unfolded()
        found.append(
            Candidate(name, rival, values, metrics(reference, values), rival.parameters, len(rival.lobes), spent)
        )
    told(steps, steps, "fit")
    return found


def _silent(done: int, total: int, stage: str) -> None:
    """Take progress and show nothing."""
