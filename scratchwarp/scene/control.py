"""Controls: the attributes of a stage that can be turned while it is looked at."""

import math
from dataclasses import dataclass
from typing import Any

KINDS = ("number", "whole", "switch", "choice", "pair", "triple", "color", "name", "fixed")
SECTIONS = ("layer", "profile", "curves", "wave", "measured", "surface", "light", "camera", "settings")

_LONGEST_NAME = 200


@dataclass(frozen=True)
class Control:
    """One attribute, as its schema describes it.

    Attributes:
        id: path of the attribute. section: one of ``SECTIONS``; owner: what it belongs to (prim, and layer if of one).
        label, group, documentation, units: of the schema; units "" where it has none.
        kind: one of ``KINDS``; a "fixed" one (a file, an array) is shown and cannot be turned.
        value: as it is; default: of the schema, None where it says none.
        low, high: ends of its slider. least, most: limits of the schema, None without; open_least, open_most: whether
            the limit itself is excluded. choices: of kind choice.
    """

    id: str
    section: str
    owner: str
    label: str
    kind: str
    value: Any
    default: Any = None
    group: str = ""
    documentation: str = ""
    units: str = ""
    low: float = 0.0
    high: float = 1.0
    least: float | None = None
    most: float | None = None
    open_least: bool = False
    open_most: bool = False
    choices: tuple[str, ...] = ()

    def checked(self, value: Any) -> Any:
        """``value`` as this control takes it; ValueError naming the attribute where it does not."""
        numbers = {"pair": 2, "triple": 3, "color": 3}
        if self.kind == "fixed":
            raise self._refused(value, "cannot be turned")
        if self.kind == "switch":
            if not isinstance(value, bool):
                raise self._refused(value, "expected true or false")
            return value
        if self.kind == "choice":
            if value not in self.choices:
                raise self._refused(value, f"expected one of {', '.join(self.choices)}")
            return value
        if self.kind == "name":
            fits = isinstance(value, str) and len(value) <= _LONGEST_NAME and value.isprintable()
            if not fits:
                raise self._refused(value, f"expected a name of at most {_LONGEST_NAME} characters")
            return value
        if self.kind in numbers:
            if not isinstance(value, list | tuple) or len(value) != numbers[self.kind]:
                raise self._refused(value, f"expected {numbers[self.kind]} numbers")
            return tuple(self._number(part) for part in value)
        if self.kind == "whole" and (not isinstance(value, int) or isinstance(value, bool) or abs(value) >= 2**31):
            raise self._refused(value, "expected a whole number")
        return int(value) if self.kind == "whole" and self._number(value) == value else self._number(value)

    def _number(self, value: Any) -> float:
        if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
            raise self._refused(value, "expected a finite number")
        low, high = self.least, self.most
        under = low is not None and (value < low or (self.open_least and value == low))
        over = high is not None and (value > high or (self.open_most and value == high))
        if under or over:
            ends = f"{'(' if self.open_least or low is None else '['}{'-inf' if low is None else f'{low:g}'}, "
            ends += f"{'inf' if high is None else f'{high:g}'}{')' if self.open_most or high is None else ']'}"
            raise self._refused(value, f"expected a value in {ends}")
        return float(value)

    def _refused(self, value: Any, why: str) -> ValueError:
        return ValueError(f"{self.id}: {str(value)[:60]!r} is refused; {why}")
