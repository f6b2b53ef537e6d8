"""Layers of model auto that go over from grooves to tables: a zoom out of parallel V grooves keeps its mean.

The mean changes by less than 1 % from any image to the next: the table is within 0.3 % of true geometry, grooves within
0.1 %, the noise of a mean of 32 x 32 pixels is about 0.2 %. The noise of a pixel does not rise by more than a half.
"""

from dataclasses import replace

import numpy as np
import pytest

import scratchwarp as sw
from scratchwarp.kernels.assemble import kernel_key
from scratchwarp.plan.grooves import FAR, NEAR
from scratchwarp.scene import Camera, DistantLight, Profile, Wave

from . import groove_geometry as sheets
from . import scenes

ROUGH = sheets.ROUGH
WIDTH = 100.0
RATIOS = (1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 12.0)
SPP = 64
SIZE = 32  # pixels


def look(ratio):
    """A window of pixels whose samples are ``ratio`` grooves wide."""
    pixel = ratio * WIDTH * 1e-6 * np.sqrt(SPP) / 1.1284
    return Camera(
        path="/cam", transform=sheets.looking(np.array([0.28, 0.0, 0.96]), 1.0), projection="orthographic",
        horizontal_aperture=SIZE * pixel, vertical_aperture=SIZE * pixel,
    )  # fmt: skip


def sheet(surface):
    """Shallow V grooves under a lamp and a sky."""
    vee = Profile(path="/mat/vee", shape="vGroove")
    material = scenes.scratched(
        surface, distribution="linear", width=WIDTH, pitch=2 * WIDTH, depth=20.0, profile=vee, angle=0.4
    )
    lamp = DistantLight(path="/lamp", radiance=np.full(3, 4.0), direction=np.array([0.3, 0.3, -0.9]), angle=1.2)
    return scenes.scene([scenes.plane(2.0)], [material], [lamp, scenes.dome(0.5)], [scenes.place()], look(1.0))


@pytest.fixture
def flip():
    """The evaluator, of the extra ``study``."""
    return pytest.importorskip("flip_evaluator")


def test_a_zoom_shows_no_switch():
    world = sheet(scenes.white_metal(0.5))
    means, noise = [], []
    for ratio in RATIOS:
        settings = sw.Settings(width=SIZE, height=SIZE, spp=SPP, filter="box", integrator="direct")
        # one plan, so one kernel, for every image
        plan = sw.make_plan(world, settings)
        assert plan.on("grooves") and plan.on("grooves.handover") and plan.on("scratches.linear")
        film = sw.render(replace(world, camera=look(ratio)), plan)
        means.append(film["color"].mean(dtype=float))
        noise.append(film["color"][..., 0].std(dtype=float))
    assert NEAR in RATIOS and FAR in RATIOS
    steps = np.array(means[1:]) / means[:-1]
    assert steps == pytest.approx(np.ones(len(steps)), abs=0.01), (means, noise)
    assert max(noise) < 1.5 * max(noise[0], noise[-1])


def test_frames_of_a_zoom_show_no_switch(flip):
    """FLIP of frames 4 % apart, from near to far: in the band no pair differs more than the worst one outside of it.

    It falls all the way, from 0.05 where grooves are made out to 0.01; a twentieth is the noise of one pair.
    """
    world = sheet(scenes.white_metal(0.5))
    plan = sw.make_plan(world, sw.Settings(width=SIZE, height=SIZE, spp=SPP, filter="box", integrator="direct"))

    def differ(ratio):
        pair = [sw.render(replace(world, camera=look(r)), plan)["color"] for r in (ratio, 1.04 * ratio)]
        shown = [np.clip(0.45 * p / pair[0].mean(), 0.0, 1.0).astype(np.float32) for p in pair]
        return flip.evaluate(*shown, "LDR", inputsRGB=False)[1]

    outside = [differ(r) for r in (1.3, 1.8, FAR, 8.0)]
    inside = [differ(r) for r in (NEAR, 2.7, 3.6, 4.6, 5.6)]
    assert max(inside) < 1.05 * max(outside), (inside, outside)
    assert min(outside[:2]) > 2.0 * max(outside[2:])


