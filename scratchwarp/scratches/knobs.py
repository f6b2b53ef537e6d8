"""What can be turned in how scratches under a footprint are found."""

from scratchwarp.scene.knob import Knob

KNOBS = (
    Knob(
        name="scratches.coverageFilter",
        values=("pixel", "sample", "point"),
        default="sample",
        error="scratches finer than what a sample stands for are blurred; points leave them to noise",
        sets="camera.coverage",
        effects=("scratches", "diffraction", "grooves"),
        source="Raymond, Guennebaud, Barla 2016, section 6.1",
    ),
    Knob(
        name="diffraction.segmentLookup",
        values=("lists", "auto", "hierarchy"),
        default="auto",
        error="scratches beyond the neighbours of a triangle are missed",
        effects=("diffraction.segments",),
        switches={
            "lists": {"diffraction.lists": True, "diffraction.hierarchy": False},
            "auto": {},
            "hierarchy": {"diffraction.lists": False},
        },
        source="Velinov, Werner, Hullin 2018, section 4",
    ),
)
FOOTPRINTS = {"pixel": 1.0, "sample": 0.0, "point": 0.01}
"""Edge of a footprint in pixels by coverage filter; 0: that of a sample, 1 / sqrt(spp)."""
