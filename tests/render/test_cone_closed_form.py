"""Light along the mirror cone in closed form, against the integral in float64 and against sampling.

Twenty random scenes of a scratched plane: random view, profile, metal or glass, one to three lights of every kind, a
sheet that hides part of them in every other scene. Closed form, sampling of lights, of cones, and both by multiple
importance sampling have to agree within their noise.
"""

from functools import lru_cache

import numpy as np
import pytest

import scratchwarp as sw
from scratchwarp import profiles
from scratchwarp.kernels import kernel_key
from scratchwarp.reflectance.profile_table import rows_to_unit_energy
from scratchwarp.scene import (
    Camera,
    CylinderLight,
    DiskLight,
    DistantLight,
    DomeLight,
    Instance,
    Material,
    Mesh,
    PreviewSurface,
    Profile,
    RectLight,
    ScratchSurface,
    Shaping,
    SphereLight,
    Texture,
)

from . import scenes
from . import test_cone_integrals as integrals

# code for all of the twenty scenes, and no more
LEAN = {name: True for name in ("lights.rect", "lights.disk", "lights.sphere", "lights.distant", "lights.cylinder")} | {
    name: True for name in ("lights.dome", "base.preview", "base.measured", "shadows", "scratches.linear")
}
METHODS = {
    "closed": {"lights.closedForm": True, "lights.sampleLights": True, "lights.sampleCones": True},
    "both": {"lights.closedForm": False, "lights.sampleLights": True, "lights.sampleCones": True},
    "lights": {"lights.closedForm": False, "lights.sampleLights": True, "lights.sampleCones": False},
    "cones": {"lights.closedForm": False, "lights.sampleLights": False, "lights.sampleCones": True},
}


def unit(a):
    return np.asarray(a) / np.linalg.norm(a, axis=-1, keepdims=True)


def random_light(rng, kind, toward):
    center = toward * rng.uniform(0.8, 2.0)
    radiance = rng.uniform(0.5, 4.0, 3)
    side = unit(np.cross(toward, rng.normal(size=3)))
    up = np.cross(side, toward)
    size = rng.uniform(0.2, 1.0, 2)
    tilt = unit(toward + 0.4 * rng.normal(size=3))
    ex, ey = size[0] * unit(np.cross(tilt, up)), size[1] * unit(np.cross(tilt, side))
    if kind == "rect":
        return RectLight(path="/l", radiance=radiance, center=center, ex=ex, ey=ey, normal=-tilt)
    if kind == "disk":
        return DiskLight(path="/l", radiance=radiance, center=center, ex=ex, ey=ey, normal=-tilt)
    if kind == "sphere":
        return SphereLight(path="/l", radiance=radiance, center=center, radius=0.7 * size[0])
    if kind == "distant":
        return DistantLight(path="/l", radiance=radiance, direction=-toward, angle=size[0])
    if kind == "cylinder":
        return CylinderLight(path="/l", radiance=radiance, center=center, axis=size[0] * side, radius=0.3 * size[1])
    return scenes.dome(0.3)


TABLES = {"tables.theta": "table"}


