"""Pack simulated profile tables for the device."""

from collections.abc import Sequence
from typing import Any, NamedTuple

import numpy as np
import warp as wp

from ..profiles.theta import theta_model
from .profile_table_device import TableArrays

RENDERED = ("gamma", "quadratic", "table")  # theta models that the device reads, from the cheapest
SPARE = 2  # tables that there is room for where tables will change
SUMMED = RENDERED[1:]  # those whose integrals along a cone follow from sums of their rows
_LUMINANCE = (0.2126, 0.7152, 0.0722)


def table_bytes(resolution: int, varies: str | None, summed: bool = False) -> int:
    """What one table takes on the device; ``varies``: its theta model, None for a mirror; ``summed``: with sums along
    the cone."""
    model = None if varies is None else theta_model(varies)
    rows = 0 if varies is None else 3 if model is None else len(model.places)
    cells = resolution * resolution
    return cells * (4 + 4 + 12 * rows) + (16 * cells * max(rows, 1) if summed else 0)


def rows_to_unit_energy(mirror: np.ndarray, weights: np.ndarray, lost: np.ndarray | float = 0.0) -> np.ndarray:
    """Scale each phi_o row of a mirror table so that sum_i mirror[j, i] w_i = 1, or 1 - lost[j].

    The simulation conserves energy over phi_o; reciprocity carries that to rows up to its sampling error (below 1e-3 at
    the default rays), which this removes so that a furnace stays white. Rows without energy become Lambertian.
    """
    energy = mirror @ weights
    empty = energy <= 1e-6
    scaled = mirror / np.where(empty, 1.0, energy)[:, None]
    scaled[empty] = 0.5
    return scaled * np.broadcast_to(1.0 - np.asarray(lost), empty.shape)[:, None]


def _rows(table: Any, scale: np.ndarray) -> tuple[np.ndarray, int, float]:
    """(rows [phi_o, n, phi_i, 3] of a reflector's table, its steps, its shift); see ``TableArrays``."""
    model = theta_model(table.theta_model)
    mirror = np.repeat((table.mirror * scale)[..., None], 3, axis=-1)

    def colored(values: np.ndarray) -> np.ndarray:
        return np.broadcast_to(values if values.ndim == 3 else values[..., None], mirror.shape)

    if model is None:
        made = [mirror, colored(table.normal) * scale[..., None], colored(table.gamma)]
        return np.stack(made, axis=1), 0, 0.0
    steps = len(model.cosines)
    if not np.allclose(model.places, np.arange(steps + 1) / steps):
        raise ValueError(f"theta_model {table.theta_model!r} has no equal steps; the renderer reads {RENDERED}")
    # the model's cosines descend from 1, its steps ascend from the mirror
    at = [int(np.abs(table.slice_cosines - mu).argmin()) for mu in model.cosines[::-1]]
    slices = [colored(table.slices[k]) * scale[..., None] for k in at]
    return np.stack([mirror, *slices], axis=1), steps, model.shift


class _Packed(NamedTuple):
    """One table as the device has it; ``rows`` None for a mirror."""

    mirror: np.ndarray
    cdf: np.ndarray
    rows: np.ndarray | None
    steps: int
    shift: float


def _packed(table: Any) -> _Packed:
    raw = np.asarray(table.mirror, np.float64)
    weights = np.asarray(table.weights, np.float64)
    unit = rows_to_unit_energy(raw, weights)
    sums = np.cumsum(unit * weights, axis=1)
    cdf = np.zeros((len(raw), len(raw) + 1), np.float32)
    cdf[:, 1:] = sums / sums[:, -1:]
    unit = rows_to_unit_energy(raw, weights, np.asarray(table.lost, np.float64))
    if table.normal is None:
        return _Packed(unit.astype(np.float32), cdf, None, 0, 0.0)
    # a cell's albedo is its slice over its mirror: keep that ratio under the row scaling
    scale = np.divide(unit, raw, out=np.ones_like(raw), where=raw > 0).astype(np.float32)
    made, steps, shift = _rows(table, scale)
    return _Packed(unit.astype(np.float32), cdf, made.astype(np.float32), steps, shift)