def test_waves_are_grooves_near_by():
    """From grooves to diffraction and back: shallow scratches of a smooth metal. The mean holds within 2 %: grooves
    differ from waves by 1 %, the noise of a mean over resolved grooves is 0.5 %."""
    vee = Profile(path="/mat/vee", shape="vGroove")
    fields = {"distribution": "linear", "width": 40.0, "pitch": 80.0, "depth": 3.5, "profile": vee, "angle": 0.4}
    material = replace(scenes.scratched(scenes.white_metal(0.01), **fields), wave=Wave())
    lamp = DistantLight(path="/lamp", radiance=np.full(3, 4.0), direction=np.array([0.3, 0.3, -0.9]), angle=1.2)
    lights = [lamp, scenes.dome(0.5)]
    world = scenes.scene([scenes.plane(2.0)], [material], lights, [scenes.place()], look(0.4))
    settings = sw.Settings(width=SIZE, height=SIZE, spp=16, filter="box", integrator="direct")
    plan = sw.make_plan(world, settings)
    assert plan.on("grooves.handover") and plan.on("diffraction")
    means = []
    for ratio in (1.0, 3.0, 4.0, 5.0, 6.0, 12.0):
        # half as many samples a side as ``look`` counts on, grooves of 0.4 of its width
        film = sw.render(replace(world, camera=look(0.4 * ratio * np.sqrt(16 / SPP))), plan)
        means.append(film["color"][..., 1].mean(dtype=float))
    np.testing.assert_allclose(np.array(means[1:]) / means[:-1], 1.0, atol=0.02)


def test_a_thousand_grooves_a_sample():
    """Of model groove to the last, a pixel of 11 cm: looked at by parts, the mean and the noise stay as they are."""
    fields = {"distribution": "crosshatch", "width": 40.0, "pitch": 80.0, "depth": 8.0, "angle": 0.4}
    material = scenes.scratched(ROUGH, model="groove", fresnel="exact", **fields)
    lights = [DistantLight(path="/sun", radiance=np.ones(3), direction=-sheets.TO_LIGHT, angle=0.0)]
    world = scenes.scene([scenes.plane(20.0)], [material], lights, [scenes.place()], look(1.0))
    settings = sw.Settings(width=16, height=16, spp=4, filter="box", integrator="direct")
    plan = sw.make_plan(world, settings)
    assert not plan.on("scratches") and not plan.on("grooves.handover")
    films = [sw.render(replace(world, camera=look(ratio)), plan) for ratio in (4.0, 32.0, 150.0)]
    means, noise = zip(*[(f["color"].mean(dtype=float), f["color"].std()) for f in films], strict=True)
    np.testing.assert_allclose(means, np.mean(means), rtol=0.01)
    assert max(noise[1:]) < 1.1 * noise[0]
    assert films[0].stats["groove_bytes"] < 2000 and films[0].stats["groove_pieces"] == 2


def test_far_away_nothing_of_it_is_compiled():
    """Footprints of 20 grooves: no groove code; nor where it is forced off."""
    world = sheets.world(False, ROUGH, 1.0, 0.0, model="auto")
    asked = {"width": 8, "height": 8, "spp": 1}
    assert sw.make_plan(world, sw.Settings(**asked)).on("grooves.handover")
    assert not sw.make_plan(world, sw.Settings(effects={"grooves.handover": False}, **asked)).on("grooves")
    far = replace(world, camera=replace(world.camera, horizontal_aperture=0.02, vertical_aperture=0.02))
    assert not sw.make_plan(far, sw.Settings(**asked)).on("grooves")


def test_only_what_a_pattern_needs_is_compiled():
    """Parallel lines: no code for crossings; flat facets: none for bounces; forced off or absent: none at all."""

    def key(crossing, effects=None, **fields):
        world = sheets.world(crossing, sheets.LAMBERT, 1.0, 0.0, **fields)
        return kernel_key(world, sw.make_plan(world, sheets.settings(8, 1, effects)))

    parallel, crossed = key(False), key(True)
    assert parallel.grooves and parallel.groove_bounces and not parallel.groove_crossings
    assert crossed.groove_crossings and not crossed.groove_handover
    assert not key(False, depth=0.0).groove_bounces
    for none in (key(True, model="table"), key(True, {"grooves": False})):
        assert not (none.grooves or none.groove_crossings or none.groove_bounces or none.groove_handover)
