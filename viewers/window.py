"""The window: meshes with directions and scratches, the rendered image, each layer's profile and table."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from scratchwarp.scene import Camera, Scene

from . import camera as camera_view
from . import curves, directions, image, meshes, profiles, tables
from .colors import BACKGROUND, TEXT, Shown, shown
from .cross_sections import Knob, rescratched
from .display import canvas, check_writable, write
from .eye import look_through
from .sheet import Sheet
from .sliders import slider

PAGE = 12  # layers that the plots show at once
DRAGGED_RAYS = 128  # for each direction of a table while its slider moves


def show(
    scene: Scene,
    screenshot: Path | str | None = None,
    *,
    width: int = 320,
    spp: int = 4,
    size: tuple[int, int] = (1600, 1000),
    page: int = 0,
) -> None:
    """Show a scene in a window, or write the picture of one to ``screenshot`` without a display; its image stays as it
    is first rendered until it is asked for again. See ``live_window.view``, whose arguments these are."""
    if screenshot is not None:
        check_writable(Path(screenshot))
    with canvas(screenshot is not None, size, (2, 2)) as plotter:
        window = Window(plotter, scene, width, spp, page)
        if screenshot is None:
            window.connect()
            plotter.show(title=f"scratchwarp: {scene.path}", auto_close=False)
        else:
            write(plotter, Path(screenshot))


class Window:
    """The four parts of the window and what its keys do."""

    def __init__(self, plotter: Any, scene: Scene, width: int, spp: int, page: int) -> None:
        self.plotter, self.scene, self.width, self.spp = plotter, scene, width, spp
        self.layers: list[Shown] = shown(scene)
        self.page = page % max(1, -(-len(self.layers) // PAGE))
        self.groups: dict[str, list[Any]] = {}
        self.plots: list[profiles.Plot] = []
        self.sheets: list[Sheet] = []
        self.chosen = 0
        for row, column in ((0, 0), (0, 1), (1, 0), (1, 1)):
            plotter.subplot(row, column)
            plotter.set_background(BACKGROUND)
        self._draw_scene()
        self._draw_image(self._rendered())
        self._draw_layers()

    def connect(self) -> None:
        """Bind the keys of ``scratchwarp.viewers.KEYS``."""
        for key, name in (("d", "directions"), ("c", "curves"), ("l", "camera")):
            self.plotter.add_key_event(key, lambda name=name: self.toggle(name))
        self.plotter.add_key_event("t", self.edges)
        self.plotter.add_key_event("n", self.next_page)
        self.plotter.add_key_event("m", self.next_layer)
        self.plotter.add_key_event("o", self.look_through)

    def toggle(self, name: str) -> None:
        """Show or hide a group: directions, curves or camera."""
        for actor in self.groups[name]:
            actor.SetVisibility(not actor.GetVisibility())
        self.plotter.render()

    def edges(self) -> None:
        """Show or hide the edges of triangles."""
        for actor in self.groups["meshes"]:
            actor.prop.show_edges = not actor.prop.show_edges
        self.plotter.render()

    def next_page(self) -> None:
        """Show the next layers in the plots."""
        self.page, self.chosen = (self.page + 1) % max(1, -(-len(self.layers) // PAGE)), 0
        self.plotter.subplot(1, 0)
        self.plotter.renderer.clear_actors()
        self.plotter.subplot(1, 1)
        self.plotter.renderer.clear_actors()
        self._draw_layers()
        self.plotter.render()

    def next_layer(self) -> None:
        """Let the depth slider move the next layer of those in the plots."""
        self.chosen = (self.chosen + 1) % max(1, len(self.plots))
        self._make_slider()
        self.plotter.render()

    def set_depth(self, depth: float) -> None:
        """Give the chosen layer another depth, in the unit of its width: simulate, repaint its plots and draw them."""
        if self.layers:
            self.slider.GetRepresentation().SetValue(depth)
            self._turn(depth)
            self.plotter.render_window.Render()

    def start_drag(self) -> None:
        """From now on draw the plots alone, one sample a pixel: in software the rest takes half a second."""
        window = self.plotter.render_window
        self._samples = window.GetMultiSamples()
        window.SetMultiSamples(0)
        window.Render()
        for renderer in self._still():
            renderer.DrawOff()

    def end_drag(self) -> None:
        """Draw everything again, the table with more rays."""
        for renderer in self._still():
            renderer.DrawOn()
        self.plotter.render_window.SetMultiSamples(self._samples)
        self.sheets[self.chosen].paint(tables.picture(self._item()))

    def _item(self) -> Shown:
        """The layer that the depth slider moves."""
        return self.layers[PAGE * self.page + self.chosen]

    def _still(self) -> list[Any]:
        """The parts that do not change while a slider moves."""
        return [self.plotter.renderers[0], self.plotter.renderers[1]]

    def _turn(self, depth: float) -> None:
        item = self._item()._replace(layer=replace(self._item().layer, depth=depth))
        self.layers[PAGE * self.page + self.chosen] = item
        self.plots[self.chosen].draw(item.layer)
        self.sheets[self.chosen].paint(tables.picture(item, rays=DRAGGED_RAYS))

    def look_through(self) -> None:
        """Put the window's eye where the stage's camera is."""
        self.plotter.subplot(0, 0)
        look_through(self.plotter, self.scene, self._pixels())
        self.plotter.render()

    def render_from_here(self) -> None:
        """Render again with a pinhole camera where the window's eye is."""
        matrix, seen = self.eye(), self.plotter.camera
        high = 2 * np.tan(np.radians(seen.view_angle) / 2)
        across = high * self._pixels()[0] / self._pixels()[1]
        self._draw_image(self._rendered(Camera("", matrix, across, high, focal_length=1.0)))
        self.plotter.render()

    def eye(self) -> np.ndarray:
        """Camera to world [4, 4] of the window's eye."""
        self.plotter.subplot(0, 0)
        seen = self.plotter.camera
        back = np.subtract(seen.position, seen.focal_point)
        back = back / np.linalg.norm(back)
        right = np.cross(seen.up, back)
        right = right / np.linalg.norm(right)
        matrix = np.eye(4)
        matrix[:3, 0], matrix[:3, 1], matrix[:3, 2], matrix[:3, 3] = right, np.cross(back, right), back, seen.position
        return matrix

    def _rendered(self, camera: Camera | None = None) -> np.ndarray:
        """The image with the layers as they are shown, [h, w, 3] in [0, 1]; ``camera``: instead of the stage's."""
        return image.picture(rescratched(self.scene, self.layers), self.width, self.spp, camera)

    def _pixels(self) -> tuple[int, int]:
        return self.scene.options.resolution or (640, 480)

    def _draw_scene(self) -> None:
        self.plotter.subplot(0, 0)
        wide, high = self._pixels()
        self.groups = {
            "meshes": meshes.add(self.plotter, self.scene),
            "directions": directions.add(self.plotter, self.scene),
            "curves": curves.add(self.plotter, self.scene),
            "camera": camera_view.add(self.plotter, self.scene, wide / high),
        }
        self._title(f"{Path(self.scene.path).name}: directions and scratches")
        self.look_through()

    def _draw_image(self, pixels: np.ndarray) -> None:
        self.plotter.subplot(0, 1)
        self.sheet = image.add(self.plotter, pixels)
        self._title(f"rendered, {self.spp} samples a pixel")

    def _draw_layers(self) -> None:
        items = self.layers[PAGE * self.page : PAGE * (self.page + 1)]
        more = f" ({self.page + 1} of {-(-len(self.layers) // PAGE)})" if len(self.layers) > PAGE else ""
        self.plotter.subplot(1, 0)
        self.plots = profiles.add(self.plotter, items)
        self._title(f"profiles{more}" if items else "no scratch layers")
        self._make_slider()
        self.plotter.subplot(1, 1)
        self.sheets = tables.add(self.plotter, items)
        self._title(f"tables, phi_i to the right, phi_o upwards{more}" if items else "")

    def _make_slider(self) -> None:
        self.plotter.subplot(1, 0)
        self.plotter.clear_slider_widgets()
        if self.plots:
            item = self._item()
            high = 2.0 * max(item.layer.width, item.layer.depth)
            knob = Knob(f"depth of {item.title}", 0.0, high, item.layer.depth)
            self.slider = slider(
                self.plotter, knob, ((0.03, 0.05), (0.47, 0.05)), self._turn,
                grabbed=self.start_drag, released=self.end_drag,
            )  # fmt: skip

    def _title(self, text: str) -> None:
        self.plotter.add_text(text, position=(0.01, 0.945), viewport=True, font_size=8, color=TEXT, name="title")
