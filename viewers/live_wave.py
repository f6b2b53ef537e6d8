"""How one fine scratch diffracts, live: its radiance over the hemisphere of viewers; sliders for it and the light."""

from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from scratchwarp import diffraction
from scratchwarp.reflectance.diffraction.color import spectral_samples

from .colors import BACKGROUND, TEXT
from .cross_sections import Knob
from .display import canvas, check_writable, write
from .live_profile import PLACES
from .marks import look_at
from .sheet import Sheet
from .sliders import slider

SIZE = (760, 860)
PIXELS = 240
WAVES = 16

KNOBS = (
    Knob("width [um]", 0.3, 8.0, 3.0),
    Knob("depth [um]", 0.0, 6.0, 1.2),
    Knob("coherence [um]", 3.0, 60.0, 20.0),
    Knob("light: elevation", 5.0, 90.0, 65.0),
    Knob("light: azimuth", 0.0, 360.0, 20.0),
    Knob("light: radius", 0.2, 30.0, 2.0),
)
"""Numbers that can be turned: of the scratch, and of a spherical light in degrees; azimuth 0 is across the scratch."""


def view(screenshot: Path | str | None = None, *, size: tuple[int, int] = SIZE) -> None:
    """Show the lobe of one scratch in a window with sliders, or write the picture of one to ``screenshot``.

    Raises:
        OSError: no display, no off-screen OpenGL, or the picture cannot be written.
        ValueError: the screenshot's suffix is none of a picture.
    """
    if screenshot is not None:
        check_writable(Path(screenshot))
    with canvas(screenshot is not None, size) as plotter:
        live = LiveWave(plotter)
        if screenshot is None:
            live.connect()
            plotter.show(title="scratchwarp: one scratch that diffracts", auto_close=False)
        else:
            write(plotter, Path(screenshot))


def lobe(numbers: dict[str, float], pixels: int = PIXELS) -> np.ndarray:
    """Linear Rec.709 ``[pixels, pixels, 3]`` of the radiance towards all viewers above, seen from above: the direction
    cosine across the scratch runs to the right, along it upwards. ``numbers``: a value for each of ``KNOBS``; the light
    has radiance 1 at all wavelengths. 0 beyond the horizon."""
    step = (np.arange(pixels) + 0.5) / pixels * 2.0 - 1.0
    across, along = np.meshgrid(step, -step)
    up = 1.0 - across**2 - along**2
    up_angle, turn, radius = (np.radians(numbers[knob.name]) for knob in KNOBS[3:])
    light = np.array([np.cos(up_angle) * np.sin(turn), np.cos(up_angle) * np.cos(turn), np.sin(up_angle)])
    width, depth, sigma = (numbers[knob.name] for knob in KNOBS[:3])
    at, weights = spectral_samples(WAVES)
    # beyond this the Gaussian along the scratch has gone
    near = (up > 1e-4) & (np.abs(along + light[0]) < np.sin(radius) + 4.0 * at.max() * 1e-3 / (2.0 * np.pi * sigma))
    image = np.zeros((pixels, pixels, 3))
    if near.any():
        # u = +x runs along the scratch, v = +y across
        viewers = np.stack([along[near], across[near], np.sqrt(up[near])], axis=-1)[:, None]
        scratch = diffraction.Scratch(width, depth, coherence_radius=sigma)
        values = diffraction.radiance(diffraction.SphereLight(light, np.sin(radius)), viewers, scratch, at)
        image[near] = values @ weights
    return image


def shown(image: np.ndarray) -> np.ndarray:
    """Colours in [0, 1] for the screen: the brightest 2 % white, the square root above, the horizon as a disk."""
    pixels = len(image)
    bright = image.max(axis=-1)
    white = max(float(np.quantile(bright[bright > 0.0], 0.98)) if (bright > 0.0).any() else 0.0, 1e-12)
    step = (np.arange(pixels) + 0.5) / pixels * 2.0 - 1.0
    sky = (np.hypot(*np.meshgrid(step, step)) < 1.0)[..., None] * 0.06
    return np.clip(sky + np.sqrt(np.clip(image / white, 0.0, 1.0)), 0.0, 1.0) + 0.02


class LiveWave:
    """The window's content: ``set`` turns one number and repaints; sliders come here, too.

    Attributes:
        numbers: what is shown, by the names of ``KNOBS``.
        image: linear radiance, as ``lobe`` has it.
    """

    def __init__(self, plotter: Any, pixels: int = PIXELS) -> None:
        self.plotter, self.pixels = plotter, pixels
        self.numbers = {knob.name: knob.value for knob in KNOBS}
        plotter.set_background(BACKGROUND)
        plotter.disable_anti_aliasing()
        text = partial(plotter.add_text, viewport=True, color=TEXT)
        self._title = text("", position=(0.02, 0.955), font_size=8)
        text("viewers seen from above; the scratch runs upwards", position=(0.02, 0.93), font_size=6)
        self.image = lobe(self.numbers, pixels)
        self.sheet = Sheet(plotter, shown(self.image), 0.0, 0.0, 1.0)
        look_at(plotter, -0.02, 1.02, -0.34, 1.12)
        self.sliders = {
            knob.name: slider(plotter, knob, place, partial(self._turn, knob.name))
            for place, knob in zip(PLACES, KNOBS, strict=True)
        }
        self._tell()

    def connect(self) -> None:
        """The mouse turns sliders only."""
        self.plotter.enable_image_style()

    def set(self, name: str, value: float) -> None:
        """Turn one number and repaint; ValueError when there is none of this name."""
        if name not in self.numbers:
            raise ValueError(f"{name!r} is none of {', '.join(self.numbers)}")
        self._turn(name, value)
        self.sliders[name].GetRepresentation().SetValue(value)
        self.plotter.render_window.Render()

    def _turn(self, name: str, value: float) -> None:
        self.numbers[name] = value
        self.image = lobe(self.numbers, self.pixels)
        self.sheet.paint(shown(self.image))
        self._tell()

    def _tell(self) -> None:
        width, depth = (self.numbers[knob.name] for knob in KNOBS[:2])
        self._title.input = f"one scratch, {width:.2f} um wide, {depth:.2f} um deep"