def random_scene(seed):
    rng = np.random.default_rng(seed)
    omega = unit(rng.normal(size=3) * (1, 1, 0.3) + (0, 0, 1))
    right = unit(np.cross((0.0, 1, 0), omega))
    view = np.eye(4)
    view[:3] = np.stack([right, np.cross(omega, right), omega, 0.3 * omega], 1)
    cam = Camera(
        path="/cam", transform=view, projection="orthographic", horizontal_aperture=1e-5, vertical_aperture=1e-5
    )
    kinds = ("rect", "disk", "sphere", "distant", "cylinder", "dome")
    phi_o, cosine = np.arctan2(omega[1], omega[2]), np.sqrt(1 - omega[0] ** 2)

    def on_cone():
        phi = np.clip(rng.normal(-phi_o, 0.4), -1.4, 1.4)
        return np.array([-omega[0], cosine * np.sin(phi), cosine * np.cos(phi)])

    lights = [random_light(rng, kinds[seed % 6], on_cone())]
    lights += [
        random_light(rng, kinds[rng.integers(5)], unit(on_cone() + 0.2 * rng.normal(size=3)))
        for _ in range(rng.integers(3))
    ]
    shape = ("vGroove", "round", "quartic", "rectangle")[seed % 4]
    base = (
        PreviewSurface((0, 0, 0)),
        ScratchSurface("conductor", metal="gold"),
        ScratchSurface("dielectric", ior=1.5),
    )[seed % 3]
    depth = 20 * rng.uniform(0.1, 0.5)
    layer = {"model": "table", "distribution": "linear", "width": 20.0, "pitch": 20.0, "depth": depth}
    material = scenes.scratched(
        base,
        profile=Profile(path="/mat/p", shape=shape),
        fresnel="mirror" if seed % 3 == 0 else "exact",
        **layer,
    )
    meshes, placed = [scenes.plane(0.01)], [Instance("/plane", 0, np.eye(4), (0,))]
    if seed % 2:
        # from the side towards the first light, its edge across the middle
        toward = getattr(lights[0], "center", None)
        toward = unit(toward if toward is not None else -getattr(lights[0], "direction", np.array([0.2, 0.1, -1.0])))
        ex, ey = (unit(np.cross(toward, rng.normal(size=3))) for _ in range(2))
        corners = [0.4 * toward + a * ex + b * ey for a, b in ((0, -0.3), (0.3, -0.3), (0.3, 0.3), (0, 0.3))]
        meshes.append(Mesh("/sheet", [c + [0, 0, max(0.0, 0.01 - c[2])] for c in corners], [[0, 1, 2], [0, 2, 3]]))
        placed.append(Instance("/sheet", 1, np.eye(4), (1,)))
    return scenes.scene(meshes, [material, Material("/black", PreviewSurface((0, 0, 0)))], lights, placed, cam)


@lru_cache
def rendered(seed):
    """(mean, standard error, variance of one sample's luminance) for each method."""
    world, plan, result = random_scene(seed), None, {}
    for name, method in METHODS.items():
        settings = sw.Settings(width=8, height=8, spp=128, filter="box", effects=LEAN | method, knobs=TABLES)
        plan = sw.make_plan(world, settings, plan)
        film = sw.render(world, plan)
        assert film.stats["invalid_samples"] == 0
        mean = film["color"].mean((0, 1), dtype=float)
        variance = film["variance"].mean(dtype=float) * 128
        result[name] = mean, np.sqrt(variance / (64 * 128)), variance
    return result


LUMINANCE = np.array([0.2126, 0.7152, 0.0722])


@pytest.mark.parametrize("seed", range(20))
def test_four_methods_agree(seed):
    """Within 4.5 standard errors of their difference (0.0014 % of normal deviates lie outside; the samples are Sobol
    points, whose errors are smaller than that), and rounding of 8192 additions in float32."""
    found = rendered(seed)
    mean, error, _ = found["closed"]
    for name in ("both", "lights", "cones"):
        other, its_error, _ = found[name]
        assert abs((other - mean) @ LUMINANCE) <= 4.5 * np.hypot(error, its_error) + 1e-4 * (mean @ LUMINANCE), name
        # each channel, by the noise of luminance on a metal's colours
        assert np.abs(other - mean).max() <= 8.0 * np.hypot(error, its_error) / 0.2 + 2e-3 * mean.max(), name


def test_variance_of_the_methods():
    """Over the scenes, as relative variance of one sample: both ways below each alone; the closed form far below."""
    names = ("closed", "both", "lights", "cones")
    lit = [seed for seed in range(20) if rendered(seed)["closed"][0] @ LUMINANCE > 1e-4]
    assert len(lit) >= 15
    spread = np.array([[rendered(s)[n][2] / (rendered(s)["closed"][0] @ LUMINANCE) ** 2 for n in names] for s in lit])
    closed, both, by_lights, by_cones = spread.T
    assert both.mean() < by_lights.mean() and both.mean() < by_cones.mean()
    # two samples by the power heuristic may lose a little to the better one alone, not more
    assert (both < 1.8 * np.minimum(by_lights, by_cones) + 1e-9).all()
    # what is not hidden by a sheet has next to none: colours of a metal at most
    free = np.array([s % 2 == 0 for s in lit])
    assert free.sum() >= 6 and closed[free].max() < 1e-4 < 1e-2 < np.median(both[free])
    assert np.median(closed) < 0.05 * np.median(both)


