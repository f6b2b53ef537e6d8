"""One cross-section, live: sliders for its numbers, its outline, and the table that is simulated as they move."""

from functools import partial
from pathlib import Path
from time import perf_counter
from typing import Any, NamedTuple

import numpy as np

from scratchwarp import profiles

from . import cross_sections, tables
from .colors import BACKGROUND, TEXT
from .cross_sections import CrossSection
from .display import canvas, check_writable, write
from .marks import Line, look_at
from .sheet import Sheet
from .sliders import slider

RESOLUTION = 128
RAYS = 128  # for each direction while a slider moves
FINE = 8  # times as many once it rests
SIZE = (960, 620)

# Places in the window's plane: the table lies in the unit square, the outline to its right.
_LEFT, _RIGHT, _TOP = 1.1, 2.1, 0.9
_NOTE = (0.02, 0.915)
# Left and right end of each slider in the window, two rows of three.
PLACES = [((0.03 + 0.33 * i, y), (0.31 + 0.33 * i, y)) for y in (0.16, 0.06) for i in range(3)]


class Spent(NamedTuple):
    """Seconds that the last update took: to simulate the table, and to repaint and draw the window."""

    simulation: float
    redraw: float


def view(
    source: Path | str,
    screenshot: Path | str | None = None,
    *,
    layer: str = "",
    depth: float | None = None,
    frame: float | None = None,
    camera: str | None = None,
    max_memory: float | None = None,
    size: tuple[int, int] = SIZE,
) -> None:
    """Show the cross-section of a stage's layer, or of a shape by its name, in a window with sliders.

    Args:
        source: a stage, or one of ``profiles.shape_names()``.
        screenshot: write this picture instead, without a display.
        layer: name of the stage's layer to begin with [the first]; depth: in widths, to begin with.
        frame, camera, max_memory: as ``scratchwarp.read`` has them.
        size: of the window in pixels.

    Raises:
        OSError: no display, no off-screen OpenGL, or the picture cannot be written.
        ValueError: the stage is at fault, it has no such layer, or a number is out of range.
    """
    if screenshot is not None:
        check_writable(Path(screenshot))
    choices, first = chosen(source, layer, frame=frame, camera=camera, max_memory=max_memory)
    if depth is not None:
        choices[first] = choices[first].turned({"depth": depth})
    with canvas(screenshot is not None, size) as plotter:
        live = LiveProfile(plotter, choices, first)
        if screenshot is None:
            live.connect()
            plotter.show(title=f"scratchwarp: {source}", auto_close=False)
        else:
            write(plotter, Path(screenshot))


def chosen(source: Path | str, layer: str = "", **reading: Any) -> tuple[list[CrossSection], int]:
    """The cross-sections of ``source``, read as ``scratchwarp.read`` does, and which of them is meant; ValueError when
    there is none."""
    if str(source) in profiles.shape_names():
        names = list(profiles.shape_names())
        return [cross_sections.of_shape(name) for name in names], names.index(str(source))
    import scratchwarp as sw

    scene = sw.read(str(source), **reading)
    found = cross_sections.of_scene(scene)
    if not found:
        raise ValueError(f"{source}: no material that is on something has a scratch layer")
    for i, item in enumerate(found):
        if layer in ("", item.title, item.title.rsplit(": ", 1)[-1]):
            return found, i
    raise ValueError(f"{source}: --profile {layer!r} is none of its layers: {', '.join(f.title for f in found)}")


def outline(profile: profiles.Profile) -> np.ndarray:
    """The profile [n, 2] with its surroundings, in widths: flat ground beside an isolated one, a neighbour on either
    side of a repeated one. The middle is at x = 0, the highest point at z = 0."""
    line = profile.polyline(4)
    line = line - (0.5 * (line[0, 0] + line[-1, 0]), profile.top)
    if profile.isolated:
        left, right, stub = line[0, 0], line[-1, 0], 0.125 * profile.period
        ground = np.array([[left - stub, 0.0], [left, 0.0], [right, 0.0], [right + stub, 0.0]]) - (0.0, profile.top)
        return np.concatenate((ground[:2], line, ground[2:]))
    return np.concatenate([line + (shift * profile.period, 0.0) for shift in (-1, 0, 1)])


