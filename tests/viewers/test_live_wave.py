"""The lobe of one scratch: where it is bright, what the sliders do, and that a picture is written."""

import numpy as np
import pytest

from scratchwarp.viewers import display, live_wave

pyvista = pytest.importorskip("pyvista")
START = {knob.name: knob.value for knob in live_wave.KNOBS}


def test_the_lobe_is_the_line_of_mirrored_directions_along_the_scratch():
    """Bright where the direction cosine along the scratch is minus the light's, within its radius; its fringes across
    are symmetric about the mirror direction and lambda / width apart; nothing beyond the horizon."""
    pixels = 200
    numbers = {**START, "width [um]": 2.0, "light: radius": 1.0, "light: azimuth": 0.0, "light: elevation": 90.0}
    image = live_wave.lobe(numbers, pixels)
    rows = np.flatnonzero(image.max(axis=(1, 2)) > 1e-3 * image.max())
    step = (np.arange(pixels) + 0.5) / pixels * 2.0 - 1.0
    assert np.abs(step[rows]).max() < np.sin(np.radians(1.0)) + 0.03
    assert np.allclose(image, image[:, ::-1], rtol=1e-6, atol=1e-12)
    assert not image[np.hypot(*np.meshgrid(step, step)) > 1.0].any()
    # half a turn of the light moves the line to the other side
    moved = live_wave.lobe({**numbers, "light: azimuth": 90.0, "light: elevation": 60.0}, pixels)
    row = np.average(-step, weights=moved.sum(axis=(1, 2)))
    assert row == pytest.approx(-0.5, abs=0.02)


def test_sliders_repaint_in_place():
    with display.canvas(True, (200, 240)) as plotter:
        live = live_wave.LiveWave(plotter, 48)
        before, actors = live.sheet.pixels, set(plotter.actors)
        live.set("width [um]", 1.0)
        assert (live.sheet.pixels != before).any() and set(plotter.actors) == actors
        live.set("depth [um]", 0.0)
        assert not live.image.any()
        with pytest.raises(ValueError, match="height"):
            live.set("height", 1.0)


def test_a_picture_without_a_display(tmp_path):
    live_wave.view(tmp_path / "lobe.png", size=(240, 270))
    assert (tmp_path / "lobe.png").stat().st_size > 2000
