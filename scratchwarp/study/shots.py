"""Shots: one scene rendered at many settings, with what their renders share kept from one to the next.

Tables that are simulated and data that is built for the defaults serve every setting that does not change them. Their
seconds are noted when they are made and count for each setting all the same, as if it were rendered alone.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np

from ..kernels import KernelKey, Parts, kernel_key
from ..plan import EffectPlan, make_plan
from ..profiles import Table
from ..render.interrupt import Control
from ..render.progress import Progress, silent
from ..render.renderer import render
from ..render.tables import identity, simulate_table
from ..scene import Scene, Settings
from ..scene.knob import Value
from .measurement import PARTS, setting_name


@dataclass
class Stock:
    """What one render leaves for others: tables by identity, device data by part and its kernel's key.

    ``simulated``: seconds of all its tables; ``built``: seconds of each part.
    """

    tables: dict[tuple[Any, ...], Table] = field(default_factory=dict)
    parts: Parts = field(default_factory=Parts)
    key: KernelKey | None = None
    simulated: float = 0.0
    built: dict[str, float] = field(default_factory=dict)


@dataclass(frozen=True, eq=False)
class Shot:
    """One render: color [h, w, 3]; ``seconds``: of ``PARTS`` and "compile", as if nothing had been there before;
    ``spent``: seconds that it really took, of "simulate", "build", "compile" and "trace"; ``tables``: its tables."""

    image: np.ndarray
    seconds: Mapping[str, float]
    spent: Mapping[str, float]
    tables: tuple[Table, ...]
    stock: Stock


class Shots:
    """Renders of one scene. ``base``: settings of all of them."""

    def __init__(self, scene: Scene, base: Settings) -> None:
        self.scene, self.base = scene, base
        self.plan = make_plan(scene, base)
        self.stock = Stock()  # of the defaults
        self._plans: dict[str, EffectPlan | str] = {}

    def planned(self, knobs: Mapping[str, Value]) -> EffectPlan | None:
        """The plan of a setting, made once; None where there can be none."""
        name = setting_name(knobs)
        if name not in self._plans:
            try:
                self._plans[name] = make_plan(self.scene, replace(self.base, knobs={**self.base.knobs, **knobs}))
            except ValueError as error:
                self._plans[name] = str(error)
        found = self._plans[name]
        return None if isinstance(found, str) else found

    def known(self, knobs: Mapping[str, Value]) -> bool:
        """Whether a setting was planned already."""
        return setting_name(knobs) in self._plans

    def missing(self, plan: EffectPlan) -> tuple[float, bool]:
        """(share of a plan's tables that are not in stock, whether it has another kernel than what is in stock)."""
        own = [identity(table) for table in plan.tables]
        there = sum(name in self.stock.tables for name in own)
        return (1.0 - there / len(own) if own else 0.0), kernel_key(self.scene, plan) != self.stock.key

    def warm(self) -> None:
        """Simulate a tiny table, so that no other pays for loading what simulates tables."""
        for table in self.plan.tables[:1]:
            simulate_table(replace(table, resolution=16, rays=8, parts=()), 1)

    def take(
        self,
        knobs: Mapping[str, Value],
        seed: int,
        progress: Progress = silent,
        stock: Stock | None = None,
        control: Control | None = None,
    ) -> Shot:
        """Render a setting. ``stock``: what may be used, that of the defaults unless given. The defaults leave theirs.

        Raises ValueError where the setting cannot be planned, ``Stopped`` where ``control`` ends it.
        """
        stock = self.stock if stock is None else stock
        plan = self.planned(knobs)
        if plan is None:
            raise ValueError(f"{setting_name(knobs)}: {self._plans[setting_name(knobs)]}")
        settings = replace(plan.settings, seed=seed, max_error=None)  # samples are given
        own = [identity(table) for table in plan.tables]
        tables = {name: stock.tables[name] for name in own if name in stock.tables}
        there = len(tables)
        parts = stock.parts.copy(() if own == list(stock.tables) else ("tables",))  # which are written over in place
        given = replace(plan, aim=None, settings=settings)
        film = render(self.scene, given, progress, tables=tables, parts=parts, control=control)
        stats = film.stats
        fresh = dict(parts.seconds)
        built = {name: seconds for name, seconds in stock.built.items() if name not in fresh} | fresh
        shared = stock.simulated * there / max(len(stock.tables), 1)
        spent = {
            "simulate": float(stats["simulate"]),
            "build": sum(fresh.values()),
            "compile": max(float(stats["compile"]) - sum(fresh.values()), 0.0),
            "trace": float(stats["trace"]),
        }
        seconds = {"plan": plan.seconds, **spent, "build": sum(built.values())}
        seconds["simulate"] += shared
        assert set(seconds) == {*PARTS, "compile"}
        parts.seconds.clear()
        made = Stock(tables, parts, kernel_key(self.scene, plan), seconds["simulate"], built)
        if not knobs:
            self.stock = made
        return Shot(film["color"], seconds, spent, tuple(tables[name] for name in own), made)
