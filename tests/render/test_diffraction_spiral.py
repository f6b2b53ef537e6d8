"""The rainbow of a compact disc, measured from rendered images."""

import numpy as np
import pytest

import scratchwarp as sw
from scratchwarp.reflectance.diffraction.color import spectral_samples
from scratchwarp.scene import SphereLight, Wave

from . import scenes
from .test_diffraction import COMPILED, LUMINANCE, straight_down, waves

HEIGHT, PITCH, DEPTH, SIZE, PIXELS = 0.1, 1.6, 0.12, 0.12, 96


def disc(wave):
    """A spiral of 1.6 um pitch seen from straight above, a light of 1 mm straight above its middle."""
    fields = {"distribution": "spiral", "curves": (), "pitch": PITCH, "width": 0.6, "depth": DEPTH, "wave": wave}
    light = SphereLight(path="/l", radiance=np.full(3, 1e3), center=np.array([0.0, 0.0, HEIGHT - 1.0]), radius=0.001)
    world = scenes.scene(
        [scenes.plane(SIZE)], [waves(**fields)], [light], [scenes.place(0, 0, (0, 0, -1))], straight_down(SIZE)
    )
    asked = sw.Settings(width=PIXELS, height=PIXELS, spp=4, filter="box", effects=COMPILED)
    return sw.render(world, sw.make_plan(world, asked))["scratches"].astype(float)


def radii():
    """Distance of each pixel from the middle [m]."""
    step = ((np.arange(PIXELS) + 0.5) / PIXELS - 0.5) * SIZE
    return np.hypot(*np.meshgrid(step, step))


def test_rings_of_a_spiral():
    """xi_1 = 0 everywhere, so that wavelength lambda returns from the ring sin(theta_i) = lambda / pitch. What a pixel
    receives there is the spectrum's density times the light's extent in xi_2, which falls with cos^2: the mean of
    lambda, by the measured luminance over the rings, within 2 % of what it is by the observer and |D|^2; red and green
    the same."""
    image = disc(Wave(coherence_radius=60.0, summation="coherent"))
    r = radii()
    sine = r / np.hypot(r, HEIGHT)
    at = np.arange(380.0, 781.0)
    _, weights = spectral_samples(at)
    strength = np.sin(2 * np.pi * DEPTH / (at * 1e-3)) ** 2
    band = (sine * PITCH > 0.38) & (sine * PITCH < 0.78)
    # of the area to one of xi_2, and without the falling extent
    flat = np.where(band, np.sqrt(1.0 - sine**2) / r, 0.0)
    found = [1e3 * PITCH * (flat * part * sine).sum() / (flat * part).sum() for part in _parts(image)]
    known = [(at * strength * part).sum() / (strength * part).sum() for part in _parts(weights)]
    # luminance, red, green; what lies outside the gamut is brought in, mostly into blue
    assert found[:3] == pytest.approx(known[:3], rel=0.02)
    assert found[3] < 500.0 < found[2] < found[1]


def _parts(colors):
    """Luminance, red, green and blue, the latter without what lies outside the gamut."""
    return [colors @ LUMINANCE, *(np.maximum(colors[..., c], 0.0) for c in range(3))]
