"""What can be turned where grooves are laid out one by one."""

from scratchwarp.scene.knob import Knob

LINES = 48
"""Lines over a footprint where grooves cross or end, shared by the samples of a pixel."""
BOUNCES = 8
"""Facets that a path inside grooves may meet."""

KNOBS = (
    Knob(
        name="grooves.footprint",
        values=("axis", "ellipse"),
        default="ellipse",
        error="grooves that cross or end under a footprint are taken for parallel and endless",
        effects=("grooves.crossings",),
        switches={"axis": {"grooves.crossings": False}, "ellipse": {}},
    ),
    Knob(
        name="grooves.cells",
        values=("width", "balanced"),
        default="balanced",
        error="none: cells as wide as a groove take more memory, larger ones hold more grooves to try",
        sets="groove.cells",
        effects=("grooves",),
        source="Bosch, Pueyo, Merillou, Ghazanfarpour 2008, section 4.1",
    ),
    Knob(
        name="grooves.lines",
        values=(4, 12, 24, 48, 96, 192),
        default=LINES,
        error="crossings and ends between the lines of a footprint are missed",
        sets="groove.lines",
        effects=("grooves.crossings",),
        limits=(1, 4096),
        quality=(12, 48, 48, 192),
    ),
    Knob(
        name="grooves.section",
        values=(20, 10, 5, 2, 1, "auto", 0),
        default="auto",
        error="cross-sections of fewer facets, off the authored ones by so many thousandths of a width at most",
        sets="groove.section",
        effects=("grooves",),
        limits=(0, 100),
    ),
    Knob(
        name="grooves.bounces",
        values=(1, 2, 4, 8, 16),
        default=BOUNCES,
        error="light lost that leaves the grooves later",
        sets="groove.bounces",
        effects=("grooves.interreflection",),
        limits=(1, 256),
        quality=(2, 8, 8, 16),
    ),
)
