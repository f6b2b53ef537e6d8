"""From a profile to its table: choose the rays, trace them, add up what they carry, use the symmetries that the
profile has."""

from collections.abc import Sequence
from functools import lru_cache
from typing import Any

import numpy as np

from scratchwarp.optics.fresnel import Mirror
from scratchwarp.profiles import theta as theta_models
from scratchwarp.profiles.balance import balanced, exponents
from scratchwarp.profiles.launch import default_threads
from scratchwarp.profiles.paths import NODES, Beams, Paths, trace_paths
from scratchwarp.profiles.profile import Profile
from scratchwarp.profiles.table import Table, bin_angles, bin_weights, cumulative

SAMPLERS = ("beam", "stratified", "random")
INCIDENCES = ("cell", "centre")
# Rays held at once; more are traced in blocks of columns.
_BLOCK = 4_000_000


def simulate(
    profile: Profile,
    *,
    resolution: int = 256,
    rays: int = 512,
    fresnel: Any = None,
    incidence: str = "cell",
    sampler: str = "beam",
    max_bounces: int = 2000,
    seed: int = 0,
    theta_model: str = "gamma",
    threads: int | None = None,
) -> Table:
    """The table of a cross-section (Raymond 2016, sections 4.1 and 4.2, in the normalisation of ``Table``).

    ``rays``: rays for each phi_i bin, at least 4. ``fresnel``: a reflector of ``optics.fresnel``, or None for a
    mirror alone. ``incidence``: "cell" spreads phi_i over its bin by its cosine (a reciprocal table), "centre" takes
    the bin's centre as the paper prints. ``sampler``: "beam" spreads the light between neighbouring rays, error about
    1 / rays and smaller; "stratified" and "random" count rays. ``theta_model``: "gamma", "quadratic" or "exact" (see
    ``theta``). ``threads``: None takes all processors; the result is the same. Reciprocity and mirror symmetry are
    used where the profile has them. Raises ValueError naming the argument that is out of range.
    """
    _check(profile, resolution, rays, incidence, sampler, max_bounces, seed)
    reflector = None if fresnel is None or isinstance(fresnel, Mirror) else fresnel
    channels = 1 if reflector is None else int(reflector.channels)
    mu = theta_models.nodes(theta_model)
    reflectance = None if reflector is None else reflectance_rows(reflector, tuple(float(m) for m in mu))
    threads = threads or default_threads()
    layers, lost, traced = _layers(
        profile, reflectance, resolution, rays, incidence, sampler, max_bounces, seed, threads
    )
    angles, weights = bin_angles(resolution), bin_weights(resolution)
    by_bounce = layers[:3]
    mirror = by_bounce.sum(axis=0)
    normal = gamma = slices = None
    flagged = 0.0
    if fresnel is not None and reflector is None:
        slices = np.broadcast_to(mirror, (len(mu), *mirror.shape))
        normal, gamma = mirror, np.ones_like(mirror)
    elif reflector is not None:
        stack = layers[3:].reshape(len(mu), channels, resolution, resolution)
        exponent, flagged = exponents(mirror, stack[0], stack[int(np.argmin(np.abs(mu - 0.5)))], threads)
        slices = _channels_last(stack, 1)
        normal, gamma = slices[0], _channels_last(exponent, 0)
    metadata = {
        "sampler": sampler,
        "incidence": incidence,
        "rays": rays,
        "gamma_flagged": flagged,
        "theta_model": theta_model,
    }
    return Table(
        mirror=mirror,
        by_bounce=by_bounce,
        normal=normal,
        gamma=gamma,
        angles=angles,
        weights=weights,
        lost=lost,
        cdf=cumulative(mirror, weights),
        slices=slices,
        slice_cosines=None if slices is None else mu,
        theta_model=theta_model,
        gamma_flagged=flagged,
        rays=traced,
        metadata=metadata,
    )


def simulate_full(
    profile: Profile,
    thetas: Sequence[float] | np.ndarray,
    *,
    resolution: int = 256,
    rays: int = 512,
    fresnel: Any = None,
    incidence: str = "cell",
    sampler: str = "beam",
    max_bounces: int = 2000,
    seed: int = 0,
    threads: int | None = None,
) -> np.ndarray:
    """rho_s at each of ``thetas`` [rad], float32 ``[T, M, M]`` (``[T, M, M, 3]`` for a coloured reflector): one
    trace, the reflectance of every path evaluated at every theta, nothing approximated in theta. Other arguments and
    errors as ``simulate``."""
    _check(profile, resolution, rays, incidence, sampler, max_bounces, seed)
    angles = np.atleast_1d(np.asarray(thetas, np.float64))
    if angles.ndim != 1 or not np.all(np.abs(angles) <= np.pi / 2 + 1e-9):
        raise ValueError(f"thetas must be angles in [-pi/2, pi/2], got {thetas}")
    reflector = None if isinstance(fresnel, Mirror) else fresnel
    channels = 1 if reflector is None else int(reflector.channels)
    mu = tuple(float(m) for m in np.maximum(np.cos(angles), 0.0))
    reflectance = None if reflector is None else reflectance_rows(reflector, mu)
    layers, _, _ = _layers(
        profile, reflectance, resolution, rays, incidence, sampler, max_bounces, seed, threads or default_threads()
    )
    if reflectance is None:
        return np.repeat(layers[:3].sum(axis=0)[None], len(angles), axis=0)
    slices = layers[3:].reshape(len(angles), channels, resolution, resolution)
    return _channels_last(slices, 1)


