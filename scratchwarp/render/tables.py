"""The plan's profile tables, simulated or found."""

from typing import Any

from .. import profiles
from ..plan import EffectPlan, TablePlan
from .baked import Baked, Oven
from .progress import Progress, silent


def _simulated(
    table: TablePlan, profile: profiles.Profile, threads: int, store: Baked | Oven | None = None
) -> profiles.Table:
    """The table of one cross-section, as ``table`` asks for it."""
    if table.source == "facets":
        return profiles.facet_table(profile, table.fresnel, table.resolution, table.theta_model)
    return profiles.simulate(
        profile,
        resolution=table.resolution,
        rays=table.rays,
        fresnel=table.fresnel,
        max_bounces=table.max_bounces,
        theta_model=table.theta_model,
        sampler=table.sampler,
        incidence=table.incidence,
        threads=threads,
        store=store,
    )


def simulate_table(
    table: TablePlan,
    threads: int,
    known: dict[tuple[Any, ...], profiles.Table] | None = None,
    store: Baked | Oven | None = None,
) -> profiles.Table:
    """One of the plan's profile tables; ``known``: the cross-sections simulated for the table before, which it may
    share, replaced by its own; ``store``: tables baked before, or an oven that keeps them."""
    if not table.parts:
        return _simulated(table, table.profile, threads, store)
    known = {} if known is None else known
    how = (table.max_bounces, table.resolution, table.rays, table.sampler, table.incidence)
    asked = (table.source, table.fresnel, table.theta_model, *how)
    made: dict[tuple[Any, ...], profiles.Table] = {}
    for profile, _ in table.parts:
        key = (profile.token, asked)
        made[key] = made.get(key) or known.get(key) or _simulated(table, profile, threads, store)
    known.clear()
    known.update(made)
    return profiles.mixture([made[p.token, asked] for p, _ in table.parts], [share for _, share in table.parts])


def identity(table: TablePlan) -> tuple[Any, ...]:
    """What decides a profile table."""
    mixed = tuple((profile.token, share) for profile, share in table.parts)
    traced = (table.resolution, table.rays, table.sampler, table.incidence, table.max_bounces)
    return (table.key, table.fresnel is None, *traced, table.theta_model, table.source, mixed)


def simulate_tables(
    plan: EffectPlan,
    threads: int,
    progress: Progress = silent,
    store: Baked | Oven | None = None,
    earlier: dict[tuple[Any, ...], profiles.Table] | None = None,
) -> tuple[list[profiles.Table], int]:
    """The plan's profile tables, in order, and how many of them had to be simulated; ``earlier``: those of the plan
    before, by identity, replaced by those of this one."""
    simulated = 0
    made: list[profiles.Table] = []
    known: dict[tuple[Any, ...], profiles.Table] = {}
    there = dict(earlier or {})
    for number, table in enumerate(plan.tables):
        progress(number, len(plan.tables), "simulate")
        name = identity(table)
        if name in there:
            made.append(there[name])
            continue
        made.append(simulate_table(table, threads, known, store))
        simulated += store is None or table.source == "facets" or not store.note(table.users)
    if earlier is not None:
        earlier.clear()
        earlier.update(zip(map(identity, plan.tables), made, strict=True))
    if plan.tables:
        progress(len(plan.tables), len(plan.tables), "simulate")
    return made, simulated
