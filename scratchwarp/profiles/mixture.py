"""Tables of scratches that differ: the average of several cross-sections, and cross-sections between two others."""

from collections.abc import Sequence

import numpy as np

from scratchwarp.profiles.balance import exponents
from scratchwarp.profiles.profile import Profile
from scratchwarp.profiles.table import Table, assembled


def mixture(tables: Sequence[Table], shares: Sequence[float]) -> Table:
    """What scratches reflect of which ``shares`` (any positive numbers; they are normalised) have one of ``tables``
    each: the average of their reflectances, bounces and losses.

    All tables must have one resolution, theta model and number of channels; ValueError otherwise.
    """
    if not len(tables) or len(tables) != len(shares) or min(shares) < 0.0 or not sum(shares) > 0.0:
        raise ValueError(f"shares must hold a number above 0 for each of {len(tables)} tables, got {list(shares)}")
    kinds = {(t.resolution, t.theta_model, t.slices is None or t.slices.shape) for t in tables}
    if len(kinds) > 1:
        raise ValueError(f"tables differ in resolution, theta model or channels: {sorted(map(str, kinds))}")
    first, total = tables[0], float(sum(shares))

    def mean(name: str) -> np.ndarray:
        result = sum(np.float64(w / total) * getattr(t, name) for t, w in zip(tables, shares, strict=True))
        return np.asarray(result, np.asarray(getattr(first, name)).dtype)

    by_bounce, slices, gamma, flagged = mean("by_bounce"), None, None, 0.0
    if first.slices is not None and first.slice_cosines is not None:
        slices = mean("slices")
        sixty = slices[int(np.argmin(np.abs(first.slice_cosines - 0.5)))]
        # channels go first there
        stack = [s[None] if s.ndim == 2 else np.ascontiguousarray(np.moveaxis(s, -1, 0)) for s in (slices[0], sixty)]
        exponent, flagged = exponents(by_bounce.sum(axis=0), stack[0], stack[1], 1)
        gamma = exponent[0] if slices.ndim == 3 else np.ascontiguousarray(np.moveaxis(exponent, 0, -1))
    return assembled(
        by_bounce,
        mean("lost"),
        slices=slices,
        gamma=gamma,
        slice_cosines=first.slice_cosines,
        theta_model=first.theta_model,
        gamma_flagged=flagged,
        rays=sum(t.rays for t in tables),
        metadata={**first.metadata, "mixture": len(tables)},
    )


def between(first: Profile, second: Profile, part: float) -> Profile:
    """The cross-section a ``part`` (0 to 1) of the way from ``first`` to ``second``: points as far along both outlines
    move on straight lines. ``first`` and ``second`` themselves at 0 and 1, with straight facets for arcs between.

    Raises ValueError where outlines with overhangs cross themselves on the way.
    """
    if part <= 0.0 or first.token == second.token:
        return first
    if part >= 1.0:
        return second
    outlines = [first.polyline(), second.polyline()]
    reached = []
    for points in outlines:
        run = np.concatenate(([0.0], np.cumsum(np.abs(np.diff(points, axis=0)).sum(axis=1))))
        reached.append(run / run[-1])
    every = np.unique(np.concatenate(reached).round(12))
    moved = [
        np.stack([np.interp(every, at, points[:, k]) for k in (0, 1)], axis=1)
        for at, points in zip(reached, outlines, strict=True)
    ]
    return Profile((1.0 - part) * moved[0] + part * moved[1], isolated=first.isolated)
