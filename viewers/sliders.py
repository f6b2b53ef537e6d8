"""Sliders: one for each number that can be turned."""

from collections.abc import Callable
from typing import Any

from .colors import TEXT
from .cross_sections import Knob

Ends = tuple[tuple[float, float], tuple[float, float]]


def _nothing() -> None:
    """What a slider does besides when nobody asks for more."""


def slider(
    plotter: Any,
    knob: Knob,
    ends: Ends,
    turned: Callable[[float], None],
    *,
    grabbed: Callable[[], None] = _nothing,
    released: Callable[[], None] = _nothing,
) -> Any:
    """A slider widget in the active renderer from ``ends[0]`` to ``ends[1]``, shares of the whole window.

    ``turned`` is called with the value for every step of a drag, ``grabbed`` before the first and ``released`` after
    the last, each before VTK draws the window; none of them when it is made.
    """
    ready = False

    def moved(value: float) -> None:
        if ready:
            turned(value)

    widget = plotter.add_slider_widget(
        moved, (knob.low, knob.high), value=knob.value, title=knob.name, color=TEXT, style="modern",
        interaction_event="always", title_height=0.022, slider_width=0.03, tube_width=0.012, fmt="%.3g",
    )  # fmt: skip
    ready = True
    widget.AddObserver("StartInteractionEvent", lambda *_: grabbed())
    widget.AddObserver("EndInteractionEvent", lambda *_: released())
    shown = widget.GetRepresentation()
    for place, end in ((shown.GetPoint1Coordinate(), ends[0]), (shown.GetPoint2Coordinate(), ends[1])):
        place.SetValue(*end)
    shown.SetLabelHeight(0.02)
    return widget
