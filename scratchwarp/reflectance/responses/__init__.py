"""Responses over solid angle: how scratches (or a base) reflect that no table along the mirror cone describes.

Files (device): ``response_device`` what every response takes and returns; ``facets_device``, ... one a response.
Files (host): ``pack`` all of them for the device, ``facets``, ... one a response.

A response is its device functions, a function that packs its values, and a line in ``RESPONSES``.
"""

import importlib
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

_HERE = "scratchwarp.reflectance.responses"


@dataclass(frozen=True)
class Response:
    """A kind of response.

    Attributes:
        effect: the plan's effect that turns it on.
        stem: of its modules: ``{stem}_device`` defines ``{stem}_eval``, ``{stem}_sample`` and, where ``placed``,
        ``{stem}_place``; ``pack(values, arrays, device, textures)`` of ``{stem}`` fills its part of
        ``ResponseArrays`` from the values of all responses of the kind and the scene's textures, and returns what must
        outlive it.
        base: it stands in for a material's base, else for scratches.
    """

    effect: str
    stem: str
    placed: bool = False
    base: bool = False

    def functions(self) -> tuple[Any, Any, Any]:
        """(eval, sample, place or None), the Warp functions."""
        module = importlib.import_module(f"{_HERE}.{self.stem}_device")
        place = getattr(module, f"{self.stem}_place") if self.placed else None
        return getattr(module, f"{self.stem}_eval"), getattr(module, f"{self.stem}_sample"), place

    def pack(self, values: list[Any], arrays: Any, device: str, textures: Sequence[Any]) -> Any:
        """Put the data of all responses of this kind into ``arrays``; returns what must outlive them."""
        return importlib.import_module(f"{_HERE}.{self.stem}").pack(values, arrays, device, textures)


# name -> kind; the position, counted from 1, is the number that ResponseData.kind holds.
RESPONSES: dict[str, Response] = {
    "ashikhminShirley": Response("scratches.ashikhminShirley", "facets"),
    "normalMap": Response("scratches.normalMap", "normal_response", placed=True),
    "stencils": Response("base.stencils", "stencil_response", placed=True, base=True),
    "utia": Response("base.utia", "utia_response", placed=True, base=True),
    "merl": Response("base.merl", "merl_response", placed=True, base=True),
    "rgl": Response("base.rgl", "rgl_response", placed=True, base=True),
}


def kind_number(name: str) -> int:
    """The number that ``ResponseData.kind`` holds for a response of ``RESPONSES``."""
    return list(RESPONSES).index(name) + 1
