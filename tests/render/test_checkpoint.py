"""Checkpoints: what belongs to which render."""

from dataclasses import replace

import numpy as np
import pytest

import scratchwarp as sw
from scratchwarp.kernels import kernel_key
from scratchwarp.render.checkpoint import Checkpoint
from scratchwarp.render.described import described, scene_digest
from scratchwarp.render.tiles import Tile
from scratchwarp.scene import SphereLight, Texture

from . import scenes as S


def scene(**fields):
    texture = Texture("grey.png", np.full((2, 2, 4), 0.5, np.float32))
    return S.scene([S.sphere(4, 8)], [S.scratched()], [S.dome()], textures=(texture,), **fields)


def test_the_same_scene_has_the_same_digest_however_long_it_took_to_read():
    assert scene_digest(scene()) == scene_digest(scene(seconds=1.5, warnings=("slow",)))


def nudged(array):
    changed = np.array(array)
    changed.flat[-1] += 1e-6
    return changed


@pytest.mark.parametrize(
    "change",
    [
        lambda s: {"camera": replace(s.camera, focus_distance=2.0)},
        lambda s: {"meshes": (replace(s.meshes[0], uvs={"st": nudged(s.meshes[0].uvs["st"])}),)},
        lambda s: {"meshes": (replace(s.meshes[0], normals=nudged(s.meshes[0].normals)),)},
        lambda s: {"textures": (Texture("grey.png", nudged(s.textures[0].pixels)),)},
        lambda s: {"lights": (replace(s.lights[0], linked=frozenset({0})),)},
        lambda s: {"lights": (SphereLight(path="/dome", radiance=np.ones(3), center=np.zeros(3), radius=1.0),)},
        lambda s: {"materials": (S.scratched(seed=1),)},
        lambda s: {"origin": nudged(s.origin)},
    ],
)
def test_whatever_decides_an_image_changes_the_digest(change):
    before = scene()
    assert scene_digest(replace(before, **change(before))) != scene_digest(before)


def test_slots_of_tiles(tmp_path):
    """Two in turn for each tile: the newest that is whole counts."""
    tiles = [Tile(0, 0, 2, 2), Tile(2, 0, 1, 2)]
    sums = {"color": np.zeros((2, 3, 3), np.float32), "rays": np.zeros((2, 3), np.int32)}
    file = tmp_path / "part"
    about = {"spp": "4", "meshes": "#a"}
    made = Checkpoint(file, about, tiles, sums)
    for samples in (4, 8, 16):
        made.keep(1, samples, {"color": np.full((2, 1, 3), samples, np.float32), "rays": np.full((2, 1), 7, np.int32)})
    made.close()
    back = Checkpoint.resume(file, about, tiles, sums)
    assert back.samples.tolist() == [0, 16]
    assert (sums["color"][:, 2] == 16).all() and not sums["color"][:, :2].any()
    assert sums["rays"][:, 2].tolist() == [7, 7]
    back.keep(1, 32, {"color": np.ones((2, 1, 3), np.float32), "rays": np.ones((2, 1), np.int32)})
    back.close()
    again = Checkpoint.resume(file, {**about}, tiles, sums)
    assert again.samples.tolist() == [0, 32]
    again.close()


def test_a_checkpoint_of_another_render_is_refused_with_the_difference(tmp_path):
    sums = {"color": np.zeros((2, 2, 3), np.float32)}
    file, tiles = tmp_path / "part", [Tile(0, 0, 2, 2)]
    about = {"stage": "a.usda", "spp": "4", "seed": "0", "meshes": "#a", "camera": "#c"}
    Checkpoint(file, about, tiles, sums).close()
    Checkpoint.resume(file, {**about, "stage": "same/a.usda"}, tiles, sums).close()
    with pytest.raises(ValueError, match="part: .*: spp is 8 here and 4 there, other meshes; delete it"):
        Checkpoint.resume(file, {**about, "spp": "8", "meshes": "#b"}, tiles, sums)
    for content in (b"half", b"", b"scratchwarp checkpoint 2\n", b"scratchwarp checkpoint 2\n\xff\xff\xff\xff[]"):
        file.write_bytes(content)
        with pytest.raises(ValueError, match="part: not a checkpoint"):
            Checkpoint.resume(file, about, tiles, sums)


def test_the_parts_of_a_render_have_names():
    plan = sw.make_plan(scene(), sw.Settings(spp=3, width=8, height=8))
    about = described(scene(), plan, kernel_key(scene(), plan))
    assert about["spp"] == "3" and about["meshes"].startswith("#") and "materials" in about and "lights" in about