CLOSED = LEAN | METHODS["closed"]


@pytest.mark.parametrize("size", [0.02, 0.3, 1.6])
@pytest.mark.parametrize("lamp", ["rect", "disk", "sphere", "distant", "cylinder"])
def test_one_sample_is_the_integral(lamp, size):
    """A single sample in each pixel is within 2e-3 of the float64 integral (its 2e5 points in phi miss an edge by up to
    half a step, 8e-6 rad, of a bin of 0.0123), and nothing lies between two pixels."""
    for shape in integrals.PROFILES:
        light, hit = integrals.LAMPS[lamp](size)
        film, table = integrals.shoot(light, shape, effects=CLOSED, spp=1)
        wanted, _ = integrals.expected(table, hit)
        np.testing.assert_allclose(film["color"].reshape(-1, 3), np.tile(wanted, (64, 1)), rtol=2e-3, atol=1e-6)


@pytest.mark.parametrize("lamp", ["rect", "disk", "sphere", "distant", "cylinder"])
def test_half_hidden(lamp):
    """A sheet hides what has x > 0: the shadow ray's direction is drawn without bias."""
    light, hit = integrals.LAMPS[lamp](0.6)
    ex, ey = integrals.EX, integrals.EY
    sheet = [integrals.CENTER / 2 + a * ex + b * ey for a, b in ((0, -0.7), (4, -0.7), (4, 4), (0, 4))]

    def open_hit(w):
        x, y, ahead = integrals.on_plane(w)
        return hit(w) & ~(ahead & (x > 0) & (y > -1.4))

    blocker = Mesh("/sheet", sheet, [[0, 1, 2], [0, 2, 3]])
    film, table = integrals.shoot(light, "round", blocker=blocker, effects=CLOSED)
    wanted, _ = integrals.expected(table, open_hit)
    assert (wanted < 0.95 * integrals.expected(table, hit)[0]).all()
    integrals.agree(film, wanted)


def test_a_cone_that_misses_costs_no_ray():
    """A light off the cone: the camera's ray and the ray from the cone alone, no shadow ray."""
    hit = integrals.LAMPS["sphere"](0.3)[0]
    off = SphereLight(path="/l", radiance=hit.radiance, center=(-2.0, 0.0, 0.4), radius=0.3)
    blocker = Mesh("/far", [[5.0, 5, 5], [6, 5, 5], [5, 6, 5]], [[0, 1, 2]])
    seen, _ = integrals.shoot(hit, "round", blocker=blocker, effects=CLOSED, spp=1)
    missed, _ = integrals.shoot(off, "round", blocker=blocker, effects=CLOSED, spp=1)
    assert missed["color"].max() == 0.0
    assert seen.stats["rays"] - missed.stats["rays"] == 64


def image_at(pixels, w):
    """Bilinear radiance of a latlong image, pole +y, centre +z, towards directions [n, 3], float64."""
    rows, columns = pixels.shape[:2]
    y = np.arctan2(np.hypot(w[:, 0], w[:, 2]), w[:, 1]) / np.pi * rows - 0.5
    x = (0.5 - 0.5 * np.arctan2(w[:, 0], w[:, 2]) / np.pi) * columns - 0.5
    i, j = np.floor(x).astype(int), np.floor(y).astype(int)
    fx, fy = (x - i)[:, None], (y - j)[:, None]

    def texel(row, column):
        return pixels[np.clip(row, 0, rows - 1), column % columns, :3].astype(float)

    upper = texel(j, i) * (1 - fx) + texel(j, i + 1) * fx
    return upper * (1 - fy) + (texel(j + 1, i) * (1 - fx) + texel(j + 1, i + 1) * fx) * fy