def _sums(table: Any, one: _Packed) -> np.ndarray:
    """Running sums [phi_o, n, M + 1, 4] of rows [phi_o, n, phi_i, 3] times bin weights; see ``TableArrays``."""
    if one.rows is not None and one.steps == 0:
        raise ValueError(f"theta_model {table.theta_model!r} has no sums along a cone; choose one of {SUMMED}")
    rows = np.repeat(one.mirror[:, None, :, None], 3, axis=-1) if one.rows is None else one.rows
    result = np.zeros((rows.shape[0], rows.shape[1], rows.shape[2] + 1, 4))
    np.cumsum(rows * np.asarray(table.weights)[:, None], axis=2, dtype=np.float64, out=result[:, :, 1:, :3])
    result[..., 3] = result[..., :3] @ np.array(_LUMINANCE)
    return result.astype(np.float32)


def pack(
    tables: Sequence[Any],
    device: str = "cpu",
    earlier: tuple[Sequence[Any], TableArrays] | None = None,
    summed: bool = False,
    roomy: bool = False,
) -> TableArrays:
    """Device arrays of ``profiles`` tables, all of one resolution, each of a theta model in ``RENDERED``.

    Args:
        earlier: tables packed before, likewise, and their arrays: what is in them is taken from there, and they are
            written over where only some tables are others.
        summed: with the sums that integrals along a cone need; ValueError on a table that varies by "gamma" then.
        roomy: with room for ``SPARE`` more tables, so that later ones find a place among ``earlier`` ones.
    """
    if not wp.get_device(device).is_cpu:
        earlier, roomy = None, False  # what comes back from another device is slower than packing anew
    if earlier is not None and _replaced(tables, *earlier, summed):
        return earlier[1]
    if earlier is not None and roomy:
        found = _fitted(tables, *earlier, summed)
        if found is not None:
            return found
    packed = TableArrays()
    bins = len(tables[0].weights) if tables else 1
    packed.bins = bins
    count = max(len(tables), 1)
    mirror = np.zeros((count, bins, bins), np.float32)
    cdf = np.zeros((count, bins, bins + 1), np.float32)
    first, steps, shift = np.full(count, -1, np.int32), np.zeros(count, np.int32), np.zeros(count, np.float32)
    rows: list[np.ndarray] = []
    running: list[np.ndarray] = []
    first_sum = np.zeros(count, np.int32)
    there = {} if earlier is None else {id(t): k for k, t in enumerate(earlier[0])}
    for k, table in enumerate(tables):
        known = _unpacked(earlier[1], there[id(table)]) if earlier is not None and id(table) in there else None
        one = known[0] if known else _packed(table)
        mirror[k], cdf[k] = one.mirror, one.cdf
        if one.rows is not None:
            first[k], steps[k], shift[k] = sum(r.shape[1] for r in rows), one.steps, one.shift
            rows.append(one.rows)
        if summed:
            first_sum[k] = sum(r.shape[1] for r in running)
            running.append(known[1] if known else _sums(table, one))
    if roomy:  # beside the widest of them
        rows += [np.zeros_like(max(rows, key=lambda r: r.shape[1]))] * SPARE if rows else []
        running += [np.zeros_like(max(running, key=lambda r: r.shape[1]))] * SPARE if running else []
    every = np.concatenate(rows, axis=1) if rows else np.zeros((1, 1, 1, 3), np.float32)
    packed.slices = wp.array(every, dtype=wp.vec3, device=device)
    packed.mirror = wp.array(mirror, dtype=float, device=device)
    packed.cdf = wp.array(cdf, dtype=float, device=device)
    packed.first = wp.array(first, dtype=int, device=device)
    packed.steps = wp.array(steps, dtype=int, device=device)
    packed.shift = wp.array(shift, dtype=float, device=device)
    every = np.concatenate(running, axis=1) if running else np.zeros((1, 1, 1, 4), np.float32)
    packed.sums = wp.array(every, dtype=wp.vec4, device=device)
    packed.first_sum = wp.array(first_sum, dtype=int, device=device)
    return packed


def _count(first: int, steps: int) -> int:
    """Rows that a table has in ``slices``."""
    return 0 if first < 0 else steps + 1 if steps else 3


