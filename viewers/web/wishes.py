"""What a browser may ask for; what comes from one is checked before anything is done."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

from ..looking import Looking
from ..turning import Move
from . import answers
from .guard import Guard

Wish = Callable[[dict[str, Any]], dict[str, Any]]


class Wishes:
    """Edits, moves, questions: each takes an object and gives one; ValueError or OSError on what is at fault."""

    def __init__(self, looking: Looking, target: Path, guard: Guard) -> None:
        self.looking, self.target, self.guard = looking, target, guard

    @property
    def known(self) -> dict[str, Wish]:
        """Name -> wish."""
        return {
            "edit": self._edit, "move": self._move, "pick": self._pick, "save": self._save, "reset": self._reset,
            "link": self._link,
        }  # fmt: skip

    def _edit(self, body: dict[str, Any]) -> dict[str, Any]:
        values = body.get("values")
        if not isinstance(values, dict):
            raise ValueError("values must be an object")
        known = {c.id: c for c in self.looking.shown.controls}
        unknown = next((name for name in values if name not in known), None)
        if unknown is not None:
            raise ValueError(f"{str(unknown)[:200]!r} is nothing that can be turned")
        self.looking.edit({name: known[name].checked(value) for name, value in values.items()})
        return {}

    def _move(self, body: dict[str, Any]) -> dict[str, Any]:
        prim = body.pop("prim", "")
        lights = {c.owner for c in self.looking.shown.controls if c.section == "light"}
        if not isinstance(prim, str) or (prim and prim not in lights):
            raise ValueError(f"{str(prim)[:200]!r} is no light that can be moved")
        names = set(body) - {"right", "up", "across", "along", "nearer"}
        if names:
            raise ValueError(f"{sorted(map(str, names))[0][:50]!r} is no part of a move")
        self.looking.move(prim, Move(**body))
        return {}

    def _pick(self, body: dict[str, Any]) -> dict[str, Any]:
        width, height = self.looking.shown.size
        pixel = (int(_share(body, "x") * width), int(_share(body, "y") * height))
        return answers.pixel(self.looking.do(lambda live, session: session.inspect(pixel)))

    def _save(self, body: dict[str, Any]) -> dict[str, Any]:
        self.looking.do(lambda live, session: live.save(self.target))
        return {"saved": str(self.target)}

    def _reset(self, body: dict[str, Any]) -> dict[str, Any]:
        self.looking.reset()
        return {}

    def _link(self, body: dict[str, Any]) -> dict[str, Any]:
        return {"link": self.guard.link()}


def _share(body: dict[str, Any], name: str) -> float:
    value = body.get(name)
    if isinstance(value, bool) or not isinstance(value, int | float) or not 0 <= value < 1:
        raise ValueError(f"{name} must be a share of the picture in [0, 1)")
    return float(value)
