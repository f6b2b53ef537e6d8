"""Hard cases of grooves in a render, each finite, continuous and without loss of light.

One world a case, moved by ``shift`` of a groove's width. Continuous: under a sun and a sky, a shift of 1e-6 changes no
pixel by a thousandth (measured: 6e-7). Nothing lost: white facets under a white
sky show 1, to 0.4 % (measured with 65,536 paths: 0.1 %). The kernel is that of ``test_groove_pictures``.
"""

from dataclasses import replace

import numpy as np
import pytest

import scratchwarp as sw
from scratchwarp.scene import Curves, DomeLight, Mesh, ScratchSurface

from . import groove_geometry as sheets
from . import scenes
from .test_groove_pictures import EFFECTS

SIZE = 2e-3  # of the plane [m]
WIDTH, DEPTH = 90.0, 40.0  # [um]
WHITE = ScratchSurface(base="diffuse", color=(1.0, 1.0, 1.0))
MIDDLE = np.array([0.5, 0.5])
ACROSS = np.array([0.6, 0.8])
UNIT = WIDTH * 1e-6 / SIZE  # a groove's width in uv


def halves():
    """The plane in two halves, u moved on by one in the right one."""
    h = SIZE / 2
    corners = np.array([[x, y, 0.0] for x in (-h, 0.0, h) for y in (-h, h)])
    triangles = np.array([[0, 2, 3], [0, 3, 1], [2, 4, 5], [2, 5, 3]])
    st = corners[triangles][..., :2] / SIZE + 0.5
    st[2:, :, 0] += 1.0
    return Mesh("/halves", corners, triangles, uvs={"st": st})


def line(angle, aside=0.0, reach=3.0):
    """A straight path past the middle of uv, ``aside`` in widths."""
    along = np.array([np.cos(angle), np.sin(angle)])
    return MIDDLE + aside * UNIT * np.array([-along[1], along[0]]) + reach * np.array([[-1.0], [1.0]]) * along


PATHS = {
    "smaller than a facet": [line(0.3), line(1.9)],
    "on a vertex": [np.stack([MIDDLE - (0.6, 0.1), MIDDLE, MIDDLE + (0.2, 0.6)])],
    "tangent": [line(0.3), line(0.3, 1.0), line(0.3, 0.5), line(0.3, -1.0), line(0.3)],
    "three through one point": [line(0.3), line(1.3), line(2.4)],
    "zero-length segments": [np.repeat(line(0.3), 2, axis=0), np.stack([MIDDLE, MIDDLE])],
    "crosses itself": [MIDDLE + np.array([[-0.5, 0.02], [0.5, 0.02], [0.02, 0.5], [0.02, -0.5]])],
    "leaves the uv square": [line(0.1, reach=30.0), line(1.7, 2.0, reach=30.0)],
    "over a seam": [line(0.0, 0.2)],
    "grazing along it": [line(0.0, 0.2), line(0.0, 1.4)],
}


def along(paths):
    """Curves in uv, one size."""
    points = np.concatenate([np.column_stack([p, np.zeros(len(p))]) for p in paths])
    counts = np.array([len(p) for p in paths])
    return Curves("/c", points, counts, np.full(len(points), WIDTH), np.full(len(points), DEPTH), "uv")


def world(case, surface, sun, sky, shift=0.0):
    """The case, ``shift`` widths off: its paths each another way, and the camera."""
    paths = [p + shift * UNIT * np.array([np.cos(k + 1), np.sin(k + 1)]) for k, p in enumerate(PATHS[case])]
    if case == "over a seam":
        paths += [p + (1.0, 0.0) for p in paths]
    curves = along(paths)
    made = sheets.world(True, surface, sun, sky, distribution="curves", curves=(0,))
    view, aperture = np.array([0.6, 0.0, 0.8]), 4e-4
    if case == "smaller than a facet":
        aperture = 1e-7
    if case == "grazing along it":
        tilt = np.radians(89.0) + shift
        view = np.array([np.sin(tilt), 0.0, np.cos(tilt)])
        aperture = 1e-5
    camera = replace(made.camera, transform=sheets.looking(view, 1e-2))
    camera = replace(camera, horizontal_aperture=aperture, vertical_aperture=aperture)
    mesh = halves() if case == "over a seam" else scenes.plane(SIZE)
    return replace(made, meshes=(mesh,), curves=(curves,), camera=camera)


def film(scene, spp, bounces=8):
    """Finite radiance [8, 8], everywhere of the plane."""
    asked = replace(sheets.settings(8, spp, EFFECTS), knobs={"grooves.bounces": bounces})
    made = sw.render(scene, sw.make_plan(scene, asked))
    assert made.stats["invalid_samples"] == 0 and np.isfinite(made["color"]).all() and (made["alpha"] == 1.0).all()
    return made["color"].astype(float)[..., 0]


@pytest.mark.parametrize("case", PATHS)
def test_finite_and_continuous(case):
    a = film(world(case, sheets.LAMBERT, 1.0, 0.5), 64)
    b = film(world(case, sheets.LAMBERT, 1.0, 0.5, 1e-6), 64)
    bare = 0.8 * (sheets.TO_LIGHT[2] / np.pi + 0.5)
    assert np.abs(a / bare - 1.0).max() > 0.02  # there is a groove to see
    assert np.abs(a - b).max() < 1e-3 * a.mean() and abs(a.mean() - b.mean()) < 1e-5 * a.mean()


@pytest.mark.parametrize("case", PATHS)
def test_no_light_is_lost(case):
    scene = world(case, WHITE, 0.0, 1.0)
    assert isinstance(scene.lights[0], DomeLight)
    assert film(scene, 256, 64).mean() == pytest.approx(1.0, abs=0.004)


def test_a_groove_of_no_depth_is_not_seen():
    """The bare plane under a sun, albedo cos / pi, pixel by pixel to rounding."""
    scene = world("three through one point", sheets.LAMBERT, 1.0, 0.0)
    curves = replace(scene.curves[0], depths=np.zeros(len(scene.curves[0].points)))
    flat = film(replace(scene, curves=(curves,)), 4)
    np.testing.assert_allclose(flat, 0.8 * sheets.TO_LIGHT[2] / np.pi, rtol=1e-5)


def test_pieces_that_go_on_from_one_another_are_one_path():
    """A path cut where it is straight, its parts curves of their own, in any order."""
    scene = world("crosses itself", sheets.LAMBERT, 1.0, 0.5)
    path = PATHS["crosses itself"][0]
    cuts = [0.3 * a + 0.7 * b for a, b in zip(path[:-1], path[1:], strict=True)]
    runs = [[path[0], cuts[0]], *[[cuts[k], path[k + 1], cuts[k + 1]] for k in range(len(cuts) - 1)]]
    runs = [*runs, [cuts[-1], path[-1]]][::-1]
    a, b = film(scene, 64), film(replace(scene, curves=(along(runs),)), 64)
    assert a.std() > 0.01 * a.mean() and np.abs(a - b).max() < 0.01 * a.mean()
