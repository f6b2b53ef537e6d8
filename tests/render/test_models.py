"""Models that stand beside Raymond's table, as rendered: what each does to energy, and which code it brings along."""

from dataclasses import replace

import numpy as np
import pytest

import scratchwarp as sw
from scratchwarp import mdf, profiles, stencils
from scratchwarp.kernels import kernel_key
from scratchwarp.scene import (
    Camera,
    Instance,
    Material,
    Measured,
    NormalMap,
    Profile,
    RectLight,
    ScratchSurface,
    Texture,
)

from . import scenes

IRON = ScratchSurface(base="conductor", metal="iron", roughness=0.0)
STEEP = Profile(path="/mat/p", shape="quartic")


# two kernels for this file: with the lobe's code and without
LEAN = {"lights.dome": True, "lights.rect": True, "lights.closedForm": False}
ABOVE = scenes.camera(2.4, projection="orthographic")


def brushed(model="auto", fresnel="exact", **fields):
    fields = {"distribution": "linear", "width": 50.0, "pitch": 50.0, "depth": 25.0, "profile": STEEP, **fields}
    material = scenes.scratched(IRON, model=model, fresnel=fresnel, **fields)
    return scenes.scene([scenes.sphere()], [material], [scenes.dome()], cam=ABOVE)


def seen(model, fresnel="mirror"):
    """Mean over a ball under a white dome."""
    film = scenes.shoot(brushed(fresnel=fresnel), LEAN, model=model)
    assert film.stats["invalid_samples"] == 0 and film["color"].max() < 1.0 + 1e-3
    return film["color"][film["alpha"] == 1.0].mean(0, dtype=float)


def test_what_each_model_loses():
    """Figure 7: only inter-reflections bring all light back; masking and one lobe lose that of later bounces."""
    assert seen("table") == pytest.approx(1.0, abs=1e-4)
    assert seen("mirror", "exact") == pytest.approx(1.0, abs=1e-4)
    single = seen("singleBounce")
    facing = profiles.simulate(profiles.shape("quartic", depth=0.5), resolution=64).by_bounce[0]
    assert 0.3 < single[0] < 0.75 and facing.max() > 0.0
    assert seen("tabulatedNdf") == pytest.approx(single, abs=0.05)
    assert seen("ashikhminShirley") == pytest.approx(single, abs=0.1)
    # every theta by Eq. 2 within 1 % of albedo, or at 33 angles
    assert seen("fullTable", "exact") == pytest.approx(seen("table", "exact"), abs=0.01)


def test_a_model_brings_its_own_code_alone():
    def planned(**settings):
        world = brushed()
        return kernel_key(world, sw.make_plan(world, sw.Settings(**settings)))

    assert planned().responses == () and planned() == planned(model="tabulatedNdf") == planned(model="fullTable")
    assert planned(model="ashikhminShirley").responses == ("ashikhminShirley",)
    off = sw.make_plan(brushed("ashikhminShirley"), sw.Settings(effects={"scratches.ashikhminShirley": False}))
    assert not any(off.layers) and off.tables == ()
    assert kernel_key(brushed("ashikhminShirley"), off).responses == ()


def test_plans_name_their_models():
    plan = sw.make_plan(brushed("ashikhminShirley"))
    assert plan.effects["scratches.ashikhminShirley"].prims == ("/mat layer 'fine'",) and not plan.warnings
    assert len(plan.responses) == 1 and plan.tables == ()
    both = brushed("singleBounce")
    layers = (both.materials[0].layers[0], replace(both.materials[0].layers[0], name="other", model="table"))
    tables = sw.make_plan(replace(both, materials=(replace(both.materials[0], layers=layers),))).tables
    assert [t.max_bounces for t in tables] == [1, 2000] and [t.source for t in tables] == ["traced", "traced"]
    with pytest.raises(ValueError, match="glitter"):
        sw.Settings(model="glitter")


