"""Which rays a table needs, and the tables that their paths make: columns of phi_i, symmetries, blocks that fit in
memory."""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from scratchwarp.profiles import theta as theta_models
from scratchwarp.profiles.balance import balanced, exponents
from scratchwarp.profiles.launch import threads_of
from scratchwarp.profiles.paths import Beams, Paths, trace_lines
from scratchwarp.profiles.profile import Profile
from scratchwarp.profiles.reflectors import Rows, reflecting, rows
from scratchwarp.profiles.table import Table, assembled, bin_weights

SAMPLERS = ("beam", "stratified", "random")
INCIDENCES = ("cell", "centre")
# Path records held at once by ``simulate``; more are traced and added up in blocks of columns.
_BLOCK = 8_000_000


@dataclass(frozen=True)
class Request:
    """What to trace: the arguments that ``simulate``, ``simulate_full`` and ``trace_paths`` share, checked."""

    resolution: int = 256
    rays: int = 512
    incidence: str = "cell"
    sampler: str = "beam"
    max_bounces: int = 2000
    seed: int = 0

    def __post_init__(self) -> None:
        least = {"resolution": 2, "rays": 4, "max_bounces": 1, "seed": 0}
        for name, low in least.items():
            value = getattr(self, name)
            number = isinstance(value, int | float | np.number) and not isinstance(value, bool)
            if not number or not np.isfinite(value) or int(value) != value or not low <= value < 2**31:
                raise ValueError(f"{name} must be a whole number of at least {low}, got {value!r}")
            object.__setattr__(self, name, int(value))
        if self.incidence not in INCIDENCES:
            raise ValueError(f"incidence must be one of {INCIDENCES}, got {self.incidence!r}")
        if self.sampler not in SAMPLERS:
            raise ValueError(f"sampler must be one of {SAMPLERS}, got {self.sampler!r}")

    @property
    def lines(self) -> int:
        """Directions of incidence traced for each bin of phi_i. Beams take more where bins are wide or rays many: the
        error of too few falls with their square, that of too few rays on each with the rays
        (tests/benchmarks/profiles.py)."""
        if self.sampler != "beam" or self.incidence != "cell":
            return 1
        return max(1, min(round((2.0 * self.rays / self.resolution) ** 0.5), self.rays // 16))


@dataclass(frozen=True)
class Traced:
    """What the rays through a profile did: makes any number of tables without tracing again."""

    profile: Profile
    request: Request
    blocks: tuple[Paths, ...]
    threads: int

    def table(self, fresnel: Any = None, *, theta_model: str = "gamma", polarised: bool = False) -> Table:
        """The table for a reflector, as ``simulate`` gives it."""
        return table_of(self.profile, self.request, self.blocks, fresnel, theta_model, polarised, self.threads)

    def slices(self, thetas: Any, fresnel: Any = None, *, polarised: bool = False) -> np.ndarray:
        """rho_s at each theta, as ``simulate_full`` gives it."""
        return slices_of(self.profile, self.request, self.blocks, thetas, fresnel, polarised, self.threads)


def trace_paths(profile: Profile, *, threads: int | None = None, **request: Any) -> Traced:
    """Trace once, tabulate often: for editing colours, metals or theta models of one profile. Takes ``simulate``'s
    resolution, rays, incidence, sampler, max_bounces, seed and threads; keeps about 40 bytes a ray. Raises ValueError
    as it does."""
    wanted = checked(profile, request)
    workers = threads_of(threads)
    return Traced(profile, wanted, tuple(blocks(profile, wanted, workers, 1)), workers)


def checked(profile: Any, request: dict[str, Any]) -> Request:
    """The request, after a look at the profile; ValueError where either is not what it must be."""
    if not isinstance(profile, Profile):
        raise ValueError(
            f"profile must be a profiles.Profile, got {type(profile).__name__}; build one from points first"
        )
    return Request(**request)


def blocks(profile: Profile, request: Request, threads: int, layers: int) -> Iterator[Paths]:
    """Trace the columns that the profile's symmetry leaves to do, in blocks that fit in memory with ``layers``
    products a path."""
    count = (request.resolution + 1) // 2 if profile.symmetric else request.resolution
    step = max(1, _BLOCK // (request.rays * max(1, layers)))
    each = request.lines
    for start in range(0, count, step):
        columns = np.arange(start, min(start + step, count))
        yield trace_lines(
            profile,
            columns_of(columns, request.resolution, request.incidence, each),
            bins=request.resolution,
            rays=max(4, request.rays // each),
            sampler=request.sampler,
            max_bounces=request.max_bounces,
            seed=request.seed,
            first=start,
            threads=threads,
        )


def columns_of(columns: np.ndarray, resolution: int, incidence: str, lines_each: int) -> Beams:
    """Directions of incidence for some bins of phi_i: equal shares of each bin's cosine weight, or its centre."""
    width = np.pi / resolution
    left = columns * width - 0.5 * np.pi
    low, high = np.sin(left), np.sin(left + width)
    if incidence == "centre":
        return Beams(left + 0.5 * width, np.zeros(len(columns)), np.zeros(len(columns)), low, low, 1)
    share = np.arange(lines_each + 1) / lines_each
    edges = np.arcsin(np.clip(low[:, None] + (high - low)[:, None] * share, -1.0, 1.0))
    left, right = edges[:, :-1].ravel(), edges[:, 1:].ravel()
    # the cosine-weighted mean, so that the outermost bins are not met at too grazing an angle
    mean = (right * np.sin(right) + np.cos(right) - left * np.sin(left) - np.cos(left)) / (np.sin(right) - np.sin(left))
    return Beams(mean, 0.5 * (right - left), 0.5 * (right + left) - mean, low, high, lines_each)


def layers_of(
    profile: Profile, request: Request, paths: Iterable[Paths], wanted: Rows | None, threads: int
) -> tuple[np.ndarray, np.ndarray, int]:
    """Tables ``[3 + layers, phi_o, phi_i]`` float32 [1/rad], ``lost`` ``[phi_i]``, and the rays traced."""
    parts, traced = [], 0
    for block in paths:
        parts.append(block.tabulate(wanted))
        traced += block.rays
    energy = parts[0][0] if len(parts) == 1 else np.concatenate([part[0] for part in parts])
    lost = parts[0][1] if len(parts) == 1 else np.concatenate([part[1] for part in parts])
    if profile.symmetric:
        lost = np.concatenate((lost, lost[::-1][request.resolution % 2 :]))
    reciprocal = profile.reciprocal and request.incidence == "cell"
    return balanced(energy, bin_weights(request.resolution), lost, reciprocal, threads), lost, traced


def table_of(
    profile: Profile,
    request: Request,
    paths: Iterable[Paths],
    fresnel: Any,
    theta_model: str,
    polarised: bool,
    threads: int,
) -> Table:
    """The table that some blocks of paths make for a reflector."""
    mu = theta_models.nodes(theta_model)
    reflector = reflecting(fresnel)
    wanted = None if reflector is None else rows(reflector, tuple(float(m) for m in mu), polarised)
    layers, lost, traced = layers_of(profile, request, paths, wanted, threads)
    by_bounce = layers[:3]
    slices = gamma = None
    flagged = 0.0
    if wanted is not None:
        stack = layers[3:].reshape(len(mu), wanted.channels, request.resolution, request.resolution)
        sixty = stack[int(np.argmin(np.abs(mu - 0.5)))]
        exponent, flagged = exponents(by_bounce.sum(axis=0), stack[0], sixty, threads)
        slices, gamma = _channels_last(stack, 1), _channels_last(exponent, 0)
    elif fresnel is not None:
        slices = np.repeat(by_bounce.sum(axis=0)[None], len(mu), axis=0)
        gamma = np.ones_like(slices[0])
    metadata = {
        "sampler": request.sampler,
        "incidence": request.incidence,
        "rays": request.rays,
        "theta_model": theta_model,
        "gamma_flagged": flagged,
    }
    return assembled(
        by_bounce,
        lost,
        slices=slices,
        gamma=gamma,
        slice_cosines=None if slices is None else mu,
        theta_model=theta_model,
        gamma_flagged=flagged,
        rays=traced,
        metadata=metadata,
    )


def slices_of(
    profile: Profile,
    request: Request,
    paths: Iterable[Paths],
    thetas: Any,
    fresnel: Any,
    polarised: bool,
    threads: int,
) -> np.ndarray:
    """rho_s at each theta, ``[T, M, M]`` or ``[T, M, M, 3]``."""
    mu = cosines_of(thetas)
    reflector = reflecting(fresnel)
    if reflector is None:
        mirror = layers_of(profile, request, paths, None, threads)[0].sum(axis=0)
        return np.repeat(mirror[None], len(mu), axis=0)
    wanted = rows(reflector, mu, polarised)
    layers = layers_of(profile, request, paths, wanted, threads)[0]
    stack = layers[3:].reshape(len(mu), wanted.channels, request.resolution, request.resolution)
    return _channels_last(stack, 1)


def cosines_of(thetas: Any) -> tuple[float, ...]:
    """cos(theta) of a list of angles; ValueError unless it is one-dimensional and within [-pi/2, pi/2]."""
    try:
        angles = np.atleast_1d(np.asarray(thetas, np.float64))
    except (TypeError, ValueError):
        raise ValueError(f"thetas must be one or more angles in [-pi/2, pi/2], got {thetas!r}") from None
    if angles.ndim != 1 or angles.size == 0 or not np.all(np.abs(angles) <= 0.5 * np.pi + 1e-9):
        raise ValueError(f"thetas must be one or more angles in [-pi/2, pi/2], got {thetas}")
    return tuple(float(m) for m in np.maximum(np.cos(angles), 0.0))


def _channels_last(stack: np.ndarray, axis: int) -> np.ndarray:
    """A single channel dropped, several moved to the end."""
    return stack.take(0, axis) if stack.shape[axis] == 1 else np.ascontiguousarray(np.moveaxis(stack, axis, -1))
