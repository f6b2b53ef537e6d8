"""The window whose image follows, off-screen: sliders, keys and the eye edit the stage, and the picture changes."""

import numpy as np
import pytest

import scratchwarp as sw
from scratchwarp.image.quick import eight_bit
from scratchwarp.scene import Settings
from scratchwarp.stage import LiveStage, read
from scratchwarp.viewers import display, live_window
from scratchwarp.viewers.looking import Looking

from .look_stage import DEPTH, METAL, STAGE

pyvista = pytest.importorskip("pyvista")


@pytest.fixture(scope="module")
def stage(tmp_path_factory):
    file = tmp_path_factory.mktemp("window") / "ball.usda"
    file.write_text(STAGE)
    return file


@pytest.fixture
def window(stage, monkeypatch):
    monkeypatch.delenv("DISPLAY", raising=False)
    live = LiveStage(stage)
    with (
        display.canvas(True, (640, 480), (2, 2)) as plotter,
        Looking(live, Settings(width=32, spp=2, threads=2)) as looking,
    ):
        yield live_window.LiveWindow(plotter, looking)


def painted(window):
    """The image in the window once it is finished; that of the looking is the same."""
    pixels = window.looking.finished(120).pixels
    window.tick()
    np.testing.assert_array_equal(window.sheet.pixels, pixels)
    return pixels


def sliders_of(window):
    """The window's sliders, where this pyvista keeps them."""
    return getattr(window.plotter, "widgets", window.plotter).slider_widgets


def layer(window, name="fine"):
    scene = window.looking.do(lambda live, session: session.scene)
    return next((one for m in scene.materials for one in m.layers if one.name == name), None)


def test_the_sliders_edit_the_stage_and_the_image_follows(window):
    first = painted(window)
    window.set_depth(9.0)
    deeper = painted(window)
    assert layer(window).depth == 9.0 and (deeper != first).any()
    titles = [w.GetRepresentation().GetTitleText() for w in sliders_of(window)]
    assert titles == [
        "depth of metal: fine",
        "lamp intensity",
        "lamp around",
        "lamp height",
        "width",
        "coverage",
        "angle",
    ]
    for number, value in ((1, 200.0), (2, 40.0), (3, 20.0), (4, 30.0), (5, 0.3), (6, 45.0)):
        slider = sliders_of(window)[number]
        slider.GetRepresentation().SetValue(value)
        slider.InvokeEvent("InteractionEvent")
        other = painted(window)
        assert (other != deeper).any(), number
        deeper = other
    one = layer(window)
    assert (one.width, one.coverage) == (30.0, pytest.approx(0.3)) and one.angle == pytest.approx(np.pi / 4)
    scene = window.looking.do(lambda live, session: session.scene)
    film = sw.render(scene, sw.make_plan(scene, Settings(width=32, spp=2)))
    np.testing.assert_array_equal(deeper, eight_bit(film["color"]))


def test_the_image_follows_the_window_s_eye(window):
    first = painted(window)
    camera = window.plotter.renderers[0].camera
    camera.position = np.array(camera.position) + (1.0, 0.5, 0.0)
    window.tick()
    assert (painted(window) != first).any()
    eye = window.looking.do(lambda live, session: session.scene.camera.transform)
    np.testing.assert_allclose(eye, window.eye(), atol=1e-9)


def test_keys_switch_order_and_change_layers(window, stage):
    painted(window)
    window.cut_later()
    painted(window)
    assert layer(window).order == 2
    window.switch_layer()
    painted(window)
    assert layer(window) is None
    window.switch_layer()
    for material in ("inherit", "inherit", "conductor"):
        window.next_made_of()
        painted(window)
        assert layer(window).material == material
    window.next_shape()
    painted(window)
    assert layer(window).profile.shape == "round"
    window.next_light()
    assert sliders_of(window)[1].GetRepresentation().GetTitleText() == "sky intensity"
    window.save()
    saved = read(stage.with_suffix(".look.usda"))
    assert [one.name for m in saved.materials for one in m.layers] == ["coarse", "fine"]


def test_the_image_lies_over_the_view(window):
    """The middle of the 3D view shows the image's pixels when it is laid over."""
    painted(window)

    def shot():
        return np.array(window.plotter.screenshot(return_img=True))[:240, :320].astype(int)

    alone = shot()
    window.toggle_overlay()
    assert window.overlay.visible
    over = shot()
    assert (over != alone).any(-1).mean() > 0.3
    sky = over[22:36, 4:18].reshape(-1, 3)  # left of the ball: the even sky
    assert np.abs(sky - window.looking.shown.pixels[1, 1]).max() <= 2
    window.toggle_overlay()
    np.testing.assert_array_equal(shot(), alone)


def test_what_is_refused_is_told(window):
    painted(window)
    before = window.looking.shown.version
    window.looking.edit({DEPTH: -1.0})
    window.looking.wait(before, 30)
    window.tick()
    assert f"{METAL}.scratch:layer:fine:depth" in window.told and layer(window).depth == 4.0


def test_a_screenshot_has_the_finished_image(stage, tmp_path, monkeypatch):
    monkeypatch.delenv("DISPLAY", raising=False)
    live_window.view(stage, tmp_path / "shot.png", width=32, spp=2, size=(640, 480))
    assert (tmp_path / "shot.png").stat().st_size > 5000
