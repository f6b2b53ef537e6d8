"""Single rays through a cross-section, for tests, pictures and people: where they leave and how they were reflected."""

from dataclasses import dataclass
from typing import Any

import numpy as np
import warp as wp

from scratchwarp.profiles.launch import default_threads, launch_tiles
from scratchwarp.profiles.outline import outline
from scratchwarp.profiles.path_device import Cosines
from scratchwarp.profiles.profile import Profile
from scratchwarp.profiles.trace_kernels import Lines, ray_kernel


@dataclass(frozen=True, eq=False)
class Rays:
    """Rays that left a profile; every array has the shape of the rays asked for.

    ``phi_o``: exit angle [rad]. ``bounces``: reflections, -1 where the path was cut off. ``rate_x``, ``rate_phi``:
    change of ``phi_o`` with the entry point (a unit is the profile's width) and with ``phi_i``. ``cosines`` ``[...,
    K]``: cosine of incidence at each reflection, negative where the light comes from the left of the facet's normal,
    NaN past the last one.
    """

    phi_o: np.ndarray
    bounces: np.ndarray
    rate_x: np.ndarray
    rate_phi: np.ndarray
    cosines: np.ndarray


def trace(profile: Profile, phi_i: Any, x: Any, *, max_bounces: int = 2000) -> Rays:
    """Follow rays that enter the base line at ``x`` (share of the width, in [0, 1]) from direction ``phi_i`` [rad];
    both broadcast.

    Runs the device code of ``simulate``, in float32. ValueError where ``x`` or ``phi_i`` is out of range.
    """
    phi, place = np.broadcast_arrays(np.asarray(phi_i, np.float64), np.asarray(x, np.float64))
    if not np.all(np.abs(phi) <= 0.5 * np.pi):
        raise ValueError(f"phi_i must lie in [-pi/2, pi/2] rad, got {phi[~(np.abs(phi) <= 0.5 * np.pi)].flat[0]}")
    if not np.all((place >= 0.0) & (place <= 1.0)):
        raise ValueError(f"x must lie in [0, 1], got {place[~((place >= 0.0) & (place <= 1.0))].flat[0]}")
    count = phi.size
    lines, cosines = Lines(), Cosines()
    lines.phi = wp.array(phi.ravel().astype(np.float32), dtype=float, device="cpu")
    lines.x = wp.array(place.reshape(-1, 1).astype(np.float32), dtype=float, device="cpu")
    for name in ("phi_o", "rate_x", "rate_phi"):
        setattr(lines, name, wp.empty((count, 1), dtype=float, device="cpu"))
    lines.bounces = wp.empty((count, 1), dtype=int, device="cpu")
    lines.max_bounces = max_bounces
    kernel, target, threads = ray_kernel(not profile.overhangs), outline(profile), default_threads()
    capacity = 8
    while True:
        cosines.value = wp.empty(max(count * capacity, 1), dtype=float, device="cpu")
        cosines.capacity = capacity
        launch_tiles(kernel, count, [target, lines, cosines], threads)
        bounces = lines.bounces.numpy()[:, 0]
        longest = int(bounces.max(initial=0))
        if longest <= capacity:
            break
        capacity = longest
    met = cosines.value.numpy()[: count * capacity].reshape(count, capacity)[:, :longest]
    met = np.where(np.arange(longest) < bounces[:, None], met, np.float32(np.nan))
    angle, rate_x, rate_phi = (
        getattr(lines, name).numpy().reshape(phi.shape) for name in ("phi_o", "rate_x", "rate_phi")
    )
    return Rays(angle, bounces.reshape(phi.shape), rate_x, rate_phi, met.reshape(*phi.shape, longest))
