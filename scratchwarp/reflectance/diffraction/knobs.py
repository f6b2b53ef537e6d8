"""What can be turned in wave optics."""

from scratchwarp.scene.knob import Knob

_VELINOV = "Velinov, Werner, Hullin 2018"

KNOBS = (
    Knob(
        name="diffraction.lights",
        values=("paper", "slice", "slices"),
        default="slices",
        error="wide lights that lose or gain light across the scratch",
        effects=("diffraction.areaLights",),
        switches={
            "paper": {"diffraction.paperLights": True},
            "slice": {"diffraction.closedForm": True},
            "slices": {},
        },
        source=f"{_VELINOV}, Equations 27 and 29",
    ),
    Knob(
        name="diffraction.slices",
        values=(1, 2, 4, 8, 16),
        default=8,
        error="parts of wide lights, and what they send, blurred along the scratch",
        sets="glint.slices",
        effects=("diffraction.areaLights",),
        limits=(1, 16),
        quality=(4, 8, 8, 16),
    ),
    Knob(
        name="diffraction.footprint",
        values=("point", "paper", "gaussian", "exact"),
        default="gaussian",
        error="scratches near the rim of what a sample stands for are weighed as by another shape",
        effects=("diffraction.segments",),
        switches={
            "point": {"diffraction.pointFootprint": True},
            "paper": {"diffraction.paperFootprint": True},
            "gaussian": {},
            "exact": {"diffraction.exactFootprint": True},
        },
        source=f"{_VELINOV}, Equations 15 and 16",
    ),
    Knob(
        name="diffraction.strands",
        values=(64, 256, 1024, 4096, "all"),
        default=1024,
        error="noise where footprints hold many more scratches: some are drawn for all",
        sets="glint.strands",
        effects=("diffraction.crowds",),
        limits=(16, 1 << 20),
        noise=True,
    ),
    Knob(
        name="diffraction.colors",
        values=("auto", "rgb", "lookup", "wavelengths"),
        default="auto",
        error="colours of too few wavelengths",
        sets="wave.sampling",
        effects=("diffraction",),
        source=f"{_VELINOV}, section 5",
    ),
    Knob(
        name="diffraction.wavelengths",
        values=("auto", 4, 8, 16, 32, 64),
        default="auto",
        error="colours of too few wavelengths",
        sets="wave.samples",
        effects=("diffraction",),
        limits=(1, 1024),
        source=f"{_VELINOV}, section 5",
    ),
)
