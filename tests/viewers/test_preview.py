"""The 3D view without a window: it follows the camera and the lights, and what is drawn is not old."""

import numpy as np
import pytest

from scratchwarp.scene import Scene
from scratchwarp.stage import LiveStage
from scratchwarp.viewers.preview import Preview
from scratchwarp.viewers.turning import Move, moved

from .look_stage import STAGE

pytest.importorskip("pyvista")
SIZE = (64, 48)


@pytest.fixture
def live(tmp_path, monkeypatch):
    monkeypatch.delenv("DISPLAY", raising=False)
    (tmp_path / "ball.usda").write_text(STAGE)
    return LiveStage(tmp_path / "ball.usda")


def fresh(scene: Scene) -> np.ndarray:
    made = Preview()
    try:
        return made.picture(scene, SIZE)
    finally:
        made.close()


def test_every_picture_is_that_of_a_fresh_view(live):
    preview = Preview()
    last = preview.picture(live.scene, SIZE)
    steps = [
        lambda: live.place("", moved(live, "", Move(right=0.4))),
        lambda: live.place("", moved(live, "", Move(nearer=0.2))),  # so far away that the lamp is seen
        lambda: live.place("/World/lamp", moved(live, "/World/lamp", Move(right=0.4))),
        lambda: live.reset(),
    ]
    for number, step in enumerate(steps):
        scene = step()
        now = preview.picture(scene, SIZE)
        assert (now != last).any(), number
        np.testing.assert_array_equal(now, fresh(scene))
        last = now
    preview.close()


def test_what_only_the_eye_changes_is_not_drawn_anew(live, monkeypatch):
    preview = Preview()
    preview.picture(live.scene, SIZE)
    monkeypatch.setattr(preview, "_fill", None)
    preview.picture(live.place("", moved(live, "", Move(right=0.4))), SIZE)
    preview.picture(live.place("/World/lamp", moved(live, "/World/lamp", Move(right=0.4))), SIZE)
    preview.close()
