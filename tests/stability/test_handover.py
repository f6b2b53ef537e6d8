"""Grooves that go over to tables by their size in the image: what does not change that size changes nothing, and
farther off they are never laid out more often. The kernel of the images is that of ``render.test_groove_handover``.
"""

from dataclasses import replace

import numpy as np
import pytest
import warp as wp

import scratchwarp as sw
from scratchwarp.kernels import assemble
from scratchwarp.kernels.grooves_device import make_grooves
from scratchwarp.plan.grooves import FAR, NEAR
from scratchwarp.plan.nearby import nearest
from scratchwarp.render.renderer import simulate_tables
from scratchwarp.scene import Camera

from ..render import scenes
from ..render.test_groove_handover import RATIOS, SIZE, SPP, WIDTH, look, sheet
from .probe_glass import make_share
from .test_scenes import finite

METAL = scenes.white_metal(0.5)
SETTINGS = sw.Settings(width=SIZE, height=SIZE, spp=SPP, filter="box", integrator="direct")
INSIDE = 0.5 * (NEAR + FAR)


def scaled(world, size, moved=(0.0, 0.0, 0.0)):
    """All lengths times ``size``, camera and surfaces ``moved`` [m] together."""
    (material,), camera = world.materials, world.camera
    (layer,) = material.layers
    layer = replace(layer, width=layer.width * size, pitch=layer.pitch * size, depth=layer.depth * size)
    transform = camera.transform.copy()
    transform[:3, 3] = size * transform[:3, 3] + moved
    window = {n: getattr(camera, n) * size for n in ("horizontal_aperture", "vertical_aperture")}
    if camera.projection != "orthographic":
        window = {}
    mesh = replace(world.meshes[0], points=world.meshes[0].points * size)
    return replace(
        world, meshes=(mesh,), materials=(replace(material, layers=(layer,)),), instances=(scenes.place(at=moved),),
        camera=replace(camera, transform=transform, **window),
    )  # fmt: skip


def shown(world):
    plan = sw.make_plan(world, SETTINGS)
    assert plan.on("grooves.handover") and plan.on("scratches.linear")
    return finite(sw.render(world, plan))["color"].astype(float)


@pytest.fixture(scope="module")
def inside():
    """Half of the way over."""
    world = replace(sheet(METAL), camera=look(INSIDE))
    return world, shown(world)


@pytest.mark.parametrize("power", [-20, -10, 10, 20])
def test_scaled_with_the_camera(inside, power):
    """Sample by sample the same choice."""
    world, one = inside
    other = shown(scaled(world, 2.0**power))
    assert one.std() > 1e-3 * one.mean()
    assert np.isclose(other, one, rtol=1e-3).all(-1).mean() > 0.97
    assert other.mean() == pytest.approx(one.mean(), rel=1e-4)


def test_moved_with_the_camera(inside):
    """By 8 m, whose rounding is half a micrometre: a two-hundredth of a groove."""
    world, one = inside
    other = shown(scaled(world, 1.0, (8.0, -8.0, 8.0)))
    assert np.abs(other - one).max() < 0.05 * one.mean() and other.mean() == pytest.approx(one.mean(), rel=1e-3)


def ratio(world):
    """Footprints in widths, as the plan sees them."""
    return nearest(world, SETTINGS, (SIZE, SIZE), 0, world.materials[0].layers[0])


def above(away, aside=0.0):
    """A perspective camera over the sheet."""
    turn = np.eye(4)
    turn[:3, 3] = aside, 0.0, away
    return Camera(
        path="/c", transform=turn, horizontal_aperture=1e-3, vertical_aperture=1e-3, focal_length=1.0
    )  # fmt: skip


def test_the_plan_sees_the_same_size():
    """Scaled or moved with the camera; proportional to the distance, and least over all that is seen."""
    for camera in (look(3.0), above(0.3), above(0.3, 5.0)):
        world = replace(sheet(METAL), camera=camera)
        one = ratio(world)
        assert 0.0 < one < np.inf
        for size in (1e-6, 1e-3, 1e3, 1e6):
            assert ratio(scaled(world, size)) == pytest.approx(one, rel=1e-9)
        assert ratio(scaled(world, 1.0, (1e3, -2e3, 5e2))) == pytest.approx(one, rel=1e-9)
    away = [ratio(replace(sheet(METAL), camera=above(z))) for z in (1e-3, 1e-2, 1.0, 1e3)]
    np.testing.assert_allclose(np.divide(away, away[0]), [1.0, 10.0, 1e3, 1e6], rtol=1e-6)
    beside = [ratio(replace(sheet(METAL), camera=above(0.1, x))) for x in (0.0, 0.9, 2.0, 4.0, 64.0)]
    assert beside[0] == beside[1] and (np.diff(beside[1:]) > 0.0).all()


def test_farther_off_they_are_laid_out_no_more_often():
    """From always to never, without a step, at whatever scale."""
    edges = np.concatenate([np.geomspace(1e-12, NEAR, 9), np.linspace(NEAR, FAR, 65), np.geomspace(FAR, 1e12, 9)])
    shares = []
    for size in (1.0, 2.0**-20, 2.0**20):
        world = scaled(replace(sheet(METAL), camera=look(INSIDE)), size)
        plan = sw.make_plan(world, SETTINGS)
        assert plan.on("grooves.handover")
        built = assemble(world, plan, simulate_tables(plan, 1)[0])
        _, _, is_near, _ = make_grooves(built.key, None)
        steps = (edges * WIDTH * size * 1e-6 / 1.1283792).astype(np.float32)
        out = wp.zeros(len(steps), dtype=float, device="cpu")
        given = [built.inputs[3].grooves, built.inputs[1], wp.array(steps, dtype=float, device="cpu"), out]
        wp.launch(make_share(is_near), len(steps), inputs=given, device="cpu")
        shares.append(out.numpy())
    one = shares[0]
    assert (one[:9] > 1.0 - 1e-5).all() and (one[-9:] < 1e-5).all() and (np.diff(one) <= 1e-6).all()
    assert np.abs(np.diff(one)).max() < 0.03 and one.min() >= 0.0 and one.max() <= 1.0
    for other in shares[1:]:
        np.testing.assert_allclose(other, one, atol=1e-5)
    assert min(RATIOS) < NEAR < FAR < max(RATIOS)