def _channels_last(stack: np.ndarray, axis: int) -> np.ndarray:
    """A single channel dropped, several moved to the end."""
    return stack.take(0, axis) if stack.shape[axis] == 1 else np.ascontiguousarray(np.moveaxis(stack, axis, -1))


def _check(profile: Any, resolution: int, rays: int, incidence: str, sampler: str, max_bounces: int, seed: int) -> None:
    if not isinstance(profile, Profile):
        raise ValueError(
            f"profile must be a profiles.Profile, got {type(profile).__name__}; build one from points first"
        )
    for name, value, least in (
        ("resolution", resolution, 2),
        ("rays", rays, 4),
        ("max_bounces", max_bounces, 1),
        ("seed", seed, 0),
    ):
        if isinstance(value, bool) or int(value) != value or value < least:
            raise ValueError(f"{name} must be a whole number of at least {least}, got {value}")
    if incidence not in INCIDENCES:
        raise ValueError(f"incidence must be one of {INCIDENCES}, got {incidence!r}")
    if sampler not in SAMPLERS:
        raise ValueError(f"sampler must be one of {SAMPLERS}, got {sampler!r}")


@lru_cache(maxsize=64)
def reflectance_rows(reflector: Any, mu: tuple[float, ...]) -> np.ndarray:
    """Reflectance against the cosine in the plane, at each cos(theta) of ``mu``: float32 ``[len(mu) * channels,
    NODES]``."""
    cosine = np.linspace(0.0, 1.0, NODES)
    rows = [np.moveaxis(reflector.reflectance(cosine * m), -1, 0) for m in mu]
    return np.concatenate(rows).astype(np.float32)


def columns_of(columns: np.ndarray, resolution: int, incidence: str, lines_each: int) -> Beams:
    """Directions of incidence for some bins of phi_i: equal shares of each bin's cosine weight, or its centre."""
    width = np.pi / resolution
    left = columns * width - 0.5 * np.pi
    low, high = np.sin(left), np.sin(left + width)
    if incidence == "centre":
        return Beams(left + 0.5 * width, np.zeros(len(columns)), low, low, 1)
    share = np.arange(lines_each + 1) / lines_each
    edges = np.arcsin(np.clip(low[:, None] + (high - low)[:, None] * share, -1.0, 1.0))
    middle = 0.5 * (edges[:, 1:] + edges[:, :-1])
    half = 0.5 * (edges[:, 1:] - edges[:, :-1])
    return Beams(middle.ravel(), half.ravel(), low, high, lines_each)


def lines_for(rays: int, resolution: int) -> int:
    """Directions of incidence a beam-traced column is given: few for narrow bins, more where there are rays to
    spend."""
    return max(1, min(round((2.0 * rays / resolution) ** 0.5), rays // 16))


def _layers(
    profile: Profile,
    reflectance: np.ndarray | None,
    resolution: int,
    rays: int,
    incidence: str,
    sampler: str,
    max_bounces: int,
    seed: int,
    threads: int,
) -> tuple[np.ndarray, np.ndarray, int]:
    """Tables ``[3 + layers, phi_o, phi_i]`` float32 [1/rad], ``lost`` ``[phi_i]``, and rays traced."""
    half = profile.symmetric
    count = (resolution + 1) // 2 if half else resolution
    lines_each = lines_for(rays, resolution) if sampler == "beam" and incidence == "cell" else 1
    per_line = max(4, rays // lines_each)
    step = max(1, _BLOCK // (rays * max(1, 0 if reflectance is None else len(reflectance))))
    parts: list[tuple[np.ndarray, np.ndarray]] = []
    traced = 0
    for start in range(0, count, step):
        columns = np.arange(start, min(start + step, count))
        beams = columns_of(columns, resolution, incidence, lines_each)
        paths: Paths = trace_paths(
            profile,
            beams,
            bins=resolution,
            rays=per_line,
            sampler=sampler,
            max_bounces=max_bounces,
            seed=seed + start,
            threads=threads,
        )
        parts.append(paths.tabulate(reflectance))
        traced += paths.rays
    energy = np.concatenate([part[0] for part in parts]) if len(parts) > 1 else parts[0][0]
    lost = np.concatenate([part[1] for part in parts]) if len(parts) > 1 else parts[0][1]
    if half:
        lost = np.concatenate((lost, lost[::-1][resolution % 2 :]))
    reciprocal = profile.reciprocal and incidence == "cell"
    return balanced(energy, bin_weights(resolution), lost, reciprocal, threads), lost, traced
