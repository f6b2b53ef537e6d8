"""What of a stage is there to be rendered, and where it stands."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np
from pxr import Sdf, Usd, UsdGeom, UsdLux, UsdShade

from .reading import Reading

_ALL = Usd.TraverseInstanceProxies()
# Prototypes of point instancers may be overs or classes: only the prims inside must be defined.
_PROTOTYPE = Usd.TraverseInstanceProxies(Usd.PrimIsActive & Usd.PrimIsLoaded & Usd.PrimHasDefiningSpecifier)


@dataclass(frozen=True, eq=False)
class Placed:
    """A prim that can be seen, in one place.

    Attributes:
        prim: the prim, perhaps an instance proxy.
        path: name of this placement.
        world: object to world in scene units, float64 [4, 4], column vectors.
        included: whether its purpose is asked for (lights come whatever their purpose).
    """

    prim: Usd.Prim
    path: str
    world: np.ndarray
    included: bool = True


def placed_prims(reading: Reading) -> list[Placed]:
    """Every visible geometric prim and light of the stage, in stage order.

    Instances are followed through their proxies, point instancers through their prototypes; a prototype is not met
    again where it lies on the stage.
    """
    prototypes: set[Sdf.Path] = set()
    found = list(_walk(reading, reading.stage.GetPseudoRoot(), reading.world, None, _ALL, prototypes, ()))
    if not prototypes:
        return found
    return [p for p in found if not _below(p.prim.GetPath(), p.path, prototypes)]


def _below(path: Sdf.Path, placement: str, prototypes: set[Sdf.Path]) -> bool:
    """Whether a prim met where it lies on the stage (not through an instancer) is part of a prototype."""
    return placement == str(path) and any(path.HasPrefix(p) for p in prototypes)


def _walk(
    reading: Reading,
    root: Usd.Prim,
    place: Callable[[Usd.Prim], np.ndarray],
    purpose: UsdGeom.Imageable.PurposeInfo | None,
    predicate: Usd._PrimFlagsPredicate,
    prototypes: set[Sdf.Path],
    within: tuple[Sdf.Path, ...],
) -> Iterator[Placed]:
    """Visible prims at and below ``root``; ``place`` gives a prim's matrix, ``within`` are the instancers around it."""
    todo = [(root, purpose)]
    while todo:
        prim, inherited = todo.pop()
        imageable = UsdGeom.Imageable(prim)
        if imageable:
            if imageable.GetVisibilityAttr().Get(reading.time) == UsdGeom.Tokens.invisible:
                continue
            inherited = imageable.ComputePurposeInfo(inherited or UsdGeom.Imageable.PurposeInfo())
        elif prim.IsA(UsdShade.NodeGraph) or prim.IsA(UsdShade.Shader):
            continue
        included = inherited is None or str(inherited.purpose or "default") in reading.purposes
        if prim.IsA(UsdGeom.PointInstancer):
            yield from _instancer(reading, UsdGeom.PointInstancer(prim), place, inherited, prototypes, within)
            continue
        if prim.IsA(UsdGeom.Gprim) or prim.HasAPI(UsdLux.LightAPI):
            yield Placed(prim, str(prim.GetPath()), place(prim), included)
        todo += [(child, inherited) for child in reversed(prim.GetFilteredChildren(predicate))]


def _instancer(
    reading: Reading,
    instancer: UsdGeom.PointInstancer,
    place: Callable[[Usd.Prim], np.ndarray],
    purpose: UsdGeom.Imageable.PurposeInfo | None,
    prototypes: set[Sdf.Path],
    within: tuple[Sdf.Path, ...],
) -> Iterator[Placed]:
    """Everything that an instancer places, instance by instance."""
    path = instancer.GetPath()
    if path in within:
        reading.warn(path, "is a prototype of itself; the inner instances are left out")
        return
    primvars = UsdGeom.PrimvarsAPI(instancer).GetPrimvarsWithAuthoredValues()
    if any(p.GetInterpolation() != UsdGeom.Tokens.constant for p in primvars):
        reading.warn(path, "primvars of single instances are not honoured")
    stage = reading.stage
    targets = instancer.GetPrototypesRel().GetForwardedTargets()
    prototypes.update(t for t in targets if not t.HasPrefix(path))
    chosen = reading.numbers(instancer.GetProtoIndicesAttr(), whole=True)
    mask = np.asarray(instancer.ComputeMaskAtTime(reading.time), bool)
    reading.budget.take(2000.0 * len(chosen), f"{reading.path}: {path}", f"{len(chosen)} instances")
    # With the prototypes' own transforms USD gives up on any index that is out of range; they are applied below.
    own = UsdGeom.PointInstancer.ExcludeProtoXform
    matrices = np.asarray(instancer.ComputeInstanceTransformsAtTime(reading.time, reading.time, own), np.float64)
    matrices = matrices.reshape(-1, 4, 4).transpose(0, 2, 1)
    numbers = np.arange(len(chosen))[mask] if len(mask) else np.arange(len(chosen))
    if len(matrices) != len(numbers):
        reading.warn(path, "positions, orientations, scales and protoIndices differ in length; it is left out")
        return
    outside = (chosen < 0) | (chosen >= len(targets))
    if outside.any():
        reading.warn(path, f"protoIndices point outside 0..{len(targets) - 1}; those instances are left out")
    base = place(instancer.GetPrim())
    for which, target in enumerate(targets):
        root = stage.GetPrimAtPath(target)
        if not root:
            reading.warn(path, f"prototype {target} does not exist; its instances are left out")
            continue

        def relative(prim: Usd.Prim, root: Usd.Prim = root) -> np.ndarray:
            within_root = np.array(reading.xforms.ComputeRelativeTransform(prim, root)[0]).T
            return np.array(reading.xforms.GetLocalTransformation(root)[0]).T @ within_root

        parts = list(_walk(reading, root, relative, purpose, _PROTOTYPE, prototypes, (*within, path)))
        for i in np.flatnonzero(chosen[numbers] == which):
            for part in parts:
                name = f"{path}[{numbers[i]}]{part.path.removeprefix(str(target))}"
                yield Placed(part.prim, name, base @ matrices[i] @ part.world, part.included)
