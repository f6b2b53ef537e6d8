"""The window on a stage whose image refines while sliders and the camera are dragged."""

from collections.abc import Mapping
from dataclasses import replace
from functools import partial
from math import radians
from pathlib import Path
from typing import Any

import numpy as np

from scratchwarp.pipeline import read_live
from scratchwarp.scene import Camera, Control, Settings

from .colors import Shown
from .cross_sections import Knob
from .display import canvas, check_writable, write
from .image import enlarged
from .looking import Looking
from .overlay import Overlay
from .sliders import slider
from .turning import Move
from .window import PAGE, Window

MOST_TOLD = 100  # characters of the line above the image
TICK = 40  # milliseconds between looks for a better image
# What a layer can be made of by a key: values of its attributes material, metal and fresnelModel.
MADE_OF: tuple[dict[str, str], ...] = (
    {"material": "inherit", "fresnelModel": "exact"},
    {"material": "inherit", "fresnelModel": "schlick"},
    {"material": "inherit", "fresnelModel": "mirror"},
    *({"material": "conductor", "metal": metal, "fresnelModel": "exact"} for metal in ("gold", "copper", "iron")),
    {"material": "dielectric", "fresnelModel": "exact"},
    {"material": "diffuse"},
)
SHAPES = ("vGroove", "round", "quartic", "gaussian", "sine", "rectangle", "trapezoid")


def view(
    stage_path: Path | str,
    screenshot: Path | str | None = None,
    *,
    frame: float | None = None,
    camera: str | None = None,
    max_memory: float | None = None,
    width: int = 320,
    spp: int = 4,
    size: tuple[int, int] = (1600, 1000),
    page: int = 0,
) -> None:
    """Show a stage in a window, or write the picture of one, with its image finished, to ``screenshot`` without a
    display.

    Args:
        frame, camera, max_memory: as ``scratchwarp.read`` has them.
        width, spp: of the rendered image, in pixels and samples a pixel.
        size: of the window in pixels.
        page: which dozen of layers the plots show first.

    Raises:
        OSError: no display, no off-screen OpenGL, or the picture cannot be written.
        ValueError: the stage is at fault.
    """
    if screenshot is not None:
        check_writable(Path(screenshot))
    live = read_live(stage_path, camera=camera, frame=frame, max_memory=max_memory)
    with (
        canvas(screenshot is not None, size, (2, 2)) as plotter,
        Looking(live, Settings(width=width, spp=spp)) as looking,
    ):
        window = LiveWindow(plotter, looking, page)
        if screenshot is None:
            window.connect()
            plotter.show(title=f"scratchwarp: {live.path}", auto_close=False)
        else:
            looking.finished()
            window.tick()
            write(plotter, Path(screenshot))