class LiveProfile:
    """The window's content. ``set`` turns one number, simulates, and draws; sliders and keys come here, too.

    Attributes:
        section: the cross-section shown, with its numbers as they are turned.
        spent: what the last update took.
    """

    def __init__(
        self, plotter: Any, choices: list[CrossSection], first: int = 0, resolution: int = RESOLUTION, rays: int = RAYS
    ) -> None:
        self.plotter, self.choices, self.resolution, self.rays = plotter, choices, resolution, rays
        self.spent = Spent(0.0, 0.0)
        self.sliders: dict[str, Any] = {}
        self.section = choices[first]
        plotter.set_background(BACKGROUND)
        plotter.disable_anti_aliasing()  # eight samples a pixel would cost ten times the rest in software
        text = partial(plotter.add_text, viewport=True, color=TEXT)
        self._title = text("", position=(0.02, 0.95), font_size=8)
        self._status = text("the sliders simulate as they move", position=(0.51, 0.95), font_size=8)
        text("phi_i to the right, phi_o upwards; one bounce red, two green, more blue", position=_NOTE, font_size=6)
        self.sheet = Sheet(plotter, np.zeros((tables.SIDE, tables.SIDE, 3)), 0.0, 0.0, 1.0)
        self.line = Line(plotter, self.section.color, 3.0)
        look_at(plotter, 0.0, 2.12, -0.34, 1.14)
        self._index = first
        self._show(choices[first])

    def connect(self) -> None:
        """Bind the keys of ``scratchwarp.viewers.PROFILE_KEYS``; the mouse turns sliders only."""
        self.plotter.enable_image_style()
        self.plotter.add_key_event("n", self.next_choice)
        self.plotter.add_key_event("k", self.next_shape)
        self.plotter.add_key_event("g", self.repeat)

    def next_choice(self) -> None:
        """Show the next of the choices, as it was given."""
        self._index = (self._index + 1) % len(self.choices)
        self._show(self.choices[self._index])
        self._draw()

    def next_shape(self) -> None:
        """Show the next named shape at this depth."""
        names = profiles.shape_names()
        shape = self.section.record.shape
        name = names[(names.index(shape) + 1) % len(names)] if shape in names else names[0]
        self._show(cross_sections.of_shape(name, self.section.depth))
        self._draw()

    def repeat(self) -> None:
        """Repeat the profile for ever, or put it alone in flat ground."""
        self._show(self.section.repeated(not self.section.record.periodic))
        self._draw()

    def set_depth(self, value: float) -> None:
        """``set`` for the depth, in widths."""
        self.set("depth", value)

    def set(self, name: str, value: float) -> None:
        """Turn one number, simulate and draw; ValueError when it is none of ``section.knobs`` or out of range."""
        if name not in self.sliders:
            raise ValueError(f"{name!r} is no number of {self.section.title}, which has {', '.join(self.sliders)}")
        self._update(self.section.turned({name: value}))
        self.sliders[name].GetRepresentation().SetValue(value)
        self._draw()

    def settle(self) -> None:
        """Simulate what is shown with more rays; the window is not drawn yet."""
        self.table = self._simulated(self.profile, FINE * self.rays)
        self.sheet.paint(tables.bounces(self.table))

    def _show(self, section: CrossSection) -> None:
        self._update(section)
        self.settle()
        self.line.actor.prop.color = section.color
        self._make_sliders()

    def _update(self, section: CrossSection) -> None:
        """Simulate a cross-section and repaint what shows it; the window is not drawn yet."""
        start = perf_counter()
        profile = section.profile()
        table = self._simulated(profile, self.rays)
        middle = perf_counter()
        self.section, self.profile, self.table = section, profile, table
        self.sheet.paint(tables.bounces(table))
        self._paint_line()
        self._title.input = self._described()
        self.spent = Spent(middle - start, perf_counter() - middle)

    def _draw(self) -> None:
        """Draw the window and wait until it is drawn."""
        start = perf_counter()
        window = self.plotter.render_window
        window.Render()
        window.WaitForCompletion()
        self.spent = self.spent._replace(redraw=self.spent.redraw + perf_counter() - start)

    def _paint_line(self) -> None:
        line = outline(self.profile)
        scale = min((_RIGHT - _LEFT) / np.ptp(line[:, 0]), (_TOP - 0.05) / max(np.ptp(line[:, 1]), 1e-9))
        self.line.draw(scale * line + (0.5 * (_LEFT + _RIGHT), _TOP))

    def _described(self) -> str:
        kind = "repeated" if self.section.record.periodic else "alone"
        shape = self.section.record.shape
        name = shape if shape == self.section.title else f"{self.section.title} ({shape})"
        return f"{name}, {kind}, {self.resolution} x {self.resolution}"

    def _simulated(self, profile: profiles.Profile, rays: int) -> profiles.Table:
        return profiles.simulate(profile, resolution=self.resolution, rays=rays)

    def _make_sliders(self) -> None:
        self.plotter.clear_slider_widgets()
        self.sliders.clear()
        for place, knob in zip(PLACES, self.section.knobs, strict=False):
            turned = partial(self._turn, knob.name)
            self.sliders[knob.name] = slider(self.plotter, knob, place, turned, released=self.settle)

    def _turn(self, name: str, value: float) -> None:
        """A slider moved: VTK draws the window after this."""
        try:
            self._update(self.section.turned({name: value}))
        except ValueError as error:
            self._status.input = str(error)
            return
        drawn = max(self.plotter.renderer.GetLastRenderTimeInSeconds(), 0.0)  # the time before
        self._status.input = f"simulated in {1e3 * self.spent.simulation:.1f} ms, drawn in {1e3 * drawn:.1f} ms"
