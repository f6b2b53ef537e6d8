"""Reading: what every part of the reader needs to know, and the warnings it gathers."""

from collections.abc import Callable
from dataclasses import dataclass, field
from numbers import Real
from typing import Any

import numpy as np
from pxr import Tf, Usd, UsdGeom

from scratchwarp.scene import Budget, StageError

TextureLoader = Callable[[str, str], np.ndarray]
"""(path, colour space) -> float32 [h, w, 4], row 0 at the top, linear Rec.709 or raw."""

_NAMED = 3  # prims that a warning names before it counts the rest


class Warnings:
    """Sentences about prims, each said once: ``/A, /B and 7 more: what could not be honoured``."""

    def __init__(self) -> None:
        self._places: dict[str, dict[str, None]] = {}

    def __call__(self, where: object, what: str) -> None:
        """Say ``what`` of the prim ``where``."""
        self._places.setdefault(what, {})[str(where)] = None

    def lines(self) -> tuple[str, ...]:
        """One sentence for each thing said, in order."""
        found = []
        for what, places in self._places.items():
            names = list(places)
            rest = len(names) - _NAMED
            named = ", ".join(names[:_NAMED]) + (f" and {rest} more" if rest > 0 else "")
            found.append(f"{named}: {what}")
        return tuple(found)


@dataclass(frozen=True, eq=False)
class Reading:
    """One reading of a stage at one time.

    Attributes:
        stage: the stage; time: what every attribute is read at.
        path: the file, for messages.
        metres: metersPerUnit.
        purposes: purposes to include.
        warn: ``warn(prim path, sentence)``.
        load_texture: decodes an image file; None: textures give their fallback.
        primvars: names of primvars that scratch layers read.
        budget: memory that what is read may take.
        xforms: local-to-world matrices at ``time``, cached.
    """

    stage: Usd.Stage
    time: Usd.TimeCode
    path: str
    metres: float
    purposes: tuple[str, ...] = ("default", "render")
    warn: Warnings = field(default_factory=Warnings)
    load_texture: TextureLoader | None = None
    primvars: frozenset[str] = frozenset()
    budget: Budget = field(default_factory=Budget)
    xforms: UsdGeom.XformCache = field(init=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "xforms", UsdGeom.XformCache(self.time))

    def world(self, prim: Usd.Prim) -> np.ndarray:
        """Object to world in scene units, float64 [4, 4], column vectors; StageError on xformOps that USD refuses."""
        try:
            return np.array(self.xforms.GetLocalToWorldTransform(prim)).T
        except Tf.ErrorException:
            raise StageError(f"{self.path}: {prim.GetPath()} has xformOps that USD cannot evaluate") from None

    def value(self, prim: Usd.Prim, name: str, otherwise: Any = None) -> Any:
        """The attribute's value at this time; where it has none (blocked) the schema's fallback, else ``otherwise``.

        A value of another type than those (USD lets any be authored) counts as none, with a warning.
        """
        attribute = prim.GetAttribute(name)
        got = attribute.Get(self.time) if attribute else None
        if got is not None and fits(got, otherwise) and otherwise is not None:
            return got
        definition = prim.GetPrimDefinition().GetAttributeDefinition(name)
        like = definition.GetFallbackValue() if definition else None
        like = otherwise if like is None else like
        typed = definition.GetTypeName().defaultValue if definition and like is None else like
        if got is None or fits(got, typed):
            return like if got is None else got
        used = "nothing" if like is None else repr(like)
        self.warn(attribute.GetPath(), f"holds {got!r}, which is of the wrong type; {used} is used")
        return like

    def number(self, prim: Usd.Prim, name: str, otherwise: float = 0.0) -> float:
        """The same for a number: one that is not finite gives ``otherwise``, with a warning."""
        got = float(self.value(prim, name, otherwise))
        if not np.isfinite(got):
            self.warn(prim.GetPath(), f"{name} is {got}; {otherwise:g} is used")
            return otherwise
        return got

    def numbers(self, attribute: Usd.Attribute, width: int = 1, whole: bool = False) -> np.ndarray:
        """An array of numbers, shape [n], or of vectors [n, width], float64, int64 where ``whole``; empty where it has
        none or, with a warning, one of another type. Primvars are read without their indices."""
        primvar = UsdGeom.Primvar(attribute)
        got = primvar.ComputeFlattened(self.time) if primvar else attribute.Get(self.time) if attribute else None
        made = np.zeros((0,) if width == 1 else (0, width), np.int64 if whole else np.float64)
        values = made if got is None else np.asarray(got)
        if values.ndim and not len(values):
            return made
        wanted = "iu" if whole else "fiu"
        if values.ndim != made.ndim or values.shape[1:] != made.shape[1:] or values.dtype.kind not in wanted:
            self.warn(attribute.GetPath(), f"holds {_brief(got)}, which is of the wrong type; it is ignored")
            return made
        return values.astype(made.dtype)


def _brief(value: Any) -> str:
    text = repr(value)
    return text if len(text) <= 80 else f"{text[:77]}..."


def fits(value: Any, like: Any) -> bool:
    """Whether a value can stand where ``like`` does: numbers for numbers, text for text, tuples for tuples as long."""
    if like is None:
        return True
    if isinstance(like, Real):
        return isinstance(value, Real)
    if isinstance(like, str):
        return isinstance(value, str)
    kind = type(like).__name__
    if isinstance(like, tuple) or (kind.startswith("Vec") and not kind.endswith("Array")):
        if isinstance(value, str) or not hasattr(value, "__len__") or len(value) != len(like):
            return False
        return all(fits(one, other) for one, other in zip(value, like, strict=True))
    if hasattr(like, "__len__"):
        return hasattr(value, "__len__") and not isinstance(value, str)
    return isinstance(value, type(like))


def shared_path(prim: Usd.Prim) -> str:
    """A name that all instances of a prim have in common."""
    return str(prim.GetPrimInPrototype().GetPath() if prim.IsInstanceProxy() else prim.GetPath())
