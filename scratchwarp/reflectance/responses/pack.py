"""Responses of a plan -> the arrays that the device reads."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
import warp as wp

from . import RESPONSES, kind_number
from .response_device import NODES, ResponseArrays, ResponseData


@dataclass(frozen=True, eq=False)
class PackedResponses:
    """Device data, and what must outlive it."""

    arrays: ResponseArrays
    alive: tuple[Any, ...]


def pack(plans: Sequence[Any], device: str = "cpu", textures: Sequence[Any] = ()) -> PackedResponses:
    """Device data of responses. Each has a ``name`` of ``RESPONSES``, ``values`` for its kind's ``pack`` and
    ``fresnel``, a reflector of ``optics`` or None, which reflects everything; ``textures``: the scene's."""
    names = [p.name for p in plans]
    arrays: Any = ResponseArrays()
    cosines = np.linspace(0.0, 1.0, NODES) ** 2
    records: list[Any] = []
    rows: list[np.ndarray] = []
    alive: list[Any] = []
    for number, plan in enumerate(plans):
        name = plan.name
        r: Any = ResponseData()
        r.kind = kind_number(name)
        r.index = list(names[:number]).count(name)
        r.reflectance = -1
        if plan.fresnel is not None:
            r.reflectance = len(rows)
            rows.append(np.broadcast_to(plan.fresnel.reflectance(cosines), (NODES, 3)))
        records.append(r)
    arrays.records = wp.array(records or [ResponseData()], dtype=ResponseData, device=device)
    table = np.stack(rows) if rows else np.ones((1, 1, 3))
    arrays.reflectances = wp.array(np.ascontiguousarray(table, np.float32), dtype=wp.vec3, device=device)
    for name, response in RESPONSES.items():
        own = [p.values for p in plans if p.name == name]
        if own:
            alive.append(response.pack(own, arrays, device, textures))
    return PackedResponses(arrays, tuple(alive))
