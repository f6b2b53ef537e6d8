"""A measured BRDF beside the stencils fitted to it: unfolded pictures, lobes in 3D, sliders for the modes."""

from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from scratchwarp import measured, stencils
from scratchwarp.study import fit_pictures

from .colors import BACKGROUND, PALETTE, TEXT
from .cross_sections import Knob
from .display import canvas, check_writable, write
from .lobes import LobeSurface, lobe_points
from .marks import look_at, word
from .sheet import Sheet
from .sliders import slider

SIZE = (1200, 720)
TITLES = ("measurement", "model", f"difference, {fit_pictures.DIFFERENCE:g} times")
LIGHT = 45.0  # degrees from the normal, of the lobes at first
# Left and right end of each slider in the window: in the left half, two rows of four.
_PLACES = [((0.02 + 0.122 * i, y), (0.112 + 0.122 * i, y)) for y in (0.17, 0.06) for i in range(4)]


def view(
    source: Path | str,
    screenshot: Path | str | None = None,
    *,
    modes: int | None = None,
    refine: bool = True,
    size: tuple[int, int] = SIZE,
) -> None:
    """Show the file of a measurement with the model fitted to it, or write a picture to ``screenshot``.

    ``modes``, ``refine``: as ``stencils.fit`` has them; without scipy the direct fit is shown. ``size``: of the window
    in pixels. Raises OSError without a display, off-screen OpenGL or a file that can be read or written, ValueError on
    a damaged file.
    """
    if screenshot is not None:
        check_writable(Path(screenshot))
    brdf = measured.load(source)
    try:
        model = stencils.fit(brdf, modes, refine=refine)
    except ImportError:
        model = stencils.fit(brdf, modes, refine=False)
    with canvas(screenshot is not None, size, (1, 2)) as plotter:
        live = LiveBrdf(plotter, brdf, model)
        if screenshot is None:
            live.connect()
            plotter.show(title=f"scratchwarp: {source}", auto_close=False)
        else:
            write(plotter, Path(screenshot))


