"""Rays sent through a profile once, and every table that their paths can fill: mirror, any Fresnel, any slice in
theta."""

from dataclasses import dataclass
from typing import Any

import numpy as np
import warp as wp

from scratchwarp.profiles import energy_kernels as energies
from scratchwarp.profiles.launch import launch_tiles
from scratchwarp.profiles.outline import outline
from scratchwarp.profiles.path_device import Cosines
from scratchwarp.profiles.polarised_kernels import Amplitudes, reflect_polarised
from scratchwarp.profiles.profile import Profile
from scratchwarp.profiles.reflectors import Rows
from scratchwarp.profiles.trace_kernels import Lines, beam_kernel, sample_kernel

_BOUNCES_EXPECTED = 4


@dataclass(frozen=True)
class Beams:
    """Where the rays of some columns start: each column (one bin of phi_i) has ``lines_each`` directions of incidence.

    ``phi`` ``[columns * lines_each]`` [rad], ``half`` the half range of incidence that each line stands for (0: a
    single direction), ``low`` and ``high`` the sines of the column's edges, used by the samplers that draw
    incidences.
    """

    phi: np.ndarray
    half: np.ndarray
    offset: np.ndarray
    low: np.ndarray
    high: np.ndarray
    lines_each: int


@dataclass(frozen=True)
class Paths:
    """What the rays of some columns did, held on the device: ready for ``tabulate`` with any reflectance."""

    beams: Beams
    bins: int
    sampler: str
    lines: Any
    cosines: Any
    threads: int

    @property
    def rays(self) -> int:
        """Rays traced."""
        return int(self.lines.counts.numpy()[:, 0].sum())

    def tabulate(self, rows: Rows | None = None) -> tuple[np.ndarray, np.ndarray]:
        """``(energy, lost)``: ``energy`` float32 ``[columns, 3 + layers, bins]`` is the share of a column's light
        that leaves into each bin of phi_o after 1, 2, 3 and more reflections off mirrors, then for each layer of
        ``rows``. ``lost`` ``[columns]`` is the share of paths cut off."""
        layers = 0 if rows is None else rows.layers
        line_count, capacity = self.lines.phi_o.shape
        columns = line_count // self.beams.lines_each
        shape = (line_count, capacity, layers) if layers else (1, 1, 0)
        product = wp.empty(shape, dtype=float, device="cpu")
        if rows is not None and rows.amplitude is not None:
            amplitudes = Amplitudes()
            amplitudes.table = wp.array(rows.amplitude, dtype=wp.vec4, device="cpu")
            amplitudes.sine = _floats(rows.sine)
            inputs = [self.lines, self.cosines, amplitudes, product]
            launch_tiles(reflect_polarised, line_count, inputs, self.threads)
        elif rows is not None:
            inputs = [self.lines, self.cosines, _floats(rows.power), product]
            launch_tiles(energies.reflect_along, line_count, inputs, self.threads)
        deposit = energies.Deposit()
        deposit.half = _floats(self.beams.half)
        deposit.offset = _floats(self.beams.offset)
        deposit.product = product
        deposit.energy = wp.zeros((columns, 3 + layers, self.bins), dtype=float, device="cpu")
        deposit.lost = wp.zeros(columns, dtype=float, device="cpu")
        deposit.lines_each = self.beams.lines_each
        fill = energies.deposit_strips if self.sampler == "beam" else energies.deposit_samples
        launch_tiles(fill, columns, [self.lines, deposit], self.threads)
        energy, lost = deposit.energy.numpy(), deposit.lost.numpy()
        if self.sampler != "beam":
            energy, lost = energy / np.float32(capacity), lost / np.float32(capacity)
        return energy, lost


def trace_lines(
    profile: Profile,
    beams: Beams,
    *,
    bins: int,
    rays: int,
    sampler: str,
    max_bounces: int,
    seed: int,
    first: int,
    threads: int,
) -> Paths:
    """Send ``rays`` rays a line into ``profile`` and keep what they did. ``sampler``: "beam", "stratified" or "random".

    ``first`` numbers the lines for the random samplers. The pool of cosines holds a few bounces a ray; when paths are
    longer it is enlarged and the lines traced again.
    """
    target = outline(profile)
    lines = _lines(len(beams.phi), rays, sampler == "beam")
    lines.phi = _floats(beams.phi)
    lines.bin = np.pi / bins
    lines.max_bounces = max_bounces
    cosines = Cosines()
    capacity = rays * _BOUNCES_EXPECTED + 2 * max_bounces
    height_field = not profile.overhangs
    extra: list[Any] = []
    if sampler == "beam":
        kernel = beam_kernel(height_field)
        lines.base = max(2, rays // 2)
    else:
        kernel = sample_kernel(height_field)
        extra = [_floats(beams.low), _floats(beams.high), seed, first, int(sampler == "stratified")]
    while True:
        cosines.value = wp.empty(len(beams.phi) * capacity, dtype=float, device="cpu")
        cosines.capacity = capacity
        launch_tiles(kernel, len(beams.phi), [target, lines, cosines, *extra], threads)
        needed = int(lines.counts.numpy()[:, 2].max())
        if needed <= capacity:
            return Paths(beams, bins, sampler, lines, cosines, threads)
        capacity = needed


def _lines(count: int, capacity: int, strips: bool) -> Any:
    lines = Lines()
    shape = (count, capacity + 1) if strips else (count, capacity)
    for name in ("x", "phi_o"):
        setattr(lines, name, wp.empty(shape, dtype=float, device="cpu"))
    for name in ("bounces", "first"):
        setattr(lines, name, wp.empty(shape, dtype=int, device="cpu"))
    if strips:
        for name in ("rate_x", "rate_phi", "width"):
            setattr(lines, name, wp.empty(shape, dtype=float, device="cpu"))
        for name in ("left", "right"):
            setattr(lines, name, wp.empty(shape, dtype=int, device="cpu"))
        lines.queue = wp.empty((count, 3 * shape[1]), dtype=int, device="cpu")
    lines.counts = wp.empty((count, 3), dtype=int, device="cpu")
    return lines


def _floats(values: Any) -> Any:
    return wp.array(np.ascontiguousarray(values, np.float32), dtype=float, device="cpu")
