"""Where a shader's input has its value from, and the value where it is a constant."""

from typing import Any

from pxr import Usd, UsdShade

from .reading import Reading, fits


def source_of(node: UsdShade.Shader, name: str) -> Usd.Attribute | None:
    """The attribute that gives an input its value, through interfaces of node graphs and materials; None: nothing."""
    given = node.GetInput(name)
    sources = given.GetValueProducingAttributes() if given else []
    return sources[0] if sources else None


def is_output(source: Usd.Attribute) -> bool:
    """Whether the value is another node's output, not a constant."""
    return UsdShade.Utils.GetType(source.GetName()) == UsdShade.AttributeType.Output


def constant(reading: Reading, source: Usd.Attribute, otherwise: Any = None) -> Any:
    """The attribute's value; ``otherwise`` where it has none or, with a warning, one of another type."""
    got = source.Get(reading.time)
    if got is not None and not fits(got, otherwise):
        reading.warn(source.GetPath(), f"holds {got!r}, which is of the wrong type; {otherwise} is used")
        return otherwise
    return otherwise if got is None else got
