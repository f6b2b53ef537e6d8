"""Normal maps turn the shading normal: x along dP/du, y along dP/dv, z to the outside, however uvs are mirrored."""

from dataclasses import replace

import numpy as np
import pytest

from scratchwarp.scene import DistantLight, Instance, Material, PreviewSurface, Texture, TextureInput

from . import scenes

LOCAL = np.array([0.48, 0.36, 0.8])
TOWARD = np.array([0.4, 0.3, 0.6]) / np.linalg.norm([0.4, 0.3, 0.6])
# a map of one normal; UsdPreviewSurface wants scale 2 and bias -1
MAP = Texture("/map", np.broadcast_to([*(LOCAL / 2 + 0.5), 1.0], (2, 2, 4)))
READ = TextureInput(texture=0, scale=(2, 2, 2, 1), bias=(-1, -1, -1, 0))


def lit(mesh, linear):
    """(radiance, normal) of a white plane of almost no specular reflection under parallel light of irradiance pi."""
    surface = PreviewSurface(
        diffuse_color=(1, 1, 1), use_specular_workflow=True, specular_color=(0, 0, 0), roughness=1.0, normal=READ
    )
    sun = DistantLight(path="/sun", radiance=np.full(3, np.pi), direction=-TOWARD)
    m = np.eye(4)
    m[:3, :3], m[2, 3] = linear, -6.0
    placed = [Instance(path="/plane", mesh=0, transform=m, materials=(0,))]
    world = scenes.scene([mesh], [Material("/mat", surface)], [sun], placed, textures=(MAP,))
    film = scenes.shoot(world, width=8, height=8)
    assert film.stats["invalid_samples"] == 0
    middle = np.s_[3:5, 3:5]
    return film["color"][middle].mean((0, 1)), film["normal"][middle].mean((0, 1))


def mapped(change):
    plane = scenes.plane(2.0)
    return replace(plane, uvs={"st": change(plane.uvs["st"])})


X, Y, Z = np.eye(3)
# name -> (plane, its instance, dP/du, dP/dv, outside)
CASES = {
    "plain": (scenes.plane(2.0), np.eye(3), X, Y, Z),
    "u mirrored": (mapped(lambda st: st * (-1, 1)), np.eye(3), -X, Y, Z),
    "v mirrored": (mapped(lambda st: st * (1, -1)), np.eye(3), X, -Y, Z),
    "swapped": (mapped(lambda st: st[..., ::-1]), np.eye(3), Y, X, Z),
    "mirrored instance": (scenes.plane(2.0), np.diag([-1.0, 1, 1]), -X, Y, Z),
    "turned instance": (scenes.plane(2.0), np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 1]]), Y, -X, Z),
    "from behind": (scenes.plane(2.0), np.diag([-1.0, 1, -1]), -X, Y, -Z),
    "no uv": (replace(scenes.plane(2.0), uvs={}), np.eye(3), X, Y, Z),
}


@pytest.mark.parametrize("name", CASES)
def test_the_normal_of_a_map(name):
    mesh, linear, du, dv, out = CASES[name]
    normal = LOCAL @ np.stack([du, dv, out])
    if out[2] < 0:
        normal = -normal  # towards the viewer
    color, found = lit(mesh, linear)
    np.testing.assert_allclose(found, normal, atol=2e-6)
    # Schlick's rise to white at grazing angles is left of the specular lobe, under 1 % here
    np.testing.assert_allclose(color, max(normal @ TOWARD, 0.0), rtol=0.01)
