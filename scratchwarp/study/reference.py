"""The reference of a study: what it is made with, and how it is made cheaper where a budget asks for it."""

from collections.abc import Callable, Mapping

from ..plan.knobs import KNOBS
from ..scene.knob import Value
from .measurement import Setting

FACTOR = 4
"""Samples of the reference over those of the dearest setting."""
LEAST = 256
"""Samples of the reference at least, where nothing makes it cheaper."""
SEED = 2_000_000_000
SHARE = 0.35
"""Share of a budget that the reference may take."""
ALONE = 0.1
"""Share of a budget that one setting may take."""
SAVES = 0.97
"""A knob is turned down for the budget where that leaves less than this of the seconds."""

Cost = Callable[[Mapping[str, Value]], float]


def below(name: str, value: Value, default: Value) -> Value | None:
    """The next cheaper value of a knob, None where it is at its default, or below it."""
    values = KNOBS[name].values
    if value not in values or default not in values or values.index(value) <= values.index(default):
        return None
    return values[values.index(value) - 1]


def affordable(best: Mapping[str, Value], lowest: Mapping[str, Value], alone: Cost, most: float) -> Setting:
    """Reference values of knobs of tables that each, turned alone, take ``most`` seconds by ``alone``, or those of
    ``lowest``."""
    found = dict(best)
    for name in best:
        if KNOBS[name].place[0] == "table":
            while alone({name: found[name]}) > most:
                lower = below(name, found[name], lowest[name])
                if lower is None:
                    break
                found[name] = lower
    return found


def shrunk(
    best: Mapping[str, Value], lowest: Mapping[str, Value], cost: Cost, limit: float, least: int, fewest: int
) -> Setting:
    """A reference of at most ``limit`` seconds by ``cost``, or the cheapest there is.

    First it has fewer samples, down to ``least``. Where not even the cheapest tables are enough then, other code is
    given up. Then knobs of tables are turned down, not below ``lowest``, the one that saves most at each step, then
    other knobs; then all of them at once, which leaves the kernel of the defaults; then samples again, down to
    ``fewest``. What is left in the end goes to samples.
    """
    found = dict(best)
    samples, known = int(found["spp"]), dict[str, float]()

    def seconds(own: Setting) -> float:
        name = str(sorted(own.items()))
        if name not in known:
            known[name] = cost(own)
        return known[name]

    def halved(to: int) -> None:
        while int(found["spp"]) > to and seconds(found) > limit:
            found["spp"] = max(int(found["spp"]) // 2, to)

    halved(min(least, samples))
    cheapest = {n: lowest[n] for n in found if KNOBS[n].place[0] == "table"}
    if seconds(found) > limit and seconds({**found, **cheapest}) > limit:
        plain = {n: lowest[n] if KNOBS[n].switches else value for n, value in found.items()}
        if seconds(plain) < SAVES * seconds(found):
            found = plain
    for tables in (True, False):  # what others do is not even looked at where tables are enough
        if (now := seconds(found)) <= limit:
            break
        names = [n for n in sorted(found) if n != "spp" and (KNOBS[n].place[0] == "table") == tables]
        names = [n for n in names if below(n, found[n], lowest[n]) is not None]
        useful = [n for n in names if seconds({**found, n: lowest[n]}) < SAVES * now]
        while seconds(found) > limit:
            steps = [(n, lower) for n in useful if (lower := below(n, found[n], lowest[n])) is not None]
            if not steps:
                break
            name, lower = min(steps, key=lambda step: seconds({**found, step[0]: step[1]}))
            found[name] = lower
    plain = {n: value if n == "spp" else lowest[n] for n, value in found.items()}
    if seconds(found) > limit and seconds(plain) < SAVES * seconds(found):
        found = plain
    halved(min(fewest, samples))
    while 2 * int(found["spp"]) <= samples and seconds({**found, "spp": 2 * int(found["spp"])}) <= limit:
        found["spp"] = 2 * int(found["spp"])
    return found


def within(values: tuple[Value, ...], name: str, best: Value, wanted: Value, default: Value) -> tuple[Value, ...]:
    """Those of a knob's values that a reference at ``best``, not as dear as ``wanted``, can judge."""
    if best == wanted:
        return values
    if name == "spp":
        return tuple(v for v in values if v == default or 2 * int(v) <= int(best))
    known = KNOBS[name].values
    if KNOBS[name].noise or best not in known:
        return values
    return tuple(v for v in values if v not in known or known.index(v) <= known.index(best))
