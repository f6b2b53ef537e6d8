"""How the effects of grooves laid out one by one are decided; rules as in ``effects``."""

from collections.abc import Callable
from typing import Any

_FAR = "no layer of model auto is seen from nearer than six widths of its scratches a sample"

Answer = tuple[bool, str, tuple[str, ...]]


def _found(f: Any, test: Callable[[Any], bool]) -> tuple[str, ...]:
    plans = [own for own in f.grooves if own is not None and test(own)]
    return tuple(dict.fromkeys(p.layer.label for own in plans for p in own.layers))


def _grooves(f: Any) -> Answer:
    found = _found(f, lambda own: True)
    return bool(found), "laid out one by one" if found else "no layer is laid out groove by groove", found


def _crossings(f: Any) -> Answer:
    if not _found(f, lambda own: True):
        return False, "no layer is laid out groove by groove", ()
    found = _found(f, lambda own: own.crossings)
    return bool(found), "they may cross, bend or end" if found else "parallel lines, which neither cross nor end", found


def _interreflection(f: Any) -> Answer:
    found = _found(f, lambda own: own.bounces)
    return bool(found), "light goes on from facet to facet" if found else "no facet that light could go on to", found


def _transmission(f: Any) -> Answer:
    found = _found(f, lambda own: own.refracts)
    return bool(found), "cut in glass, which refracts" if found else "no groove is cut in anything transparent", found


def _tapers(f: Any) -> Answer:
    found = _found(f, lambda own: own.tapers)
    return bool(found), "their sizes change along them" if found else "each groove is alike all along", found


def _handover(f: Any) -> Answer:
    found = _found(f, lambda own: own.handover)
    return bool(found), "statistical from afar, laid out near by" if found else _FAR, found


GROOVE_EFFECTS: dict[str, Callable[[Any], Answer]] = {
    "grooves": _grooves,
    "grooves.crossings": _crossings,
    "grooves.interreflection": _interreflection,
    "grooves.transmission": _transmission,
    "grooves.handover": _handover,
    "grooves.tapers": _tapers,
}
"""Effect -> its rule."""
