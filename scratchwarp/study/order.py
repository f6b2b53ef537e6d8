"""In which order the settings of a study are rendered while a budget lasts.

A unit is settings that belong together: a knob's reference value, which the others are compared with, and one of them.
"""

from collections.abc import Mapping, Sequence

from ..plan.knobs import KNOBS
from ..scene.knob import Value
from .measurement import Setting

Unit = tuple[Setting, ...]


def levels(
    ladders: Mapping[str, Sequence[Value]], defaults: Mapping[str, Value], best: Mapping[str, Value]
) -> tuple[tuple[Unit, ...], ...]:
    """Three levels of units: each knob's cheapest value with its reference value; its middle value, and the dearest of
    one that is noise; the others.

    What needs nothing turned is left out. In each level, noise comes first, then knobs that leave tables as they are,
    then those of tables, then those that switch code, which must be compiled.
    """
    first, second, third = list[Unit](), list[Unit](), list[Unit]()
    for name, values in sorted(ladders.items(), key=lambda item: _late(item[0])):
        others = [value for value in values if value != defaults[name]]
        if not others:
            continue
        top = best.get(name)
        pair = [top] if top in others and not KNOBS[name].noise else []
        rest = [value for value in others if value not in pair]
        if not rest:
            first.append(({name: others[0]},))
            continue
        first.append(tuple({name: value} for value in [*pair, rest[0]]))
        rest = rest[1:]
        if rest:
            middle = rest[len(rest) // 2]
            chosen = (middle, rest[-1]) if KNOBS[name].noise and rest[-1] != middle else (middle,)
            second += [({name: value},) for value in chosen]
            third += [({name: value},) for value in rest if value not in chosen]
    return tuple(first), tuple(second), tuple(third)


def _late(name: str) -> int:
    """Noise first, then what needs no other tables, then tables, then code that must be compiled."""
    knob = KNOBS[name]
    if knob.switches or name == "scratches.model":
        return 4
    return 0 if knob.noise else 2 + (knob.limits is None) if knob.place[0] == "table" else 1
