"""What can be turned in the simulation of a profile."""

from scratchwarp.profiles.theta import THETA_MODELS
from scratchwarp.scene.knob import Knob

_RAYMOND = "Raymond, Guennebaud, Barla 2016, sections 4.1 and 4.2"

KNOBS = (
    Knob(
        name="tables.resolution",
        values=(16, 32, 64, 128, 256, 512),
        default=256,
        error="highlights as wide as a bin of the table at least",
        sets="table.resolution",
        effects=("scratches.table",),
        limits=(4, 1024),
        quality=(128, 256, 256, 512),
        source=_RAYMOND,
    ),
    Knob(
        name="tables.rays",
        values=(8, 16, 32, 64, 128, 256, 512),
        default=128,
        error="light in the wrong bins of the table",
        sets="table.rays",
        effects=("scratches.table",),
        limits=(4, 65536),
        quality=(32, 128, 256, 512),
        source=_RAYMOND,
    ),
    Knob(
        name="tables.sampler",
        values=("random", "stratified", "beam"),
        default="beam",
        error="noise frozen into the table",
        sets="table.sampler",
        effects=("scratches.table",),
        source=_RAYMOND,
    ),
    Knob(
        name="tables.incidence",
        values=("centre", "cell"),
        default="cell",
        error="tables that are not quite reciprocal",
        sets="table.incidence",
        effects=("scratches.table",),
        source=_RAYMOND,
    ),
    Knob(
        name="tables.bounces",
        values=(1, 2, 3, 5, 10, 2000),
        default=2000,
        error="light lost that leaves the profile later",
        sets="table.max_bounces",
        effects=("scratches.interreflection",),
        limits=(1, 2000),
        source="Raymond, Guennebaud, Barla 2016, section 4.1",
    ),
    Knob(
        name="tables.theta",
        values=("auto", *(name for name in THETA_MODELS if name != "exact"), "full"),
        default="auto",
        error="reflectance between the slices of the table",
        sets="table.theta_model",
        effects=("scratches.fresnel",),
        source="Raymond, Guennebaud, Barla 2016, Equation 2",
    ),
)
