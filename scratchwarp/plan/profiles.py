"""A ScratchProfile record and a layer's size -> the cross-section to simulate."""

import numpy as np

from .. import profiles
from ..scene import Layer, Profile

# Shape -> (attribute of the schema, parameter of ``profiles.shape``); what is not authored has the shape's default.
PARAMETERS = {
    "vGroove": (("apex", "apex"),),
    "trapezoid": (("floorWidth", "floor"), ("apex", "apex")),
    "gaussian": (("sigma", "sigma"),),
}


def cross_section(record: Profile, layer: Layer) -> profiles.Profile:
    """The profile at the layer's aspect (depth over width), in widths.

    Raises ValueError naming the profile prim and the value that cannot be simulated.
    """
    aspect = layer.depth / layer.width if layer.width > 0.0 else 0.0
    isolated = not record.periodic
    try:
        if record.points is not None and record.shape == "points":
            return profiles.Profile(record.points * np.array([1.0, aspect]), isolated=isolated)
        authored = dict(record.parameters)
        given = {ours: authored[name] for name, ours in PARAMETERS.get(record.shape, ()) if name in authored}
        return profiles.shape(
            record.shape, depth=aspect, rim=record.rim, rim_width=record.rim_width, isolated=isolated, **given
        )
    except ValueError as error:
        raise ValueError(f"{record.path} (for {layer.label}): {error}") from None
