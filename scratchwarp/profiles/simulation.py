"""``simulate`` and ``simulate_full``: from a profile to its table in one call."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from scratchwarp.profiles.cache import TableStore, table_key
from scratchwarp.profiles.launch import threads_of
from scratchwarp.profiles.profile import Profile
from scratchwarp.profiles.reflectors import reflecting
from scratchwarp.profiles.table import Table
from scratchwarp.profiles.theta import nodes
from scratchwarp.profiles.tracing import blocks, checked, cosines_of, slices_of, table_of


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
    polarised: bool = False,
    threads: int | None = None,
    store: TableStore | None = None,
) -> Table:
    """The table of a cross-section (Raymond 2016, sections 4.1 and 4.2, in the normalisation of ``Table``).

    ``resolution``: bins M each way. ``rays``: rays for each phi_i bin, at least 4; beams start with half of them and
    spend up to the other half where neighbours disagree. ``fresnel``: a reflector of ``optics``, or None for a mirror
    alone. ``incidence``: "cell" spreads phi_i over its bin by its cosine (a reciprocal table), "centre" takes the
    bin's centre as the paper prints it. ``sampler``: "beam" spreads the light between neighbouring rays over the exit
    angles between them; "stratified" and "random" count rays. ``max_bounces``: paths that are longer count as
    ``lost``. ``seed``: of the random samplers. ``theta_model``: "gamma", "quadratic", "table" or "exact" (see
    ``theta``).
    ``polarised``: products of Jones matrices along each path in place of unpolarised reflectances, for the exact
    model of a conductor or dielectric. ``threads``: None takes all processors; the bits are the same. ``store``: a
    cache to look in first (``profiles.store()``).

    Reciprocity and mirror symmetry are used where the profile has them. Error against time: docs/profiles.md. Raises
    ValueError naming the argument that is out of range.
    """
    arguments = {
        "resolution": resolution,
        "rays": rays,
        "incidence": incidence,
        "sampler": sampler,
        "max_bounces": max_bounces,
        "seed": seed,
    }
    request = checked(profile, arguments)
    reflector = reflecting(fresnel)
    count = len(nodes(theta_model)) * (1 if reflector is None else int(reflector.channels))
    workers = threads_of(threads)

    def run() -> Table:
        return table_of(
            profile, request, blocks(profile, request, workers, count), fresnel, theta_model, polarised, workers
        )

    if store is None:
        return run()
    return store.table(table_key(profile, fresnel, theta_model=theta_model, polarised=polarised, **arguments), run)


def simulate_full(
    profile: Profile,
    thetas: Sequence[float] | np.ndarray,
    *,
    fresnel: Any = None,
    polarised: bool = False,
    threads: int | None = None,
    theta_model: str = "exact",
    store: TableStore | None = None,
    **request: Any,
) -> np.ndarray:
    """rho_s at each of ``thetas`` [rad], float32 ``[T, M, M]`` (``[T, M, M, 3]`` for a coloured reflector): one
    trace, the reflectance of every path evaluated at every theta, nothing approximated in theta.

    Takes ``simulate``'s other keywords and raises as it does. ``theta_model`` and ``store`` are checked and change
    nothing: nothing is approximated, and nothing kept.
    """
    nodes(theta_model)
    wanted = checked(profile, request)
    reflector = reflecting(fresnel)
    count = len(cosines_of(thetas)) * (1 if reflector is None else int(reflector.channels))
    workers = threads_of(threads)
    return slices_of(profile, wanted, blocks(profile, wanted, workers, count), thetas, fresnel, polarised, workers)
