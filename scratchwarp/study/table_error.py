"""How far a plan's tables are from reference ones: the quantity's own error, of which images show only a part.

Mean over tables of the integral of |rho - reference| cos(phi_o) cos(phi_i) over both angles, of that of the reference:
the share of the light that goes elsewhere, counted twice. Tables are taken for constant over their bins, at theta = 0.
"""

from collections.abc import Sequence

import numpy as np

from ..profiles import Table
from ..profiles.table import bin_weights


def slices_of(tables: Sequence[Table]) -> list[np.ndarray]:
    """What of tables is compared: each at theta = 0, mean over colours, float32 [bins, bins]."""
    slices = [np.asarray(table.slice(0.0), np.float32) for table in tables]
    return [values.mean(axis=-1) if values.ndim == 3 else values for values in slices]


def table_error(found: Sequence[np.ndarray], best: Sequence[np.ndarray]) -> float | None:
    """Mean relative difference of tables by their slices; None where there are none, others or their bins have no
    common refinement."""
    errors = []
    if len(found) != len(best):
        return None
    for one, reference in zip(found, best, strict=True):
        bins = max(len(one), len(reference))
        if bins % len(one) or bins % len(reference):
            return None
        a, b = _refined(one, bins), _refined(reference, bins)
        weights = np.outer(bin_weights(bins), bin_weights(bins))
        errors.append(float((np.abs(a - b) * weights).sum() / max(float((np.abs(b) * weights).sum()), 1e-30)))
    return float(np.mean(errors)) if errors else None


def _refined(values: np.ndarray, bins: int) -> np.ndarray:
    times = bins // len(values)
    return values.astype(np.float64).repeat(times, 0).repeat(times, 1)
