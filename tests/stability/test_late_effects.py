"""Whole images at the hard places of what came later: grooves, profiles that vary along them, and scratches that
interfere. The kernels are those of the rooms' own tests."""

from dataclasses import replace

import numpy as np
import pytest

import scratchwarp as sw
from scratchwarp.scene import DistantLight, Profile

from ..render import groove_geometry as sheets
from ..render import scenes
from ..render import test_diffraction_pairs as pairs
from ..render.test_diffraction import LUMINANCE
from ..render.test_groove_pictures import EFFECTS
from .test_scenes import finite

SHALLOW = Profile(path="/end", shape="points", points=np.array([[0.0, 0.0], [0.5, -0.3], [1.0, 0.0]]))
VARIED = {"profile_end": SHALLOW, "profile_variation": 1.0, "variation_length": 900.0}
LENGTHS = ("width", "depth", "pitch", "variation_length")
KINDS = ("grooves", "varied")


def look(kind, size=1.0, place=None, lights=None, mesh=None, view=sheets.VIEW, pixels=8, spp=64, **fields):
    """A film of a sheet of grooves, all lengths times ``size``."""
    fields = {**(VARIED if kind == "varied" else {}), **fields}
    lengths = {"width": 100.0, "pitch": 200.0, "depth": 50.0, **fields}
    fields |= {name: lengths[name] * size for name in LENGTHS if name in lengths}
    world = sheets.world(True, sheets.ROUGH, 1.0, 0.5, **fields)
    cam = world.camera
    window = size * 8e-4
    transform = sheets.looking(view, size)
    cam = replace(cam, transform=transform, horizontal_aperture=window, vertical_aperture=window)
    placed = (place or scenes.place(),)
    world = replace(world, meshes=(mesh or scenes.plane(2e-3 * size),), camera=cam, instances=placed)
    world = world if lights is None else replace(world, lights=tuple(lights))
    asked = {"width": pixels, "height": pixels, "spp": spp, "filter": "box", "integrator": "direct"}
    return finite(sw.render(world, sw.make_plan(world, sw.Settings(**asked, effects=EFFECTS))))


@pytest.mark.parametrize("kind", KINDS)
def test_grooves_of_any_size_look_the_same(kind):
    """Scaled by powers of two with all they hold: the same digits, but for lengths in micrometres and in metres, which
    differ by rounding; now and then a path goes another way."""
    one = look(kind)["color"].astype(float)
    assert one.std() > 1e-3 * one.mean()
    for power in (-20, 20):
        other = look(kind, 2.0**power)["color"].astype(float)
        assert other.mean() == pytest.approx(one.mean(), rel=2e-3)
        assert np.isclose(other, one, rtol=1e-2).all(-1).mean() > 0.9


LINEAR = {
    "mirrored": np.diag([-1.0, 1.0, 1.0]),
    "sheared": np.array([[1.0, 0.4, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]]),
    "stretched": np.diag([3.0, 0.5, 1.0]),
}


@pytest.mark.parametrize("name", LINEAR)
def test_grooves_placed_are_as_if_modelled_so(name):
    """By the transform of an instance, or by its points: pixel by pixel within the noise of paths."""
    m, plane = LINEAR[name], scenes.plane(2e-3)
    flip = np.linalg.det(m) < 0.0
    triangles, st = (x[:, ::-1] if flip else x for x in (plane.triangles, plane.uvs["st"]))
    modelled = replace(plane, points=plane.points @ m.T, triangles=triangles, uvs={"st": st})
    placed = look("grooves", place=scenes.place(linear=m), spp=256)["color"].astype(float)
    baked = look("grooves", mesh=modelled, spp=256)["color"].astype(float)
    assert placed.mean() == pytest.approx(baked.mean(), rel=5e-3)
    assert np.abs(placed - baked).max() < 0.1 * baked.mean()


def sun(*direction):
    return DistantLight(path="/sun", radiance=np.ones(3), direction=np.array(direction), angle=0.0)


@pytest.mark.parametrize("kind", KINDS)
def test_lights_at_and_below_the_horizon_of_grooves(kind):
    """Level, nothing of it is lost in the walls it meets and no more than all of it comes; from below, nothing."""
    level = look(kind, lights=[sun(-1.0, 0.0, 0.0), scenes.dome(0.0)])["color"]
    assert level.mean() < 1.0
    below = look(kind, lights=[sun(0.3, 0.0, 0.9), scenes.dome(0.0)])["color"]
    assert below.max() == 0.0


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize(
    "fields",
    [{"depth": 0.0}, {"depth": 1e-12}, {"depth": 2e3}, {"width": 1e-6}, {"width": 199.999}, {"width": 300.0}],
    ids=["no depth", "hardly any", "twenty widths", "no width", "no land", "wider than apart"],
)
def test_grooves_of_any_shape_under_a_sky(kind, fields):
    """A sky of 1 is nowhere brighter, within the noise; where it is flat, as the plane without grooves."""
    film = look(kind, lights=[sun(0.0, 0.0, -1.0), scenes.dome(1.0)], **fields)
    assert np.isfinite(film["color"]).all()
    lit = look(kind, lights=[replace(sun(0.0, 0.0, -1.0), radiance=np.zeros(3)), scenes.dome(1.0)], **fields)
    noise = np.sqrt(lit["variance"].sum()) / lit["variance"].size
    assert 0.0 < lit["color"].mean() < 1.0 + 1e-3 + 5.0 * noise


@pytest.mark.parametrize("kind", KINDS)
def test_grazing_and_back_facing_views_of_grooves(kind):
    for tilt in (np.pi / 2 - 1e-3, np.pi / 2 + 1e-3, np.pi):
        look(kind, view=np.array([np.sin(tilt), 0.0, np.cos(tilt)]), spp=16)


def test_scratches_in_the_same_place_interfere():
    """Twice the amplitude, four times the light; one of no width or no depth adds nothing."""
    omega_i = pairs.across(0.11, 0.0)
    one = pairs.seen(omega_i, pairs.strokes([4.0], [3.0], [1.0]), samples=16) @ LUMINANCE
    two = pairs.seen(omega_i, pairs.strokes([4.0, 4.0], [3.0, 3.0], [1.0, 1.0]), samples=16) @ LUMINANCE
    assert one > 0.0 and two == pytest.approx(4.0 * one, rel=2e-3)
    for width, depth in ((0.0, 1.0), (1e-9, 1.0), (3.0, 0.0), (3.0, 1e-9)):
        more = pairs.strokes([4.0, 4.0], [3.0, width], [1.0, depth])
        assert pairs.seen(omega_i, more, samples=16) @ LUMINANCE == pytest.approx(one, rel=2e-3)


@pytest.mark.parametrize("widths", [[1e-3, 1e3], [1e5, 1e5]])
@pytest.mark.parametrize("xi2", [0.0, 1e-12, 0.999999])
def test_pairs_of_any_size_and_light(widths, xi2):
    """Neither nothing nor metres, in the mirror direction and at the horizon."""
    curves = pairs.strokes([0.0, 0.0], widths, [1e-9, 1e4], [0.0, 1e-9])
    value = pairs.seen(pairs.across(xi2, 0.0), curves, samples=16)
    assert np.isfinite(value).all() and (value >= 0.0).all()
