"""What becomes of the layers of a material in another renderer."""

from collections.abc import Sequence
from typing import Any, NamedTuple

LEFT_OUT = "left out"


class Fate(NamedTuple):
    """How our own pictures show a layer (table, Lambert, diffraction, grooves, curves, or the name of a model), and
    what is baked of it: table or left out; ``differs``: whether its scratches are not all alike."""

    layer: str
    ours: str
    baked: str
    differs: bool = False


def shown(material: Any, one: Any) -> str:
    """How our own pictures show a sublayer."""
    from scratchwarp.plan.grooves import laid_out
    from scratchwarp.plan.waves import diffracts

    layer = one.sublayer.layer
    if diffracts(material, layer):
        return "diffraction"
    if laid_out(material, layer):
        return "grooves"
    if one.response >= 0:
        return str(layer.model)
    return "Lambert" if one.lambert else "table"


def lost(fates: Sequence[Fate], rough: bool) -> list[str]:
    """What is lost of layers, by prim and layer, where rough surfaces stand for them, or tables."""
    said = []
    for fate in fates:
        if fate.baked == LEFT_OUT:
            continue
        if fate.ours == "diffraction":
            kept = "a roughness that spreads light as far" if rough else "the table of its cross-section"
            said.append(f"{fate.layer}: diffracts; {kept} stands for it, colours that depend on direction are lost")
        elif fate.ours == "grooves":
            kept = "roughness, and normals of what texels resolve, stand" if rough else "their table stands"
            said.append(
                f"{fate.layer}: is laid out groove by groove; {kept} for them, crossings, shadows and light between "
                "neighbours are lost"
            )
        if fate.differs:
            said.append(f"{fate.layer}: its scratches differ; the mean one stands for all")
    return said
