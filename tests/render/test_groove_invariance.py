"""What changes nothing about a groove: turning it with the scene, a point more on its path, a seam, the uv square.

The kernel is that of ``test_groove_pictures``. Tolerances: pictures of the same random numbers differ by rounding of
float32, which now and then sends a path another way; turned ones by the noise of 16,384 paths, 0.3 %.
"""

from dataclasses import replace

import numpy as np
import pytest

import scratchwarp as sw
from scratchwarp.scene import Curves, Mesh, Profile
from scratchwarp.scratches.paths import lay_out

from . import groove_geometry as sheets
from . import scenes
from .test_groove_pictures import EFFECTS

SIZE = 2e-3  # of the plane
ZIGZAG = np.array([[0.2, 0.1], [0.8, 0.5], [0.4, 0.6], [0.7, 0.95]])


def film(world):
    """Finite radiance [8, 8]."""
    made = sw.render(world, sw.make_plan(world, sheets.settings(8, 256, EFFECTS)))
    assert made.stats["invalid_samples"] == 0
    return made["color"].astype(float)[..., 0]


def along(*paths, depth=40.0):
    """A diffuse plane with grooves 90 um wide and 40 deep along ``paths`` in uv, a sun and a sky."""
    points = np.concatenate([np.column_stack([p, np.zeros(len(p))]) for p in paths])
    counts = np.array([len(p) for p in paths])
    curves = Curves("/c", points, counts, np.full(len(points), 90.0), np.full(len(points), depth), "uv")
    world = sheets.world(True, sheets.LAMBERT, 1.0, 0.5, distribution="curves", curves=(0,))
    return replace(world, meshes=(scenes.plane(SIZE),), curves=(curves,))


def test_turning_pattern_and_scene_together():
    """Paths turned about the middle of the plane with the camera and the sun, pixel by pixel."""
    turn = np.eye(4)
    turn[:2, :2] = [[0.8, -0.6], [0.6, 0.8]]
    straight = along(ZIGZAG)
    turned = along((ZIGZAG - 0.5) @ turn[:2, :2].T + 0.5)
    sun, sky = turned.lights
    camera = replace(turned.camera, transform=turn @ turned.camera.transform)
    turned = replace(turned, lights=(replace(sun, direction=turn[:3, :3] @ sun.direction), sky), camera=camera)
    a, b = film(straight), film(turned)
    assert a.std() > 0.02 * a.mean() and b.mean() == pytest.approx(a.mean(), rel=3e-3)
    assert np.abs(a - b).max() < 0.05 * a.mean()


def test_a_point_more_on_a_straight_path():
    """Each stretch of a path in two collinear pieces, of unlike lengths."""
    more = np.insert(ZIGZAG, [1, 2, 3], ZIGZAG[:-1] + np.array([[0.3], [0.5], [0.8]]) * np.diff(ZIGZAG, axis=0), axis=0)
    a, b = film(along(ZIGZAG)), film(along(more))
    assert np.abs(a - b).max() < 2e-3 * a.mean()


def test_a_seam_under_footprints():
    """A plane whose right half has u moved on by one: grooves along u go on over the seam."""
    world = sheets.world(True, sheets.LAMBERT, 1.0, 0.5, distribution="linear")
    whole = replace(world, meshes=(scenes.plane(SIZE),))
    h = SIZE / 2
    corners = np.array([[x, y, 0.0] for x in (-h, 0.0, h) for y in (-h, h)])
    triangles = np.array([[0, 2, 3], [0, 3, 1], [2, 4, 5], [2, 5, 3]])
    st = corners[triangles][..., :2] / SIZE + 0.5
    st[2:, :, 0] += 1.0
    halves = Mesh("/halves", corners, triangles, uvs={"st": st})
    a, b = film(whole), film(replace(world, meshes=(halves,)))
    assert a.std() > 0.02 * a.mean() and np.abs(a - b).max() < 0.01 * a.mean()


def test_a_path_beyond_the_uv_square():
    """It goes on far outside, or ends a groove's depth and width outside: the plane shows the same."""
    far = np.array([[-4.0, -1.75], [5.0, 2.75]])
    near = np.array([[-0.1, 0.2], [1.1, 0.8]])
    cross = np.array([[0.55, -0.2], [0.45, 1.2]])
    a, b = film(along(far, cross)), film(along(near, cross))
    assert a.std() > 0.01 * a.mean() and np.abs(a - b).max() < 2e-3 * a.mean()


def test_profiles_that_change_along_paths():
    """Steps of a millionth of the depth show nothing, though each is a wall; steps between a V and one a third as deep
    darken the plane as much as grooves of those depths do by their lengths (1.6 % at full depth), to 0.3 %."""

    def varied(deep):
        end = Profile("/end", shape="points", points=np.array([[0.0, 0.0], [0.5, -deep], [1.0, 0.0]]))
        world = along(ZIGZAG)
        (material,) = world.materials
        (layer,) = material.layers
        layer = replace(layer, profile_end=end, profile_variation=1.0, variation_length=1500.0)
        return replace(world, materials=(replace(material, layers=(layer,)),)), layer

    plain, same = film(along(ZIGZAG)), film(varied(1.0 - 1e-6)[0])
    assert np.abs(same - plain).max() < 2e-3 * plain.mean()
    world, layer = varied(1.0 / 3.0)
    runs = lay_out(layer, np.zeros(2), np.ones(2), np.full(2, 1e6 * SIZE), curves=world.curves)
    lengths = np.array([np.linalg.norm(np.diff(run.points, axis=0), axis=1).sum() for run in runs])
    depths = [20.0, 30.0, 40.0]
    shown = [film(along(ZIGZAG, depth=d)).mean() for d in depths[:2]] + [plain.mean()]
    each = np.interp([40.0 * (1.0 - 2.0 / 3.0 * run.part) for run in runs], depths, shown)
    assert len(runs) > 20 and film(world).mean() == pytest.approx(each @ lengths / lengths.sum(), rel=3e-3)