def test_facet_tables():
    """A V groove at 45 degrees seen from above: each wall mirrors half of the light to the side, masking takes none of
    what its facets' distribution allows and the tracer's first bounce has the same directions."""
    for shape, depth in (("quartic", 0.2), ("round", 0.2)):
        profile = profiles.shape(shape, depth=depth)
        made = profiles.facet_table(profile, resolution=64)
        traced = profiles.simulate(profile, resolution=64).by_bounce[0]
        np.testing.assert_allclose(made.mirror, made.mirror.T, atol=1e-6)
        energy = made.weights @ made.mirror
        assert energy.max() < 1.02 and np.allclose(energy + made.lost, np.maximum(energy, 1.0), atol=1e-6)
        # shallow and seen from near the normal nothing is hidden, so that both are the facets' distribution
        middle = slice(26, 38)
        both = [m[:, middle].T @ made.weights for m in (made.mirror, traced)]
        np.testing.assert_allclose(both[0], both[1], atol=0.06)
        spread = made.weights * made.angles**2
        angles = [m[:, middle].T @ spread for m in (made.mirror, traced)]
        np.testing.assert_allclose(angles[0], angles[1], rtol=0.15)


@pytest.mark.parametrize("size", [0.05, 0.8])
def test_lobes_under_a_lamp(size):
    """A plane of Ashikhmin-Shirley scratches under a rectangle, against the sum over its area in float64.

    Light sampling and sampling of the lobe are combined: the small lamp is found by the one, the large by both.
    """
    theta, phi = np.radians(-25), np.radians(12)
    omega = np.array([np.sin(theta), np.cos(theta) * np.sin(phi), np.cos(theta) * np.cos(phi)])
    toward = np.array([np.sin(-theta), np.cos(theta) * np.sin(0.3), np.cos(theta) * np.cos(0.3)])
    side = np.cross((0.0, 1, 0), toward) / np.linalg.norm(np.cross((0.0, 1, 0), toward))
    up = np.cross(toward, side)
    lamp = RectLight(path="/l", radiance=(3, 2, 1), center=2 * toward, ex=size * side, ey=size * up, normal=-toward)
    right = np.cross((0.0, 1, 0), omega) / np.linalg.norm(np.cross((0.0, 1, 0), omega))
    view = np.eye(4)
    view[:3] = np.stack([right, np.cross(omega, right), omega, 0.5 * omega], 1)
    cam = Camera(
        path="/cam", transform=view, projection="orthographic", horizontal_aperture=1e-5, vertical_aperture=1e-5
    )
    world = brushed("ashikhminShirley", "mirror")
    world = scenes.scene([scenes.plane(0.1)], world.materials, [lamp], [Instance("/p", 0, np.eye(4), (0,))], cam)
    film = scenes.shoot(world, LEAN, width=16, height=16, spp=512)
    plan = sw.make_plan(world)
    s = (np.arange(400) + 0.5) / 400 * 2 - 1
    x, y = np.meshgrid(s, s, indexing="ij")
    to = 2 * toward + size * (x[..., None] * side + y[..., None] * up)
    far = np.linalg.norm(to, axis=-1)
    wi = to / far[..., None]
    f = mdf.evaluate(plan.responses[0].values, wi, np.broadcast_to(omega, wi.shape))
    wanted = (f * wi[..., 2] * (wi @ toward) / far**2).mean() * 4 * size**2 * np.array([3.0, 2, 1])
    found = film["color"].mean((0, 1), dtype=float)
    noise = np.sqrt(film["variance"].sum()) / film["variance"].size / found.mean()
    assert wanted.min() > 1e-3 and noise < 0.02
    np.testing.assert_allclose(found, wanted, rtol=2e-3 + 4 * noise)


def stencil_material(**fields):
    """Two bright modes, which return more light than comes unless energy is conserved."""
    modes = {"azimuth": (0.3, 1.4), "width": (0.4, 0.5), "a": (0.9, 0.9), "b": (0.05, 0.0), "kd": (0.1, 0.1)}
    modes |= {"ks": (2.0, 1.0), "alpha": (9.0, 20.0), "color": ((1, 0.8, 0.5), (0.4, 0.6, 1)), "background": 0.3}
    return Material("/measured", measured=Measured(**{**modes, **fields}))


