"""How far a plan's tables are from reference ones: the quantity's own error, of which images show only a part.

Mean over tables of the integral of |rho - reference| cos(phi_o) cos(phi_i) over both angles, of that of the reference:
the share of the light that goes elsewhere, counted twice. Tables are taken for constant over their bins, at theta = 0.
"""

from collections.abc import Sequence

import numpy as np

from ..plan import EffectPlan
from ..profiles import Table
from ..profiles.table import bin_weights
from ..render.tables import simulate_tables


def tables_of(plan: EffectPlan) -> list[Table]:
    """The plan's tables, simulated."""
    return simulate_tables(plan, plan.settings.threads or 1)[0]


def table_error(found: Sequence[Table], best: Sequence[Table]) -> float | None:
    """Mean relative difference of tables; None where there are none or their bins have no common refinement."""
    errors = []
    for one, reference in zip(found, best, strict=True):
        bins = max(one.resolution, reference.resolution)
        if bins % one.resolution or bins % reference.resolution:
            return None
        a, b = _refined(one, bins), _refined(reference, bins)
        weights = np.outer(bin_weights(bins), bin_weights(bins))
        errors.append(float((np.abs(a - b) * weights).sum() / max(float((np.abs(b) * weights).sum()), 1e-30)))
    return float(np.mean(errors)) if errors else None


def _refined(table: Table, bins: int) -> np.ndarray:
    values = np.asarray(table.slice(0.0), np.float64)
    values = values.mean(axis=-1) if values.ndim == 3 else values
    times = bins // table.resolution
    return values.repeat(times, 0).repeat(times, 1)
