"""Look development without a window: edits from any thread, and an image that ends as a fresh render."""

import numpy as np
import pytest

import scratchwarp as sw
from scratchwarp.image import read_texture
from scratchwarp.image.quick import eight_bit
from scratchwarp.stage import LiveStage
from scratchwarp.viewers.looking import Looking
from scratchwarp.viewers.turning import Move, moved

from .look_stage import DEPTH, STAGE

SETTINGS = sw.Settings(width=32, spp=3, threads=2)


@pytest.fixture(scope="module")
def ball(tmp_path_factory):
    file = tmp_path_factory.mktemp("stages") / "ball.usda"
    file.write_text(STAGE)
    return file


@pytest.fixture
def looking(ball):
    with Looking(LiveStage(ball, load_texture=read_texture), SETTINGS) as made:
        yield made


def depth_of(looking):
    return next(c for c in looking.shown.controls if c.id == DEPTH)


def test_edits_end_in_the_image_of_a_fresh_render(looking, ball, tmp_path):
    """Many values in a row, a moved camera and a turned light: the same pixels as a render of the saved look."""
    first = looking.finished(120)
    assert first.finished and first.samples == 3 and not first.message
    control = depth_of(looking)
    for share in (0.2, 0.5, 0.9, 1.5):
        looking.edit({control.id: control.value * share + 1.0})
    light = next(c.owner for c in looking.shown.controls if c.section == "light")
    looking.move(light, Move(right=0.4, up=0.2))
    looking.move("", Move(right=0.1))
    looking.move("", Move(right=0.1, nearer=1.2))
    last = looking.finished(120)
    assert depth_of(looking).value == pytest.approx(control.value * 1.5 + 1.0)
    assert (last.pixels != first.pixels).any() and last.edits >= 1
    scene = looking.do(lambda live, session: session.scene)
    film = sw.render(scene, sw.make_plan(scene, SETTINGS))
    np.testing.assert_array_equal(last.pixels, eight_bit(film["color"]))
    looking.do(lambda live, session: live.save(tmp_path / "look.usda"))
    again = sw.read(tmp_path / "look.usda")
    saved = sw.render(again, sw.make_plan(again, SETTINGS))
    # another origin: positions differ in the last bits of float32, which a few pixels show
    off = np.abs(eight_bit(saved["color"]).astype(int) - last.pixels).max(-1)
    assert (off > 2).mean() < 0.05


def test_what_is_at_fault_is_told_and_undone(looking):
    before = looking.finished(120)
    control = depth_of(looking)
    looking.edit({control.id: -4.0})
    told = looking.wait(before.version, 60)
    assert "expected a value in [0, inf)" in told.message and depth_of(looking).value == control.value
    looking.edit({control.id: control.value + 1.0})
    assert looking.finished(120).message == "" and depth_of(looking).value == control.value + 1.0
    with pytest.raises(ValueError, match="no light"):
        looking.do(lambda live, session: live.matrix("/nothing"))


def test_reset_and_close(looking):
    control = depth_of(looking)
    looking.edit({control.id: control.value + 1.0})
    looking.reset()
    assert depth_of(looking).value == control.value
    looking.close()
    assert not looking._thread.is_alive()


def test_a_stage_that_cannot_be_planned_is_told_to_who_waits(ball):
    with (
        Looking(LiveStage(ball), sw.Settings(effects={"nonsense": True})) as made,
        pytest.raises(ValueError, match="nonsense"),
    ):
        made.finished(60)


def test_moves_turn_about_the_middle(ball):
    live = LiveStage(ball)
    low, high = live.scene.bounds()
    middle, eye = 0.5 * (low + high), live.scene.camera.transform[:3, 3]
    there = moved(live, "", Move(right=0.5, up=0.1))
    assert np.linalg.norm(there[:3, 3] - middle) == pytest.approx(np.linalg.norm(eye - middle))
    np.testing.assert_allclose(there[:3, :3] @ there[:3, :3].T, np.eye(3), atol=1e-12)
    near = moved(live, "", Move(nearer=2.0))
    np.testing.assert_allclose(near[:3, 3] - middle, 0.5 * (eye - middle), atol=1e-12)
    over = moved(live, "", Move(up=50.0))
    assert abs(over[:3, 2] @ live.scene.up) < 0.9951
    shifted = moved(live, "", Move(across=0.5))
    assert (shifted[:3, 3] - eye) @ live.scene.camera.transform[:3, 0] < 0
    assert Move(1, 2, nearer=2.0).then(Move(0, 1, nearer=3.0)) == Move(1, 3, nearer=6.0)
    for wrong in ({"right": float("nan")}, {"up": "x"}, {"nearer": 0.0}, {"across": 1e9}, {"right": True}):
        with pytest.raises(ValueError, match="expected a number"):
            Move(**wrong)