class LiveWindow(Window):
    """A window whose image follows: what is turned is an edit of the stage, and ``tick`` paints what there is."""

    def __init__(self, plotter: Any, looking: Looking, page: int = 0) -> None:
        self.looking = looking
        self.told: str = ""
        self._painted = -1
        self._light = self._made_of = self._shape = 0
        self._turned: dict[str, float] = {}
        first = looking.wait(0)
        while not first.picture:
            first = looking.wait(first.version)
        scene = looking.do(lambda live, session: session.scene)
        super().__init__(plotter, scene, first.size[0], first.spp, page)
        plotter.subplot(0, 0)
        self.overlay = Overlay(plotter)
        self._eye = self.eye()
        self.tick()

    def connect(self) -> None:
        """Bind keys, the mouse and the clock."""
        super().connect()
        for key, action in (
            ("x", self.switch_layer), ("y", self.cut_later), ("h", self.next_made_of), ("g", self.next_shape),
            ("b", self.next_light), ("k", self.toggle_overlay), ("z", self.save),
        ):  # fmt: skip
            self.plotter.add_key_event(key, action)
        interactor = self.plotter.iren
        interactor.add_observer("TimerEvent", lambda *_: self.tick())
        interactor.initialize()
        interactor.create_timer(TICK, repeating=True)

    def tick(self) -> None:
        """Let the image follow the window's eye, and paint it as good as it is now; the window is drawn if that is
        another one."""
        eye = self.eye()
        if not np.allclose(eye, self._eye, rtol=0.0, atol=1e-7 * (1.0 + np.abs(eye[:3, 3]).max())):
            self._eye = eye
            self.looking.place("", eye)
        now = self.looking.wait(0, 0.0)
        said = now.message or f"{now.samples} of {now.spp} samples; redone: {now.redone}"
        if now.picture == self._painted and said == self.told:
            return
        self._painted, self.told = now.picture, said
        self.sheet.paint(enlarged(now.pixels, self._size()) / 255.0)
        self.overlay.paint(now.pixels)
        self.plotter.subplot(0, 1)
        self._title(self.told if len(self.told) <= MOST_TOLD else f"{self.told[:MOST_TOLD]} ...")
        self.plotter.render_window.Render()

    def edit(self, name: str, value: Any) -> None:
        """Give an attribute of the chosen layer another value, in the image and in the plots."""
        self.looking.edit({f"{self._layer_path()}:{name}": value})

    def render_from_here(self) -> None:
        """Nothing to do: the image follows the window's eye."""

    def switch_layer(self) -> None:
        """Leave the chosen layer out of the image, or take it in again."""
        self.edit("enabled", not self._value("enabled"))

    def cut_later(self) -> None:
        """Let the chosen layer cut through those that were cut after it."""
        prim = self._item().layer.prim
        orders = [c.value for c in self._controls().values() if c.id.startswith(prim) and c.id.endswith(":order")]
        self.edit("order", max(orders) + 1)

    def next_made_of(self) -> None:
        """Make the chosen layer's scratches of the next material, or of the base's by another Fresnel model."""
        self._made_of = (self._made_of + 1) % len(MADE_OF)
        for name, value in MADE_OF[self._made_of].items():
            self.edit(name, value)

    def next_shape(self) -> None:
        """Give the chosen layer's profile the next shape."""
        self._shape = (self._shape + 1) % len(SHAPES)
        profile = replace(self._item().layer.profile, shape=SHAPES[self._shape])
        self.looking.edit({f"{profile.path}.scratch:shape": profile.shape})
        self._replace(replace(self._item().layer, profile=profile))
        self.plotter.render()

    def next_light(self) -> None:
        """Let the sliders move the next light."""
        self._light = (self._light + 1) % max(1, len(self._lights()))
        self._make_slider()
        self.plotter.render()

    def toggle_overlay(self) -> None:
        """Lay the image over the 3D view, or take it away."""
        self.overlay.show(not self.overlay.visible)
        self.plotter.render()

    def save(self) -> None:
        """Write the edits beside the stage, as a USD layer over it."""
        target = Path(self.looking.stage).with_suffix(".look.usda")
        self.looking.do(lambda live, session: live.save(target))
        self.plotter.subplot(0, 1)
        self._title(f"saved {target}")

    def start_drag(self) -> None:
        """As for any window, but the image is drawn too."""
        super().start_drag()
        self.plotter.renderers[1].DrawOn()

    def _draw_image(self, pixels: np.ndarray) -> None:
        super()._draw_image(pixels)
        seen = self.plotter.camera  # a strip below for the sliders
        lower = 0.14 * seen.parallel_scale
        seen.parallel_scale += lower
        for name in ("position", "focal_point"):
            x, y, z = getattr(seen, name)
            setattr(seen, name, (x, y - lower, z))

    def _rendered(self, camera: Camera | None = None) -> np.ndarray:
        return enlarged(self.looking.shown.pixels, self._size()) / 255.0

    def _size(self) -> tuple[int, int]:
        return self.looking.shown.size

    def _turn(self, depth: float) -> None:
        super()._turn(depth)
        self.edit("depth", depth)

    def _turn_layer(self, field: str, value: float) -> None:
        self.edit(field, value)
        changed: dict[str, Any] = {field: radians(value) if field == "angle" else value}
        self._replace(replace(self._item().layer, **changed))

    def _replace(self, layer: Any) -> None:
        """Show the chosen layer as it is now in its plots."""
        item: Shown = self._item()._replace(layer=layer)
        self.layers[PAGE * self.page + self.chosen] = item
        self.plots[self.chosen].draw(item.layer)

    def _turn_light(self, name: str, value: float) -> None:
        light = self._lights()[self._light]
        if name == "intensity":
            self.looking.edit({f"{light}.inputs:intensity": value})
            return
        before = self._turned.get(f"{light} {name}", 0.0)
        self._turned[f"{light} {name}"] = value
        self.looking.move(light, Move(**{name: radians(value - before)}))

    def _make_slider(self) -> None:
        super()._make_slider()
        for column, knobs in enumerate((self._light_knobs(), self._layer_knobs())):
            self.plotter.subplot(0, column)
            for i, (knob, turned) in enumerate(knobs):
                x = 0.02 + 0.16 * i  # from the corner of the part
                slider(self.plotter, knob, ((x, 0.045), (x + 0.13, 0.045)), turned)

    def _light_knobs(self) -> list[tuple[Knob, Any]]:
        lights = self._lights()
        if not lights:
            return []
        light = lights[self._light]
        name, known = light.rsplit("/", 1)[-1], self._controls()[f"{light}.inputs:intensity"].value
        knobs = [(Knob(f"{name} intensity", 0.0, 4.0 * known or 1.0, known), partial(self._turn_light, "intensity"))]
        for title, way, reach in (("around", "right", 180.0), ("height", "up", 90.0)):
            there = self._turned.get(f"{light} {way}", 0.0)
            knobs.append((Knob(f"{name} {title}", -reach, reach, there), partial(self._turn_light, way)))
        return knobs

    def _layer_knobs(self) -> list[tuple[Knob, Any]]:
        if not self.plots:
            return []
        knobs = []
        for name, low, high in (("width", 0.1, 4.0), ("coverage", None, None), ("angle", None, None)):
            control = self._controls()[f"{self._layer_path()}:{name}"]
            least = control.low if low is None else low * control.value
            most = control.high if high is None else high * control.value
            knobs.append((Knob(name, least, most, control.value), partial(self._turn_layer, name)))
        return knobs

    def _lights(self) -> list[str]:
        return list(dict.fromkeys(c.owner for c in self.looking.shown.controls if c.section == "light"))

    def _controls(self) -> Mapping[str, Control]:
        return {c.id: c for c in self.looking.shown.controls}

    def _layer_path(self) -> str:
        layer = self._item().layer
        return f"{layer.prim}.scratch:layer:{layer.name}"

    def _value(self, name: str) -> Any:
        return self._controls()[f"{self._layer_path()}:{name}"].value
