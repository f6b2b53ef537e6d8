"""Checkpoints: what belongs to which render."""

from dataclasses import replace

import numpy as np
import pytest

from scratchwarp.render import checkpoint
from scratchwarp.render.renderer import scene_digest
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


def test_a_checkpoint_of_another_render_is_refused(tmp_path):
    sums = {"color": np.arange(4.0)}
    file = tmp_path / "part"
    checkpoint.save(file, "mine", np.array([True, False]), sums)
    loaded = {"color": np.zeros(4)}
    assert checkpoint.load(file, "mine", loaded).tolist() == [True, False]
    assert loaded["color"].tolist() == [0, 1, 2, 3]
    assert checkpoint.load(tmp_path / "none", "mine", loaded) is None
    with pytest.raises(ValueError, match="part: the checkpoint is of another"):
        checkpoint.load(file, "yours", loaded)
    file.write_bytes(b"half")
    with pytest.raises(ValueError, match="part: not a checkpoint"):
        checkpoint.load(file, "mine", loaded)
