"""Responses over solid angle: how scratches (or a base) reflect that no table along the mirror cone describes.

Files (device): ``response_device`` what every response takes and returns; ``facets_device``, ... one a response.
Files (host): ``pack`` their data for the device, ``facets`` and the like one a response.

A response is its device functions, a function that packs its values, and a line in ``RESPONSES``.
"""

import importlib
from dataclasses import dataclass
from typing import Any

_HERE = "scratchwarp.reflectance.responses"


@dataclass(frozen=True)
class Response:
    """A kind of response.

    Attributes:
        effect: the plan's effect that turns it on. device: its device module, which defines ``{stem}_eval`` and
        ``{stem}_sample``, and ``{stem}_place`` where ``placed``. host: module whose ``pack(values, arrays, device)``
        fills its part of ``ResponseArrays`` from the values of all responses of the kind.
        base: it stands in for a material's base, else for scratches.
    """

    effect: str
    stem: str
    device: str
    host: str
    placed: bool = False
    base: bool = False

    def functions(self) -> tuple[Any, Any, Any]:
        """(eval, sample, place or None), the Warp functions."""
        module = importlib.import_module(f"{_HERE}.{self.device}")
        place = getattr(module, f"{self.stem}_place") if self.placed else None
        return getattr(module, f"{self.stem}_eval"), getattr(module, f"{self.stem}_sample"), place

    def pack(self, values: list[Any], arrays: Any, device: str) -> None:
        """Put the data of all responses of this kind into ``arrays``."""
        importlib.import_module(f"{_HERE}.{self.host}").pack(values, arrays, device)


# name -> kind; the position, counted from 1, is the number that ResponseData.kind holds.
RESPONSES: dict[str, Response] = {
    "ashikhminShirley": Response("scratches.ashikhminShirley", "facets", "facets_device", "facets"),
}


def kind_number(name: str) -> int:
    """The number that ``ResponseData.kind`` holds for a response of ``RESPONSES``."""
    return list(RESPONSES).index(name) + 1