def _fitted(tables: Sequence[Any], old: Sequence[Any], packed: TableArrays, summed: bool) -> Any:
    """Other tables than the ``old`` ones in their large arrays: those that are known stay where they are, others go
    where there is room. None, with nothing done, where there is too little."""
    if not tables or any(len(t.weights) != packed.bins for t in tables):
        return None
    there = {id(t): k for k, t in enumerate(old)}
    first, steps, first_sum = (a.numpy() for a in (packed.first, packed.steps, packed.first_sum))
    slices, sums = packed.slices.numpy(), packed.sums.numpy()
    known = [there.get(id(t)) for t in tables]
    made = {i: _packed(t) for i, (t, k) in enumerate(zip(tables, known, strict=True)) if k is None}
    counts = {k: _count(int(first[k]), int(steps[k])) for k in known if k is not None}
    taken = {(int(first[k]), int(first[k]) + count) for k, count in counts.items() if count}
    summing = {(int(first_sum[k]), int(first_sum[k]) + max(count, 1)) for k, count in counts.items() if summed}
    places: dict[int, tuple[int, int]] = {}
    for i, one in made.items():
        wide = 0 if one.rows is None else one.rows.shape[1]
        at = _gap(taken, wide, slices.shape[1]) if wide else -1
        sum_at = _gap(summing, max(wide, 1), sums.shape[1]) if summed else 0
        if at is None or sum_at is None:
            return None
        places[i] = at, sum_at
        taken |= {(at, at + wide)} if wide else set()
        summing |= {(sum_at, sum_at + max(wide, 1))} if summed else set()
    everything = [made[i] if k is None else _unpacked(packed, k)[0] for i, k in enumerate(known)]
    lying = [places[i] if k is None else (int(first[k]), int(first_sum[k])) for i, k in enumerate(known)]
    for i, one in made.items():
        if one.rows is not None:
            slices[:, places[i][0] : places[i][0] + one.rows.shape[1]] = one.rows
        if summed:
            added = _sums(tables[i], one)
            sums[:, places[i][1] : places[i][1] + added.shape[1]] = added
    found, device = TableArrays(), packed.slices.device
    found.bins, found.slices, found.sums = packed.bins, packed.slices, packed.sums
    found.mirror = wp.array(np.stack([one.mirror for one in everything]), dtype=float, device=device)
    found.cdf = wp.array(np.stack([one.cdf for one in everything]), dtype=float, device=device)
    found.first = wp.array(np.array([at for at, _ in lying], np.int32), dtype=int, device=device)
    found.first_sum = wp.array(np.array([at for _, at in lying], np.int32), dtype=int, device=device)
    found.steps = wp.array(np.array([one.steps for one in everything], np.int32), dtype=int, device=device)
    found.shift = wp.array(np.array([one.shift for one in everything], np.float32), dtype=float, device=device)
    return found


def _gap(taken: set[tuple[int, int]], wide: int, room: int) -> int | None:
    """Where ``wide`` free places lie among ``room`` ones; None: nowhere."""
    at = 0
    for start, end in sorted(taken):
        if start - at >= wide:
            return at
        at = max(at, end)
    return at if room - at >= wide else None


def _unpacked(packed: TableArrays, k: int) -> tuple[_Packed, np.ndarray]:
    """Table number ``k`` of device arrays, and its running sums."""
    first, steps, at = int(packed.first.numpy()[k]), int(packed.steps.numpy()[k]), int(packed.first_sum.numpy()[k])
    count = _count(first, steps)
    rows = packed.slices.numpy()[:, first : first + count] if count else None
    one = _Packed(packed.mirror.numpy()[k], packed.cdf.numpy()[k], rows, steps, float(packed.shift.numpy()[k]))
    return one, packed.sums.numpy()[:, at : at + max(count, 1)]


def _replaced(tables: Sequence[Any], old: Sequence[Any], packed: TableArrays, summed: bool) -> bool:
    """Put other tables in the place of ``old`` ones; False, with nothing done, where they do not fit."""
    if len(tables) != len(old) or not tables or any(len(t.weights) != packed.bins for t in tables):
        return False
    others = {k: _packed(t) for k, t in enumerate(tables) if t is not old[k]}
    first, steps, first_sum = packed.first.numpy(), packed.steps.numpy(), packed.first_sum.numpy()
    if any((one.rows is None) != (first[k] < 0) or one.steps != steps[k] for k, one in others.items()):
        return False
    mirror, cdf, slices, shift = (a.numpy() for a in (packed.mirror, packed.cdf, packed.slices, packed.shift))
    for k, one in others.items():
        mirror[k], cdf[k], shift[k] = one.mirror, one.cdf, one.shift
        if one.rows is not None:
            slices[:, first[k] : first[k] + one.rows.shape[1]] = one.rows
        if summed:
            made = _sums(tables[k], one)
            packed.sums.numpy()[:, first_sum[k] : first_sum[k] + made.shape[1]] = made
    return True
