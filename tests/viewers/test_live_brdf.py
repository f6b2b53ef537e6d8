"""A measured BRDF in the window: what is painted, what sliders change, and the picture that the command line writes."""

import gc
import weakref

import numpy as np
import pytest

from scratchwarp import measured, stencils
from scratchwarp.cli import main
from scratchwarp.reflectance.stencils import Mode, Model
from scratchwarp.viewers import display, live_brdf, lobes

pyvista = pytest.importorskip("pyvista")

MODEL = Model(
    (
        Mode(0.5, 0.7, 1.0, 0.0, 0.02, 0.3, 12.0, (0.3, 0.5, 0.9)),
        Mode(1.9, 0.6, 1.0, 0.0, 0.03, 0.2, 9.0, (0.9, 0.4, 0.2)),
    ),
    background=0.03,
)


@pytest.fixture(scope="module")
def brdf():
    return measured.Brdf.from_values(stencils.unfolded(MODEL))


@pytest.fixture
def live(brdf):
    with display.canvas(True, (400, 240), (1, 2)) as plotter:
        yield live_brdf.LiveBrdf(plotter, brdf, MODEL)


def test_the_model_lies_on_its_measurement(live):
    """Pictures agree to a step of 8 bits, their difference is black, and so do the lobes where the grid is."""
    first, second, off = (sheet.pixels.astype(int) for sheet in live.sheets)
    assert np.abs(first - second).max() <= 1 and first.std() > 20
    inner = np.delete(np.delete(off, np.arange(0, 295, 49), 0), np.arange(0, 295, 49), 1)
    assert inner.max() < 10
    one, other = (live.lobes[name].points for name in ("measurement", "model"))
    # between its nodes a measurement is interpolated: ridges are cut by a few per cent
    assert np.linalg.norm(one, axis=-1).max() == pytest.approx(1.0, abs=1e-5)
    assert np.median(np.linalg.norm(one - other, axis=-1)) < 0.03


def test_lobes_point_where_light_goes():
    """A lobe at one direction, seen where it is."""

    def evaluate(wi, wo):
        near = np.sum(wo * np.array([np.sin(0.6), 0.0, np.cos(0.6)]), axis=-1) > 0.99
        return np.where(near, 1.0, 0.0)[..., None] * np.ones(3) * wi[..., 2:]

    points = lobes.lobe_points(evaluate, np.array([0.0, 0.0, 1.0]))
    far = points[np.argmax(np.linalg.norm(points, axis=-1))]
    assert np.arctan2(far[0], far[2]) == pytest.approx(0.6, abs=0.15) and abs(far[1]) < 0.15
    dark = lobes.lobe_points(lambda wi, wo: np.zeros(wo.shape), np.array([0.0, 0.0, 1.0]))
    assert not dark.any()


def test_sliders_edit_the_model(live):
    """The mode that is turned and no other; the light moves the lobes alone."""
    before = [sheet.pixels for sheet in live.sheets]
    shape = live.lobes["model"].points
    live.set("axis", 60.0)
    assert live.model == MODEL.edit(0, azimuth=np.radians(60.0))
    assert [(sheet.pixels != old).any() for sheet, old in zip(live.sheets, before, strict=True)] == [False, True, True]
    assert np.abs(live.lobes["model"].points - shape).max() > 0.05
    live.next_mode()
    live.set("alpha", 30.0)
    assert live.model.modes[1].alpha == 30.0 and live.model.modes[0].alpha == MODEL.modes[0].alpha
    assert "mode 2 of 2" in live._note.input
    kept, wires = live.sheets[1].pixels, live.lobes["measurement"].points
    live.set("light", 10.0)
    assert np.array_equal(live.sheets[1].pixels, kept)
    assert np.abs(live.lobes["measurement"].points - wires).max() > 0.05
    live.restore()
    assert live.model == MODEL and live.sliders["alpha"].GetRepresentation().GetValue() == pytest.approx(9.0)
    live.toggle("model")
    assert not live.lobes["model"].actor.GetVisibility()
    for name, value in (("colour", 1.0), ("width", 2.0)):
        with pytest.raises(ValueError, match=name):
            live.set(name, value)
    assert live.model == MODEL


def test_a_screenshot_from_the_command_line(brdf, tmp_path, monkeypatch, capsys):
    monkeypatch.delenv("DISPLAY", raising=False)
    path = tmp_path / "made.bin"
    measured.save_utia(path, brdf)
    assert main(["view", str(path), "--screenshot", str(tmp_path / "look.png")]) == 0
    pixels = pyvista.read(tmp_path / "look.png").active_scalars.reshape(720, 1200, -1)[..., :3].astype(float)
    for part in (pixels[360:, :300], pixels[360:, 300:600], pixels[200:, 600:], pixels[:150, :600]):
        assert (np.abs(part - part[0, 0]).max(-1) > 30).mean() > 0.01
    assert main(["view", str(path), "--depth", "1"]) == 2
    (tmp_path / "cut.bin").write_bytes(path.read_bytes()[:99])
    assert main(["view", str(tmp_path / "cut.bin"), "--screenshot", str(tmp_path / "no.png")]) == 1
    assert "99 bytes" in capsys.readouterr().err and not (tmp_path / "no.png").exists()


def test_nothing_is_left_when_the_window_closes(brdf):
    left = []
    with display.canvas(True, (64, 48), (1, 2)) as plotter:
        made = live_brdf.LiveBrdf(plotter, brdf, MODEL)
        made.connect()
        left += [weakref.ref(made), weakref.ref(plotter)]
    del made, plotter
    gc.collect()
    assert [ref() for ref in left] == [None, None]
