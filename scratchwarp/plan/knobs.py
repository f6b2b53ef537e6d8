"""Every knob, and what turning them does to settings and tables. A room's own knobs are in its module ``knobs``."""

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from ..lights.knobs import KNOBS as LIGHTS
from ..profiles.knobs import KNOBS as PROFILES
from ..reflectance.diffraction.knobs import KNOBS as DIFFRACTION
from ..reflectance.grooves.knobs import KNOBS as GROOVES
from ..scene import Wave
from ..scene.knob import QUALITIES, Knob, Value
from ..scratches.knobs import KNOBS as SCRATCHES
from .choice import EffectPlan, TablePlan

_OWN = (
    Knob(
        name="spp",
        values=(1, 2, 4, 8, 16, 32, 64, 128, 256, 512, 1024),
        default=16,
        error="noise",
        sets="settings.spp",
        limits=(1, 1 << 20),
        quality=(4, 16, 128, 1024),
        noise=True,
    ),
    Knob(
        name="pathDepth",
        values=(1, 2, 4, 8, 16),
        default=8,
        error="light lost that arrives over more surfaces",
        sets="settings.max_depth",
        effects=("indirect",),
        limits=(1, 1024),
        quality=(2, 8, 8, 16),
    ),
    Knob(
        name="scratches.model",
        values=("ashikhminShirley", "tabulatedNdf", "mirror", "singleBounce", "table", "fullTable"),
        default="table",
        error="scratches of another reflectance",
        sets="settings.model",
        effects=("scratches.table",),
        alternatives=("mirror",),  # far too bright on dielectrics; on metals it depends
        source="Raymond, Guennebaud, Barla 2016, Figure 7",
    ),
    Knob(
        name="scratches.overlap",
        values=("sum", "product"),
        default="product",
        error="scratches that cross cover too much",
        effects=("scratches",),
        switches={"sum": {"scratches.sumCoverage": True}, "product": {}},
        source="Raymond, Guennebaud, Barla 2016, Equation 4",
    ),
    Knob(
        name="scratches.farField",
        values=("stencil", "scratches"),
        default="scratches",
        error="no single scratch is seen",
        effects=("scratches.table",),
        switches={"stencil": {"scratches.stencil": True}, "scratches": {}},
        source="highlight stencils fitted to the material's mean BRDF",
    ),
)

_ALL = (*_OWN, *PROFILES, *SCRATCHES, *LIGHTS, *DIFFRACTION, *GROOVES)
KNOBS: dict[str, Knob] = {knob.name: knob for knob in _ALL}
"""Name -> knob."""


def checked(knobs: Mapping[str, Any]) -> dict[str, Value]:
    """Values that their knobs have; ValueError naming the knobs where one is unknown."""
    for name in knobs:
        if name not in KNOBS:
            raise ValueError(f"knobs names {name!r}; the knobs are {', '.join(KNOBS)}")
    return {name: KNOBS[name].checked(value) for name, value in knobs.items()}


def by_quality(quality: str | None) -> dict[str, Value]:
    """What a quality turns all at once; nothing for None."""
    if quality is None:
        return {}
    place = QUALITIES.index(quality)
    return {name: knob.quality[place] for name, knob in KNOBS.items() if knob.quality}


def turned(knobs: Mapping[str, Value], where: str) -> dict[str, Any]:
    """Field -> value of the knobs that set fields of ``where``: settings, table and so on. "auto" sets nothing."""
    return {KNOBS[n].place[1]: v for n, v in knobs.items() if KNOBS[n].place[0] == where and v != "auto"}


def value(knobs: Mapping[str, Value], name: str) -> Value:
    """What a knob is at where only some are turned."""
    return knobs.get(name, KNOBS[name].default)


def switched(knobs: Mapping[str, Value]) -> dict[str, bool]:
    """Effects that knobs force on or off."""
    return {effect: on for n, v in knobs.items() for effect, on in KNOBS[n].switches.get(str(v), {}).items()}


def turned_tables(tables: tuple[TablePlan, ...], knobs: Mapping[str, Value], summed: bool) -> tuple[TablePlan, ...]:
    """Tables as the knobs ask for them; ``summed``: their slices must have sums along a cone.

    ValueError on a theta model that has none.
    """
    fields = turned(knobs, "table")
    bounces, theta = fields.pop("max_bounces", 2000), fields.pop("theta_model", "auto")
    if theta == "gamma" and summed and any(t.fresnel is not None for t in tables):
        raise ValueError(
            "knob tables.theta is gamma, which has no sums along cones; turn lights.cones to lights, cones or both, too"
        )
    made = []
    for table in tables:
        own = {**fields, "max_bounces": min(table.max_bounces, bounces)}
        if theta != "auto" and table.fresnel is not None:
            own |= {"theta_model": theta, "error": 0.0 if theta != table.theta_model else table.error}
        if table.source == "facets":
            own = {"resolution": own["resolution"]} if "resolution" in own else {}
        made.append(replace(table, **own))
    return tuple(made)


def turned_wave(wave: Wave, knobs: Mapping[str, Value]) -> Wave:
    """ScratchWaveAPI as the knobs ask for it."""
    fields = turned(knobs, "wave")
    return replace(wave, **fields) if fields else wave


def acting(plan: EffectPlan) -> dict[str, Knob]:
    """The knobs that act on what a plan renders."""
    found = {n: k for n, k in KNOBS.items() if not k.effects or any(plan.on(effect) for effect in k.effects)}
    if sum(len(own) for own in plan.layers) < 2:
        found.pop("scratches.overlap", None)
    return found
