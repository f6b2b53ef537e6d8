"""What a validation rule is, and what the rules share: layers, authored names, definitions, suggestions."""

import difflib
from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass
from typing import Any

from pxr import Sdf, Usd

LAYER_API = "ScratchLayerAPI"
LAYER_PREFIX = "scratch:layer:"
NAMESPACES = ("scratch:", "primvars:scratch:")


@dataclass(frozen=True)
class Problem:
    """One thing that a rule found: the prim or property at fault and a message that says what to do about it."""

    path: Sdf.Path
    message: str
    severity: str = "error"


@dataclass(frozen=True)
class Rule:
    """A check of one prim (or, with ``whole_stage``, of a stage).

    Attributes:
        name: how findings and OpenUSD's validation registry name it.
        doc: what it checks, in one sentence.
        check: yields the problems of the prim (or stage) it is given.
        schemas: schema types whose prims it looks at; every prim when empty.
        whole_stage: ``check`` takes the stage instead of a prim.
    """

    name: str
    doc: str
    check: Callable[[Any], Iterable[Problem]]
    schemas: tuple[str, ...] = ()
    whole_stage: bool = False


def layer_names(prim: Usd.Prim) -> list[str]:
    """Instance names of the scratch layers applied to ``prim``, in order of application."""
    prefix = f"{LAYER_API}:"
    return [name.removeprefix(prefix) for name in prim.GetAppliedSchemas() if name.startswith(prefix)]


def layer_attribute(prim: Usd.Prim, layer: str, name: str) -> Usd.Attribute:
    """The attribute ``name`` of a layer."""
    return prim.GetAttribute(f"{LAYER_PREFIX}{layer}:{name}")


def value(attribute: Usd.Attribute, time: Usd.TimeCode | None = None) -> Any:
    """The attribute's value, at the first time sample unless told; the fallback of the schema where it is blocked."""
    found = attribute.Get(Usd.TimeCode.EarliestTime() if time is None else time)
    if found is None:
        definition = attribute.GetPrim().GetPrimDefinition().GetAttributeDefinition(attribute.GetName())
        found = definition.GetFallbackValue() if definition else None
    return found


def times(attribute: Usd.Attribute) -> list[Usd.TimeCode]:
    """Every time at which the attribute has a value of its own: the default, then each sample."""
    return [Usd.TimeCode.Default(), *(Usd.TimeCode(sample) for sample in attribute.GetTimeSamples())]


def scratch_properties(prim: Usd.Prim) -> Iterator[Usd.Property]:
    """Authored properties of ``prim`` in the namespaces of the schemas."""
    for name in prim.GetAuthoredPropertyNames():
        if name.startswith(NAMESPACES):
            yield prim.GetProperty(name)


def suggestion(word: str, known: Iterable[str]) -> str | None:
    """The known word that ``word`` was most likely meant to be; None when nothing is near."""
    by_lower = {name.lower(): name for name in known}
    near = difflib.get_close_matches(word.lower(), by_lower, n=1, cutoff=0.6)
    return by_lower[near[0]] if near else None


def did_you_mean(word: str, known: Iterable[str]) -> str:
    """A sentence for a message: the nearest known word, or the whole list of them."""
    names = list(known)
    near = suggestion(word, names)
    return f"did you mean {near!r}?" if near else f"known are {', '.join(sorted(names))}"
