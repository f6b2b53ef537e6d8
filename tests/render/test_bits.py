"""The image depends on the scene and the seed alone: not on threads, tiles, crops or interruptions, to the last bit."""

import numpy as np
import pytest

import scratchwarp as sw
from scratchwarp.scene import RectLight

from . import scenes

SIZE = {"width": 45, "height": 33, "spp": 40, "filter": "box", "effects": scenes.EVERYTHING}


def world():
    """A scratched ball before a scratched wall, with shadows, under a lamp and a sky."""
    materials = [scenes.scratched(width=20000.0, depth=8000.0, length=3e5), scenes.scratched(scenes.lambert(0.5))]
    lamp = RectLight(
        path="/lamp", radiance=(9, 7, 5), center=(2, 2, -3), ex=(0.5, 0, -0.5), ey=(0, 0.7, 0), normal=(-0.8, 0, -0.6)
    )
    placed = [scenes.place(0, 0, (0, 0, -6), "/ball"), scenes.place(1, 1, (0.2, 0, -8), "/wall")]
    meshes = [scenes.sphere(), scenes.plane(3.0)]
    return scenes.scene(meshes, materials, [lamp, scenes.dome(0.3)], placed)


def shoot(render=None, **settings):
    scene = world()
    return sw.render(scene, sw.make_plan(scene, sw.Settings(**SIZE | settings)), **(render or {}))


@pytest.fixture(scope="module")
def reference():
    return shoot(threads=1, tile=32)


def same(a, b):
    for name in a:
        np.testing.assert_array_equal(a[name], b[name], err_msg=name)


def test_it_is_an_image(reference):
    for name in ("base", "scratches", "emission"):
        assert reference[name].max() > 0.1
    assert reference["color"].std() > 0.1 and set(np.unique(reference["primId"])) == {-1, 0, 1}


@pytest.mark.parametrize("threads", [2, 3])
def test_threads(reference, threads):
    same(shoot(threads=threads), reference)


@pytest.mark.parametrize("tile", [1, 8, 64])
def test_tiles(reference, tile):
    same(shoot(threads=2, tile=tile), reference)


def test_crop(reference):
    part = shoot(crop=(0.2, 0.6, 0.3, 0.9))
    x0, x1, y0, y1 = part.crop
    assert (x0, x1, y0, y1) == (9, 27, 9, 30) and part["color"].shape == (21, 18, 3)
    for name in reference:
        np.testing.assert_array_equal(part[name], reference[name][y0:y1, x0:x1], err_msg=name)


@pytest.mark.parametrize("threads", [1, 2])
def test_resumed(reference, tmp_path, threads):
    file = tmp_path / "render.ckpt"
    seen = []

    def stop(done, total, stage):
        if stage == "trace":
            seen.append(done)
            if done > total / 2:
                raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        shoot({"checkpoint": file, "progress": stop}, threads=threads, tile=8)
    assert file.exists() and 0 < seen[-1] < 45 * 33 * 40
    begun = []
    resumed = shoot(
        {"checkpoint": file, "resume": True, "progress": lambda done, total, stage: begun.append((stage, done))},
        threads=threads,
        tile=8,
    )
    started = next(done for stage, done in begun if stage == "trace")
    assert started >= 45 * 33 * 40 / 2 and resumed.stats["rays"] == reference.stats["rays"]
    same(resumed, reference)
    assert not file.exists()


def test_a_checkpoint_of_another_render_is_refused(tmp_path):
    file = tmp_path / "render.ckpt"

    def stop(done, total, stage):
        if stage == "trace" and done:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        shoot({"checkpoint": file, "progress": stop}, tile=8)
    for change in ({"seed": 1}, {"spp": 41}, {"width": 44}, {"tile": 16}, {"max_depth": 3}, {"filter_width": 2.0}):
        with pytest.raises(ValueError, match="another stage, settings or version"):
            shoot({"checkpoint": file, "resume": True}, **{"tile": 8} | change)


def test_seeds(reference):
    other = shoot(seed=7)
    same(other, shoot(seed=7))
    on = reference["alpha"] > 0  # a third of them mirrors that see the even sky alone
    assert (other["color"] != reference["color"]).any(-1)[on].mean() > 0.5
    sigma = np.sqrt(other["variance"] + reference["variance"])
    assert (np.abs(other["color"] - reference["color"]).max(-1) < 8 * sigma + 1e-4).all()
