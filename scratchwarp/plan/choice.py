"""EffectPlan: which effects a scene calls for, why, and with what settings it is rendered."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any

from ..scene import Settings
from ..scene.checks import put


@dataclass(frozen=True)
class EffectChoice:
    """One effect on or off; ``reason`` names what calls for it, ``prims`` the paths; ``forced`` by the user; ``share``
    of the rendering time, about (see ``cost``)."""

    enabled: bool
    reason: str
    prims: tuple[str, ...] = ()
    forced: bool = False
    share: float = 0.0


@dataclass(frozen=True, eq=False)
class TablePlan:
    """One profile table to simulate.

    Attributes:
        profile: a ``profiles.Profile`` scaled to its aspect; fresnel: an ``optics`` reflector, None for a mirror.
        max_bounces: 1 where light cannot meet the profile twice.
        theta_model: how the table varies along the cone, the cheapest that is accurate enough; error: its largest
            error of an albedo.
        users: the layers that share it.
        source: traced, or facets for a table of the profile's facets and their masking alone.
        resolution, rays, sampler, incidence: of ``profiles.simulate``.
        parts: what to simulate and average instead of ``profile``, ((profile, share), ...), for scratches that differ.
    """

    key: tuple[Any, ...]
    profile: Any
    fresnel: Any
    max_bounces: int
    users: tuple[str, ...]
    resolution: int = 256
    rays: int = 128
    theta_model: str = "gamma"
    error: float = 0.0
    source: str = "traced"
    parts: tuple[tuple[Any, float], ...] = ()
    sampler: str = "beam"
    incidence: str = "cell"


@dataclass(frozen=True, eq=False)
class ResponsePlan:
    """One response over solid angle: a key of ``reflectance.responses.RESPONSES``, the values that its ``pack`` takes,
    the ``optics`` reflector of its facets (None: a mirror, or none needed), the layers or materials that use it, and
    about its albedo."""

    name: str
    values: Any
    fresnel: Any
    users: tuple[str, ...]
    albedo: tuple[float, float, float] = (1.0, 1.0, 1.0)


@dataclass(frozen=True)
class Variation:
    """How the scratches of a sublayer differ: ``blends`` runs of ``aspects`` tables from its first table on, the
    aspects at wall angles from ``low`` to ``high`` [rad]; ``explicit``: scratches have aspects of their own."""

    aspects: int
    blends: int
    low: float
    high: float
    aspect: float
    explicit: bool = False


@dataclass(frozen=True, eq=False)
class LayerPlan:
    """A sublayer to render, its first table or its response (neither: a diffuse scratch), whether the base's diffuse
    term shows through, and how its scratches differ (None: they are alike). ``f0``: reflectance at normal incidence
    that the table was made with, where a textured base has its own at each point. ``near``: laid out groove by groove
    where it is near, and left out there."""

    sublayer: Any
    table: int
    keeps_diffuse: bool
    weight: float
    diffuse: tuple[float, float, float] = (0.0, 0.0, 0.0)
    response: int = -1
    variation: Variation | None = None
    f0: tuple[float, float, float] | None = None
    near: bool = False

    @property
    def lambert(self) -> bool:
        """Whether the scratch is a Lambert surface: neither a table nor a response."""
        return self.table < 0 and self.response < 0


@dataclass(frozen=True, eq=False)
class EffectPlan:
    """What to simulate for a scene and how.

    Attributes:
        effects: name -> EffectChoice, in the order of ``explain``.
        settings: every value decided. size: (width, height) of the whole image in pixels.
        window: (x0, x1, y0, y1) of the pixels rendered, the maxima exclusive.
        layers: for each material of the scene its sublayers. tables: what to simulate. responses: the others.
        waves: for each material what of it diffracts (a ``waves.WavePlan``), or None.
        grooves: for each material what of it is laid out groove by groove (a ``grooves.GroovePlan``), or None.
        bases: for each material the response that stands in for its base, or -1.
        warnings: what cannot be honoured. seconds: how long planning took.
        aim: how an error asked for is met (a ``cost.aim.Aim``), None where none is.
    """

    effects: Mapping[str, EffectChoice]
    settings: Settings
    size: tuple[int, int]
    window: tuple[int, int, int, int]
    layers: tuple[tuple[LayerPlan, ...], ...] = ()
    tables: tuple[TablePlan, ...] = ()
    warnings: tuple[str, ...] = ()
    seconds: float = 0.0
    numbers: Mapping[str, str] = field(default_factory=dict)
    responses: tuple[ResponsePlan, ...] = ()
    waves: tuple[Any, ...] = ()
    bases: tuple[int, ...] = ()
    grooves: tuple[Any, ...] = ()
    aim: Any = None

    def __post_init__(self) -> None:
        put(self, effects=MappingProxyType(dict(self.effects)), numbers=MappingProxyType(dict(self.numbers)))

    def on(self, name: str) -> bool:
        """Whether an effect is enabled; KeyError for a name that is no effect."""
        return self.effects[name].enabled

    def explain(self) -> str:
        """The plan as a table: effect, on or off, about what share of the rendering time, why."""
        width = max(len(n) for n in self.effects)
        lines = [f"{'effect':<{width}}  state  share  why", f"{'-' * width}  -----  -----  ---"]
        for name, choice in self.effects.items():
            state = ("on" if choice.enabled else "off") + ("!" if choice.forced else "")
            prims = (
                f"  [{', '.join(choice.prims[:3])}{', ...' if len(choice.prims) > 3 else ''}]" if choice.prims else ""
            )
            share = f"{100 * choice.share:.0f} %" if choice.share >= 0.005 else ""
            lines.append(f"{name:<{width}}  {state:<5}  {share:>5}  {choice.reason}{prims}")
        if any(c.forced for c in self.effects.values()):
            lines.append("! forced by the user or the stage")
        lines += [f"{name}: {text}" for name, text in self.numbers.items()]
        lines += [f"warning: {w}" for w in self.warnings]
        return "\n".join(lines)
