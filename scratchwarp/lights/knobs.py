"""What can be turned in how scratches find their lights."""

from scratchwarp.scene.knob import Knob

KNOBS = (
    Knob(
        name="lights.cones",
        values=("lights", "cones", "both", "closed"),
        default="closed",
        error="noise where the light along a scratch's cone is sampled",
        effects=("scratches.table",),
        switches={
            "lights": {"lights.closedForm": False, "lights.sampleCones": False},
            "cones": {"lights.closedForm": False, "lights.sampleLights": False},
            "both": {"lights.closedForm": False},
            "closed": {},
        },
        noise=True,
        alternatives=("cones",),  # which seldom meet small lights
        source="multiple importance sampling: Veach 1997, chapter 9",
    ),
    Knob(
        name="lights.coneTaps",
        values=(1, 2, 4, 8, 16, 32, 64),
        default=16,
        error="images of domes and shaped lights blurred along the cones",
        sets="settings.cone_taps",
        effects=("lights.closedForm",),
        limits=(1, 64),
        quality=(4, 16, 16, 64),
    ),
)
