"""About what each effect costs, so that a plan can say where the time will go.

Nanoseconds a camera sample on one core: what the demo ball gained, within some tens of percent, as distributions,
shadows and distant, sphere, rect and dome lights were switched off one at a time; the others are estimates beside them.
They rank effects; they do not predict seconds.
"""

from collections.abc import Mapping

from ..choice import EffectChoice, LayerPlan

CAMERA_RAY = 800.0
SHADOW_RAY = 160.0
SECOND_RAY = 300.0
LIGHT = {"distant": 150, "sphere": 170, "rect": 350, "disk": 350, "cylinder": 250, "dome": 400, "mesh": 500}
SET = {"worley": 140, "linear": 40, "concentric": 60, "spiral": 70, "full": 10, "curves": 350}
OTHER = {
    "base.textures": 150,
    "base.normalMaps": 80,
    "base.opacity": 900,
    "base.direction": 40,
    "base.measured": 60,
    "base.preview": 80,
    "lens": 20,
    "diffraction.segments": 700,
    "diffraction.bands": 150,
    "diffraction.areaLights": 250,
    "lights.closedForm": 300,
    "scratches.ashikhminShirley": 150,
    "scratches.normalMap": 400,
    "base.stencils": 400,
    "base.utia": 900,
    "base.merl": 500,
    "base.rgl": 1500,
}


def shares(
    effects: Mapping[str, EffectChoice],
    layers: tuple[tuple[LayerPlan, ...], ...],
    lights: Mapping[str, int],
    depth: int,
) -> dict[str, float]:
    """Share of the rendering time of each effect that is on, in [0, 1]; what every render needs is left over.

    ``lights``: effect name -> number of lights of that kind. ``layers``: a material's sets all run at each point.
    """
    on = {name for name, choice in effects.items() if choice.enabled}
    cost = {name: float(ns) for name, ns in OTHER.items() if name in on}
    cost |= {name: LIGHT[name.removeprefix("lights.")] * n for name, n in lights.items() if name in on and n}
    if "shadows" in on:
        cost["shadows"] = SHADOW_RAY * sum(n for name, n in lights.items() if name in on)
    with_layers = [own for own in layers if own]
    for kind, ns in SET.items():
        name = f"scratches.{kind}"
        if name in on and with_layers:
            sets = sum(p.sublayer.distribution == kind for own in with_layers for p in own)
            cost[name] = ns * sets / len(with_layers)
    if "scratches.table" in on:
        cost["scratches.table"] = 60.0
    total = sum(cost.values()) + CAMERA_RAY + SECOND_RAY
    if "indirect" in on:
        cost["indirect"] = 0.6 * total * (depth - 1)
        total += cost["indirect"]
    return {name: ns / total for name, ns in cost.items()}
