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
from scratchwarp.profiles.profile import Profile
from scratchwarp.profiles.trace_kernels import Lines, beam_kernel, sample_kernel

_BOUNCES_EXPECTED = 4
# Reflectance against the cosine is tabulated this finely and interpolated linearly: error below 1e-5 for metals and
# glass.
NODES = 2049


@dataclass(frozen=True)
class Beams:
    """Where the rays of some columns start: each column (one bin of phi_i) has ``lines_each`` directions of incidence.

    ``phi`` ``[columns * lines_each]`` [rad], ``half`` the half range of incidence that each line stands for (0: a
    single direction), ``low`` and ``high`` the sines of the column's edges, used by the samplers that draw
    incidences.
    """

    phi: np.ndarray
    half: np.ndarray
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

    def tabulate(self, reflectance: np.ndarray | None = None, product: Any = None) -> tuple[np.ndarray, np.ndarray]:
        """``(energy, lost)``: ``energy`` float32 ``[columns, 3 + layers, bins]`` is the share of a column's light
        that leaves into each bin of phi_o after 1, 2, 3 and more reflections off mirrors, then for each layer of
        ``reflectance`` ``[layers, nodes]`` (against the cosine in the plane, from 0 to 1, equally spaced). ``lost``
        ``[columns]`` is the share of paths cut off. ``product`` ``[lines, rays, layers]`` (a Warp array) replaces
        what ``reflectance`` would give each path.
        """
        layers = 0 if reflectance is None else len(reflectance)
        if product is not None:
            layers = product.shape[2]
        line_count, capacity = self.lines.phi_o.shape
        columns = line_count // self.beams.lines_each
        reflectors, deposit = energies.Reflectors(), energies.Deposit()
        table = np.ones((layers, 2)) if reflectance is None else reflectance
        reflectors.table = wp.array(np.ascontiguousarray(table, np.float32), dtype=float, device="cpu")
        reflectors.product = product if product is not None else _products(line_count, capacity, layers)
        deposit.half = wp.array(self.beams.half.astype(np.float32), dtype=float, device="cpu")
        deposit.energy = wp.zeros((columns, 3 + layers, self.bins), dtype=float, device="cpu")
        deposit.lost = wp.zeros(columns, dtype=float, device="cpu")
        deposit.lines_each = self.beams.lines_each
        fill = energies.deposit_strips if self.sampler == "beam" else energies.deposit_samples
        if reflectance is not None:
            launch_tiles(energies.reflect_along, line_count, [self.lines, self.cosines, reflectors], self.threads)
        launch_tiles(fill, columns, [self.lines, reflectors, deposit], self.threads)
        energy, lost = deposit.energy.numpy(), deposit.lost.numpy()
        if self.sampler != "beam":
            energy, lost = energy / np.float32(capacity), lost / np.float32(capacity)
        return energy, lost


def trace_paths(
    profile: Profile, beams: Beams, *, bins: int, rays: int, sampler: str, max_bounces: int, seed: int, threads: int
) -> Paths:
    """Send ``rays`` rays a line into ``profile`` and keep what they did. ``sampler``: "beam", "stratified" or "random".

    The pool of cosines holds a few bounces a ray; when paths are longer it is enlarged and the lines traced again.
    """
    target = outline(profile)
    lines = _lines(len(beams.phi), rays, sampler == "beam")
    lines.phi = wp.array(beams.phi.astype(np.float32), dtype=float, device="cpu")
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
        low: Any = wp.array(beams.low.astype(np.float32), dtype=float, device="cpu")
        high: Any = wp.array(beams.high.astype(np.float32), dtype=float, device="cpu")
        extra = [low, high, seed, int(sampler == "stratified")]
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


def _products(lines: int, capacity: int, layers: int) -> Any:
    shape = (lines, capacity, layers) if layers else (1, 1, 1)
    return wp.empty(shape, dtype=float, device="cpu")
