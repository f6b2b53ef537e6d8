"""Which function reads which type of light."""

from collections.abc import Callable

import numpy as np
from pxr import Usd, UsdGeom, UsdLux

from scratchwarp.scene import Light

from .light_far import distant, dome
from .light_near import EmittingShape, cylinder, disk, rect, sphere
from .reading import Reading
from .texture import Textures

LightReader = Callable[[Reading, Usd.Prim, np.ndarray, Textures], "Light | EmittingShape | None"]

READERS: dict[str, LightReader] = {
    "SphereLight": sphere,
    "RectLight": rect,
    "DiskLight": disk,
    "CylinderLight": cylinder,
    "DistantLight": distant,
    "DomeLight": dome,
    "DomeLight_1": dome,
}


def is_mesh_light(prim: Usd.Prim) -> bool:
    """Whether the prim is geometry that shines."""
    return prim.IsA(UsdGeom.Gprim) and prim.HasAPI(UsdLux.LightAPI)


def read_light(
    reading: Reading, prim: Usd.Prim, metric: np.ndarray, textures: Textures
) -> Light | EmittingShape | None:
    """Read a light; ``metric`` takes its space to metres about the scene's origin.

    None, with a warning, where it gives no light or its type is not known.
    """
    reader = READERS.get(str(prim.GetTypeName()))
    if reader is None:
        reading.warn(prim.GetPath(), f"lights of type {prim.GetTypeName()} are not honoured")
        return None
    return reader(reading, prim, metric, textures)


def linked(prim: Usd.Prim, collection: str, placements: list[str]) -> frozenset[int] | None:
    """Indices of the placements (prim paths) in a light's linking collection; None when that is all of them."""
    api = Usd.CollectionAPI(prim, collection)
    if not api or _everything(api):
        return None
    query = api.ComputeMembershipQuery()
    inside = [i for i, path in enumerate(placements) if query.IsPathIncluded(path.partition("[")[0])]
    return None if len(inside) == len(placements) else frozenset(inside)


def _everything(api: Usd.CollectionAPI) -> bool:
    root = api.GetIncludeRootAttr().Get()
    return bool(root) and not api.GetExcludesRel().HasAuthoredTargets()