class LiveBrdf:
    """The window's content: left the pictures, right the lobes. ``set`` turns one number; sliders and keys come here.

    Attributes:
        model: what is shown, edited as sliders turn. mode: which of its modes they turn.
        light: degrees of the light from the normal, and its azimuth, for the lobes.
    """

    def __init__(self, plotter: Any, brdf: measured.Brdf, model: stencils.Model) -> None:
        self.plotter, self.brdf, self.fitted, self.model = plotter, brdf, model, model
        self.mode, self.light = 0, (LIGHT, 0.0)
        self.sliders: dict[str, Any] = {}
        self.values = np.maximum(np.asarray(brdf, np.float64), 0.0)
        self.white = fit_pictures.white(self.values)
        plotter.disable_anti_aliasing()
        plotter.subplot(0, 0)
        plotter.set_background(BACKGROUND)
        blank = _pixels(self.values, self.white)
        self.sheets = [Sheet(plotter, blank, 1.06 * (i % 2), -1.14 * (i // 2), 1.0) for i in range(3)]
        for i, title in enumerate(TITLES):
            word(plotter, title, 1.06 * (i % 2) + 0.5, -1.14 * (i // 2) + 1.05)
        self._note = word(plotter, "", 1.56, -0.55)
        look_at(plotter, -0.02, 2.08, -1.95, 1.12)
        plotter.subplot(0, 1)
        plotter.set_background(BACKGROUND)
        look = {"opacity": 0.35, "smooth_shading": True}
        self.lobes = {
            "measurement": LobeSurface(plotter, TEXT, style="wireframe", lighting=False, line_width=1),
            "model": LobeSurface(plotter, PALETTE[0], **look),
        }
        self._title = plotter.add_text("", position=(0.02, 0.94), viewport=True, color=TEXT, font_size=8)
        self._update()
        self._look()
        self._make_sliders()

    def connect(self) -> None:
        """Bind the keys of ``scratchwarp.viewers.BRDF_KEYS``."""
        self.plotter.add_key_event("n", self.next_mode)
        self.plotter.add_key_event("r", self.restore)
        self.plotter.add_key_event("b", partial(self.toggle, "measurement"))
        self.plotter.add_key_event("m", partial(self.toggle, "model"))

    @property
    def knobs(self) -> tuple[Knob, ...]:
        """The numbers of the mode and the direction of the light."""
        mode = self.model.modes[self.mode]
        most = max(4.0 * mode.ks, 4.0 * abs(mode.kd), 1e-6)
        return (
            Knob("axis", 0.0, 180.0, float(np.degrees(mode.azimuth) % 180.0)),
            Knob("width", 0.0, 1.0, mode.width),
            Knob("b", min(-0.05, mode.b), max(0.2, 2.0 * mode.b), mode.b),
            Knob("alpha", 0.0, max(100.0, 2.0 * mode.alpha), mode.alpha),
            Knob("kd", min(0.0, mode.kd), most, mode.kd),
            Knob("ks", min(0.0, mode.ks), most, mode.ks),
            Knob("light", 0.0, 75.0, self.light[0]),
            Knob("turn", 0.0, 360.0, self.light[1]),
        )

    def set(self, name: str, value: float) -> None:
        """Turn one number and draw; ValueError when there is none of that name or it is out of range."""
        if name not in self.sliders:
            raise ValueError(f"{name!r} is no number of a mode, which has {', '.join(self.sliders)}")
        self._apply(name, value)
        self.sliders[name].GetRepresentation().SetValue(value)
        self.plotter.render_window.Render()

    def next_mode(self) -> None:
        """Let the sliders turn the next mode."""
        self.mode = (self.mode + 1) % len(self.model.modes)
        self._update()
        self._make_sliders()
        self.plotter.render_window.Render()

    def restore(self) -> None:
        """Show the fitted model again."""
        self.model = self.fitted
        self._update()
        self._make_sliders()
        self.plotter.render_window.Render()

    def toggle(self, name: str) -> None:
        """Show or hide the lobe of the measurement or of the model."""
        actor = self.lobes[name].actor
        actor.SetVisibility(not actor.GetVisibility())
        self.plotter.render_window.Render()

    def _apply(self, name: str, value: float) -> None:
        if name == "light":
            self.light = (value, self.light[1])
        elif name == "turn":
            self.light = (self.light[0], value)
        elif name == "axis":
            self.model = self.model.edit(self.mode, azimuth=float(np.radians(value)))
        else:
            self.model = self.model.edit(self.mode, **{name: value})
        self._update(name in ("light", "turn"))

    def _turn(self, name: str, value: float) -> None:
        """A slider moved: VTK draws the window after this."""
        self._apply(name, value)

    def _update(self, lobes_only: bool = False) -> None:
        theta, phi = np.radians(self.light)
        wi = np.array([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)])
        for name, evaluate in (("measurement", self.brdf.evaluate), ("model", partial(stencils.evaluate, self.model))):
            points = lobe_points(evaluate, wi)
            if name == "measurement":
                self.scale = 1.0 / max(float(np.linalg.norm(points, axis=-1).max()), 1e-9)
            self.lobes[name].draw(points * self.scale)
        if lobes_only:
            return
        shown = stencils.unfolded(self.model)
        self.sheets[0].paint(_pixels(self.values, self.white))
        self.sheets[1].paint(_pixels(shown, self.white))
        self.sheets[2].paint(_pixels(fit_pictures.DIFFERENCE * np.abs(shown - self.values), self.white))
        off = measured.compare(self.values, shown)
        color = self.model.modes[self.mode].color
        self._note.input = (
            f"PSNR {off['psnr']:.1f} dB\nSSIM {off['ssim']:.3f}\nDelta E {off['delta_e']:.2f}\n\n"
            f"mode {self.mode + 1} of {len(self.model.modes)}\ncolour {', '.join(f'{c:.2f}' for c in color)}"
        )
        self._title.input = "lobes: measurement (grid), model (solid); cube root of f cos"

    def _look(self) -> None:
        self.plotter.camera_position = [(2.6, -2.6, 1.8), (0.0, 0.0, 0.25), (0.0, 0.0, 1.0)]
        self.plotter.renderer.reset_camera_clipping_range()

    def _make_sliders(self) -> None:
        self.plotter.clear_slider_widgets()
        self.sliders.clear()
        self.plotter.subplot(0, 0)
        for place, knob in zip(_PLACES, self.knobs, strict=True):
            self.sliders[knob.name] = slider(self.plotter, knob, place, partial(self._turn, knob.name))


def _pixels(values: np.ndarray, white: float) -> np.ndarray:
    """Unfolded, [294 + 1, 294 + 1, 3] in [0, 1] through the sRGB curve."""
    linear = fit_pictures.unfolded(values, white, scale=1).astype(float)
    return np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * np.maximum(linear, 0.0031308) ** (1 / 2.4) - 0.055)
