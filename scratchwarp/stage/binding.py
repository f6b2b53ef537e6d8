"""Which material is bound where."""

from collections.abc import Sequence

from pxr import Usd, UsdShade

from .mesh import material_subsets

PURPOSES = ("full", "")
"""RenderSettings' materialBindingPurposes where none are authored."""


def bound_materials(prims: Sequence[Usd.Prim], purposes: Sequence[str] = PURPOSES) -> list[Usd.Prim | None]:
    """The material prim of each prim: of the first purpose for which one is bound, all-purpose bindings last."""
    found: list[Usd.Prim | None] = [None] * len(prims)
    asked = [p for p in purposes if p not in ("", "allPurpose")]
    for purpose in [*asked, ""]:
        left = [i for i, material in enumerate(found) if material is None]
        if not left:
            break
        materials, bindings = UsdShade.MaterialBindingAPI.ComputeBoundMaterials([prims[i] for i in left], purpose)
        for i, material, binding in zip(left, materials, bindings, strict=True):
            # USD falls back to the all-purpose binding by itself; further purposes must have their turn before it.
            last = purpose == "" or purpose == asked[-1]
            if material and (last or _purpose(binding) == purpose):
                found[i] = material.GetPrim()
    return found


def lost_binding(prim: Usd.Prim) -> str | None:
    """Path that the all-purpose binding of a prim without material names, its own or an ancestor's, though no Material
    is there."""
    while prim and not prim.IsPseudoRoot():
        targets = UsdShade.MaterialBindingAPI(prim).GetDirectBindingRel().GetTargets()
        if targets:
            return str(targets[0])
        prim = prim.GetParent()
    return None


def _purpose(binding: Usd.Relationship) -> str:
    """Purpose in a name such as material:binding[:purpose] or material:binding:collection[:purpose]:name."""
    _, _, *rest = binding.SplitName()
    if rest and rest[0] == "collection":
        return rest[1] if len(rest) > 2 else ""
    return rest[0] if rest else ""


def slot_prims(prim: Usd.Prim) -> list[Usd.Prim]:
    """The prims whose bindings give the materials of a mesh's slots: itself, then its material subsets."""
    return [prim, *(subset.GetPrim() for subset in material_subsets(prim))]