def mapped(**fields):
    n = mdf.scratch_map(64, density=60, length=0.4, width=0.05, depth=0.25, direction=0.5, spread=0.2)
    texture = Texture("/n", np.concatenate([0.5 * n + 0.5, np.ones((64, 64, 1))], axis=-1))
    record = NormalMap(0, (3, 3), **fields)
    return scenes.scratched(IRON, model="normalMap", normal_map=record, fresnel="mirror"), texture


def test_other_responses_in_the_furnace():
    """A stencil base and a scratch normal map return no more than came, between bodies along paths neither."""
    layer, texture = mapped()
    both = replace(stencil_material(), layers=(replace(layer.layers[0], normal_map=NormalMap(0), model="table"),))
    materials = [stencil_material(), layer, both]
    placed = [Instance(f"/{n}", 0, scenes.place(at=(1.3 * n - 1.3, 0, -6)).transform, (n,)) for n in range(3)]
    world = scenes.scene(
        [scenes.sphere(12, 24, radius=0.6)],
        materials,
        [scenes.dome()],
        placed,
        scenes.camera(30.0),
        textures=(texture,),
    )
    plan = sw.make_plan(world)
    assert plan.on("base.stencils") and plan.on("scratches.normalMap") and not plan.on("scratches.ashikhminShirley")
    film = scenes.shoot(
        world, {"lights.closedForm": False}, width=48, height=24, spp=256, integrator="path", max_depth=6
    )
    assert film.stats["invalid_samples"] == 0
    assert (film["color"].max(-1) <= 1.0 + 1e-4 + 6 * np.sqrt(film["variance"])).all()
    for number in range(3):
        seen_there = film["primId"] == number
        assert seen_there.sum() > 50 and 0.3 < film["color"][seen_there].mean() < 1.0
    assert film["scratches"][film["primId"] == 0].max() == 0.0 and film["base"][film["primId"] == 1].max() == 0.0


def test_stencils_as_rendered():
    """One direction under a dome: the albedo of the model that conserves energy, turned with the mapping."""
    world = scenes.scene([scenes.plane(9.0)], [stencil_material()], [scenes.dome()])
    film = scenes.shoot(world, LEAN, width=8, height=8, spp=1024)
    plan = sw.make_plan(world)
    u = np.random.default_rng(0).random((200_000, 3))
    wanted = stencils.sample(plan.responses[0].values, (0.0, 0.0, 1.0), u, energy_conserving=True).weight.mean(0)
    # the corners are seen at 16 degrees
    np.testing.assert_allclose(film["color"].mean((0, 1)), wanted, rtol=0.03)
    lamp = RectLight(
        path="/l", radiance=(9, 9, 9), center=(2, 0, -4), ex=(0, 0.01, 0), ey=(0, 0, 0.01), normal=(-1, 0, 0)
    )
    lit = []
    for azimuth in ((0.0, 0.2), (np.pi / 2, np.pi / 2 - 0.2)):
        material, near = stencil_material(azimuth=azimuth), scenes.camera(focal=5000.0)
        world = scenes.scene([scenes.plane(9.0)], [material], [lamp], cam=near)
        lit.append(scenes.shoot(world, LEAN, width=8, height=8, spp=64)["color"].mean((0, 1)))
        direction, view = np.array([np.sqrt(0.5), 0.0, np.sqrt(0.5)]), (0.0, 0.0, 1.0)
        model = sw.make_plan(world).responses[0].values
        f = stencils.evaluate(model, direction, view, energy_conserving=True)
        # the lamp of 4 cm^2 stands 2 sqrt(2) m away at 45 degrees to it and to the surface
        np.testing.assert_allclose(lit[-1], f * 9 * 4e-4 * 0.5 / 8.0, rtol=0.02)
    # half vectors towards +x are on the ridge of scratches along y
    assert lit[1].min() > 5 * lit[0].min()
