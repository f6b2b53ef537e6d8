"""Knob: an approximation that can be turned, and what it costs to turn it down."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any

from .checks import put

Value = int | str
QUALITIES = ("draft", "preview", "final", "reference")


@dataclass(frozen=True, kw_only=True)
class Knob:
    """One approximation as data: the command line, the planner and ``study`` know nothing else of it.

    Attributes:
        name: as in ``Settings.knobs``; ``values``: from the cheapest to the reference; ``default``: one of them.
        error: what goes wrong at cheap values, a phrase; ``source``: where the method is described.
        effects: it acts only where one of these is on; none: everywhere.
        sets: what a value goes to: ``settings.FIELD``, ``table.FIELD`` of every ``TablePlan``, ``wave.FIELD`` of what
            diffracts, ``camera.FIELD``, ``groove.FIELD`` and ``glint.FIELD`` of what is built for them; "" for
            ``switches``: value -> effects that it forces on or off.
        limits: least and greatest value of a number; other numbers than ``values`` may be asked for between them.
        quality: values for draft, preview, final and reference; none: the default for all of them.
        noise: the error is noise, which falls with samples; otherwise samples do not cure it.
        alternatives: values that have no place in the order from cheap to reference: how close they come to it, next to
            the others, depends on the scene.

    The value "auto" leaves things as the stage or the plan has them.
    """

    name: str
    values: tuple[Value, ...]
    default: Value
    error: str
    sets: str = ""
    effects: tuple[str, ...] = ()
    switches: Mapping[str, Mapping[str, bool]] = field(default_factory=dict)
    limits: tuple[int, int] | None = None
    quality: tuple[Value, ...] = ()
    noise: bool = False
    alternatives: tuple[Value, ...] = ()
    source: str = ""

    def __post_init__(self) -> None:
        if self.default not in self.values:
            raise ValueError(f"Knob {self.name}: default {self.default!r} is none of {self.values}")
        if self.quality and (len(self.quality) != len(QUALITIES) or not set(self.quality) <= set(self.values)):
            raise ValueError(f"Knob {self.name}: quality {self.quality} is not a value for each of {QUALITIES}")
        if not set(self.alternatives) <= set(self.values[:-1]):
            raise ValueError(f"Knob {self.name}: alternatives {self.alternatives} is not some of {self.values[:-1]}")
        if bool(self.sets) == bool(self.switches):
            raise ValueError(f"Knob {self.name}: it either sets something or switches effects")
        put(self, switches=MappingProxyType({k: MappingProxyType(dict(v)) for k, v in self.switches.items()}))

    @property
    def reference(self) -> Value:
        """The value that is closest to the truth."""
        return self.values[-1]

    @property
    def place(self) -> tuple[str, str]:
        """(settings, table, wave, camera, groove, glint or effects; the field)."""
        where, _, what = self.sets.partition(".")
        return (where, what) if self.sets else ("effects", "")

    def checked(self, value: Any) -> Value:
        """A value, or its text, as one that this knob has; ValueError naming those it has."""
        for known in self.values:
            if value == known or (isinstance(value, str) and value == str(known)):
                return known
        if self.limits is not None and not isinstance(value, bool):
            try:
                number = int(value)
            except (TypeError, ValueError):
                number = self.limits[0] - 1
            if number == value or str(number) == value:
                if self.limits[0] <= number <= self.limits[1]:
                    return number
        known_values = ", ".join(map(str, self.values))
        between = f", or whole numbers from {self.limits[0]} to {self.limits[1]}" if self.limits else ""
        raise ValueError(f"knob {self.name} is {value!r}; it has {known_values}{between}")