def along_cone(table, radiance):
    """int rho cos(phi) radiance(w) dphi in float64; ``radiance``: directions [n, 3] -> [n, 3]."""
    t = profiles.simulate(table.profile, resolution=table.resolution, rays=table.rays, max_bounces=table.max_bounces)
    rho = rows_to_unit_energy(np.asarray(t.mirror, float), t.weights, t.lost)
    bins, n = len(t.weights), 100_000
    at = (integrals.PHI + np.pi / 2) / (np.pi / bins) - 0.5
    low = int(at)
    row = (1 - (at - low)) * rho[low] + (at - low) * rho[low + 1]
    phi = np.pi * ((np.arange(n) + 0.5) / n - 0.5)
    sine, cosine = np.sin(-integrals.THETA), np.cos(integrals.THETA)
    w = np.stack([np.full(n, sine), cosine * np.sin(phi), cosine * np.cos(phi)], 1)
    return ((row[(np.arange(n) * bins) // n] * np.cos(phi))[:, None] * radiance(w)).sum(0) * np.pi / n


@pytest.mark.parametrize("shape", ["round", "rectangle"])
def test_an_image_around_everything(shape):
    """One sample of 16 taps is within a tenth, and the blur that it has is gone with 64; sampling the cone has at least
    five times the error of one sample."""
    rng = np.random.default_rng(5)
    pixels = np.ones((32, 64, 4), np.float32)
    pixels[..., :3] = (0.2 + rng.random((32, 64, 1)) ** 2) * (1.0, 0.8, 0.6)
    dome = DomeLight(path="/dome", radiance=(2.0, 2.0, 2.0), texture=0)
    world = {"textures": (Texture("/sky", pixels),)}
    one, table = integrals.shoot(dome, shape, effects=CLOSED, spp=1, **world)
    wanted = along_cone(table, lambda w: 2.0 * image_at(pixels, w))
    error = np.abs(one["color"] / wanted - 1)
    assert np.sqrt((error**2).mean()) < 0.1
    many, _ = integrals.shoot(dome, shape, effects=CLOSED, spp=64, **world)
    np.testing.assert_allclose(many["color"].mean((0, 1), dtype=float), wanted, rtol=2e-3)
    sampled, _ = integrals.shoot(dome, shape, effects=LEAN | METHODS["cones"], spp=1, **world)
    assert np.sqrt((np.abs(sampled["color"] / wanted - 1) ** 2).mean()) > 5 * np.sqrt((error**2).mean())


def test_shaped_and_textured_lights():
    """Their radiance differs along the arc: 16 taps, at random in their strata, without bias."""
    pixels = np.ones((8, 8, 4), np.float32)
    pixels[..., :3] = np.random.default_rng(3).random((8, 8, 3))
    textured = RectLight(
        path="/l", radiance=(3.0, 2.0, 1.0), center=integrals.CENTER, ex=1.6 * integrals.EX, ey=integrals.EY,
        normal=-integrals.TILT, texture=0,
    )  # fmt: skip
    focused = SphereLight(
        path="/l", radiance=(3.0, 2.0, 1.0), center=integrals.CENTER, radius=1.2, axis=-integrals.TILT,
        shaping=Shaping(focus=20.0, cone_angle=0.6, cone_softness=0.5),
    )  # fmt: skip
    for light in (textured, focused):
        world = {"textures": (Texture("/t", pixels),)}
        closed, _ = integrals.shoot(light, "round", effects=CLOSED, spp=64, **world)
        both, _ = integrals.shoot(light, "round", effects=LEAN | METHODS["both"], spp=512, **world)
        mean, other = (film["color"].mean((0, 1), dtype=float) for film in (closed, both))
        assert mean.min() > 1e-3
        assert closed["variance"].mean() < 0.05 * both["variance"].mean() * 8
        np.testing.assert_allclose(mean, other, rtol=5e-3)


def test_what_is_chosen():
    world = random_scene(0)
    plan = sw.make_plan(world)
    assert plan.on("lights.closedForm") and "lights.closedForm" in plan.explain()
    assert not plan.on("lights.sampleLights")
    key = kernel_key(world, plan)
    assert key.closed_form and not key.cone_taps
    off = {"lights.closedForm": False}
    assert not kernel_key(world, sw.make_plan(world, sw.Settings(effects=off))).closed_form
    bare = kernel_key(world, sw.make_plan(world, sw.Settings(effects={"scratches": False})))
    assert not (bare.closed_form or bare.sample_lights or bare.sample_cones)
    blind = off | {"lights.sampleLights": False, "lights.sampleCones": False}
    with pytest.raises(ValueError, match="sampleLights and lights.sampleCones are both off"):
        sw.make_plan(world, sw.Settings(effects=blind))
    for table in plan.tables:
        assert table.fresnel is None or table.theta_model in ("quadratic", "table")
