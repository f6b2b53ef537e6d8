"""Small lights along the cones of all layers: the same mean as by one layer drawn, with far less noise."""

import numpy as np
import pytest

import scratchwarp as sw
from scratchwarp.kernels.assemble import kernel_key
from scratchwarp.plan.effects import NARROW
from scratchwarp.scene import DistantLight, PreviewSurface, RectLight, SphereLight

from . import scenes

SEEDS = 24


def world(lights):
    base = PreviewSurface(diffuse_color=(0.5, 0.4, 0.3), roughness=0.5, metallic=1.0)
    many = scenes.scratched(
        base, distribution="random", width=3e4, depth=1.2e4, length=3e5, coverage=0.3, angle_spread=360.0
    )
    ball = scenes.sphere(12, 24)
    # the second ball casts shadows on the first one
    placed = [scenes.place(0, 0, (0, 0, -6), "/ball"), scenes.place(0, 0, (0.6, 1.6, -5.0), "/above")]
    return scenes.scene([ball], [many], [*lights, scenes.dome(0.1)], placed, scenes.camera(20.0))


LAMPS = [
    SphereLight(path="/bulb", radiance=(900, 700, 500), center=(1.5, 4, -3), radius=0.12, specular=0.7),
    DistantLight(path="/sun", radiance=(300, 300, 400), direction=(0.4, -0.5, -0.77), angle=0.03),
    RectLight(
        path="/sheet", radiance=(200, 300, 300), center=(-4, 2, 0), ex=(0, 0.1, 0), ey=(0, 0, 0.1), normal=(1, 0, 0)
    ),
]


def films(world, on):
    return np.array([
        np.asarray(
            scenes.shoot(world, {"lights.small": on}, width=12, height=12, spp=96, seed=seed)["color"], np.float64
        )
        for seed in range(SEEDS)
    ])  # fmt: skip


def test_the_same_mean_with_less_noise():
    lit = world(LAMPS)
    found, drawn = films(lit, True), films(lit, False)
    means = [f.mean(axis=(1, 2)) for f in (found, drawn)]  # [seed, channel]
    off = means[0].mean(axis=0) - means[1].mean(axis=0)
    sigma = np.sqrt(sum(m.var(axis=0, ddof=1) / SEEDS for m in means))
    # t of 46 degrees of freedom beyond 4 comes once in 4000 times
    assert (np.abs(off) < 4.0 * sigma).all(), (off, sigma)
    assert (sigma < 0.05 * means[0].mean(axis=0)).all()
    noise = [f.var(axis=0, ddof=1).mean() for f in (found, drawn)]
    assert noise[0] < 0.8 * noise[1], noise


def test_parts_add_up():
    film = scenes.shoot(world(LAMPS), {"lights.small": True}, width=12, height=12, spp=16)
    sky = film["color"] - film["base"] - film["scratches"]
    assert (sky > -1e-4).all() and (sky < 0.1001).all() and np.abs(sky[6, 6]).max() < 1e-4


@pytest.mark.parametrize(("radius", "on"), [(0.0, False), (0.1, True), (3.0, False)])
def test_only_where_a_light_is_small(radius, on):
    bulb = SphereLight(path="/bulb", radiance=(9, 9, 9), center=(0, 6, -6), radius=radius, point=radius == 0.0)
    lit = world([bulb])
    plan = sw.make_plan(lit, sw.Settings())
    assert plan.on("lights.small") == on == kernel_key(lit, plan).small_lights
    closed = sw.make_plan(lit, sw.Settings(effects={"lights.closedForm": False}))
    assert not kernel_key(lit, closed).small_lights


def test_the_limit_is_the_kernels():
    from scratchwarp.kernels import small_lights_device

    assert float(small_lights_device.SMALL) == NARROW
