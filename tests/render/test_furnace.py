"""White furnace: under a dome of radiance 1 a lossless convex body cannot be seen.

A mirror, scratched or not, returns 1 for each sample up to rounding. The largest part of that is the share of a table's
bin, a difference of float32 cumulative sums: an error of 6e-8 / share, met with probability ``share``. Over the 7e4
samples of an image shares down to 1e-5 are met, which is 6e-3 of a sample and 4e-4 of its pixel of 16 samples; the mean
over all pixels keeps 6e-8 times the number of bins, 1.5e-5. A Lambert base is noise around 1; each pixel's own variance
estimate says how much, and 6 standard deviations over some 10^5 pixels are met by chance once in a thousand runs.
"""

import numpy as np
import pytest

from scratchwarp.scene import Instance, Material, PreviewSurface, Profile, ScratchSurface

from . import scenes

DISTRIBUTIONS = ("worley", "random", "linear", "concentric", "spiral", "crosshatch")
COVERAGES = (0.0, 0.1, 0.5, 0.9, 1.0)
BODIES = {
    "smooth sphere": scenes.sphere(),
    "faceted sphere": scenes.sphere(12, 24, smooth=False),
    "box": scenes.box(1.3),
    "cone": scenes.cone(),
}
TURN = np.array([[0.8, 0, 0.6], [0.36, 0.8, -0.48], [-0.48, 0.6, 0.64]])


def layers(surface, shape):
    """Every distribution at every coverage; scratches below a footprint (50 um) and far above it (40 mm)."""
    profile = Profile(path="/mat/profile", shape=shape)
    made = []
    for distribution in DISTRIBUTIONS:
        for number, coverage in enumerate(COVERAGES):
            width = (50.0, 40000.0)[(number + len(made)) % 2]
            # regular patterns cover width / pitch; of the two sets of a crosshatch each covers that
            fields = {"width": width if coverage else 0.0, "pitch": width / (coverage or 1.0), "angle": 0.3}
            fields |= {"coverage": coverage, "depth": 0.5 * width, "length": 30.0 * width, "profile": profile}
            made.append(scenes.scratched(surface, distribution=distribution, **fields))
    return made


def look(body, materials, **settings):
    mesh = scenes.slotted(body, len(materials))
    transform = np.eye(4)
    transform[:3, :3], transform[2, 3] = TURN, -6.0
    placed = Instance(path="/body", mesh=0, transform=transform, materials=tuple(range(len(materials))))
    return scenes.shoot(scenes.scene([mesh], materials, [scenes.dome()], [placed]), **settings)


def excess(film):
    """Deviation from 1 of each pixel, with background behind the silhouette and all, in standard deviations."""
    sigma = np.sqrt(film["variance"])
    off = np.abs(film["color"] - 1.0).max(-1)
    return np.maximum(off - 1e-4, 0.0) / np.maximum(sigma, 1e-9), off


@pytest.mark.parametrize("shape", ["vGroove", "round", "rectangle", "quartic"])
@pytest.mark.parametrize("body", BODIES)
def test_mirrors_vanish(body, shape):
    film = look(BODIES[body], layers(scenes.white_metal(), shape), width=64, height=64)
    assert film.stats["invalid_samples"] == 0
    covered = film["alpha"] == 1.0
    assert covered.sum() > 300
    assert film["scratches"][covered].mean() > 0.1 and film["base"][covered].mean() > 0.1
    assert np.abs(film["color"] - 1.0).max() < 1e-3
    assert abs(film["color"].mean(dtype=float) - 1.0) < 1.5e-5


@pytest.mark.parametrize(("body", "shape"), zip(BODIES, ["round", "rectangle", "vGroove", "quartic"], strict=True))
def test_scratched_white_paper_vanishes(body, shape):
    film = look(BODIES[body], layers(scenes.lambert(), shape), width=64, height=64, spp=128)
    assert film.stats["invalid_samples"] == 0
    deviations, off = excess(film)
    assert deviations.max() < 6.0
    inside = film["alpha"] == 1.0
    noise = np.sqrt(film["variance"][inside].sum()) / inside.sum()
    assert 0.0 < noise < 5e-4
    assert abs(film["color"][inside].mean() - 1.0) < 1e-3 + 4 * noise


def test_lambert_scratches_on_lambert_ground_vanish():
    materials = [scenes.scratched(scenes.lambert(), material="diffuse", diffuse_color=(1.0, 1.0, 1.0), fresnel="exact")]
    film = look(scenes.sphere(), materials, spp=64)
    deviations, _ = excess(film)
    assert deviations.max() < 6.0 and film["base"].mean() > 0.2


@pytest.mark.parametrize("roughness", [0.05, 0.3, 0.7, 1.0])
@pytest.mark.parametrize("metal", [True, False])
def test_rough_surfaces_never_gain_energy(metal, roughness):
    """GGX without multiple scattering loses light; beyond the noise it never returns more than came."""
    if metal:
        surface = ScratchSurface(base="conductor", metal="custom", eta=(1e-3,) * 3, k=(1e3,) * 3, roughness=roughness)
    else:
        surface = ScratchSurface(base="dielectric", color=(1.0, 1.0, 1.0), roughness=roughness)
    film = look(scenes.sphere(), [Material(path="/mat", surface=surface)], width=64, height=64, spp=64)
    assert film.stats["invalid_samples"] == 0
    assert (film["color"].max(-1) <= 1.0 + 1e-5 + 6 * np.sqrt(film["variance"])).all()
    inside = film["alpha"] == 1.0
    noise = np.sqrt(film["variance"][inside].sum()) / inside.sum()
    assert 0.3 < film["color"][inside].mean() < 1.0 + 4 * noise


@pytest.mark.parametrize("mode", ["transparent", "presence"])
@pytest.mark.parametrize("opacity", [0.0, 0.3, 0.9])
def test_a_pane_vanishes(mode, opacity):
    """What specular reflection and the white diffuse part do not return passes straight through."""
    surface = PreviewSurface(diffuse_color=(1.0, 1.0, 1.0), roughness=0.0, ior=1.8, opacity=opacity, opacity_mode=mode)
    film = look(scenes.plane(1.8), [Material(path="/mat", surface=surface)], spp=256)
    deviations, _ = excess(film)
    assert deviations.max() < 6.0
    assert abs(film["color"].mean() - 1.0) < 1e-3
    # 8 % are reflected at the normal, nothing by an absent surface
    middle = film["alpha"][14:18, 14:18]
    glass = 1.0 - (1.0 - opacity) * (0.92 if mode == "transparent" else 1.0)
    assert middle.mean() == pytest.approx(glass, abs=0.02)


def test_dielectric_scratches_on_glass_are_seen():
    """They reflect about what the glass does: light lost or gained is that difference, a part of 8 % of the half."""
    surface = PreviewSurface(roughness=0.0, ior=1.8, opacity=0.0)
    film = look(scenes.plane(1.8), [scenes.scratched(surface, fresnel="exact")], spp=256)
    inside = film["alpha"] > 0.07
    assert inside.sum() > 300
    assert film["scratches"][inside].mean() > 0.03 and film["base"][inside].mean() > 0.03
    assert abs(film["color"][inside].mean() - 1.0) < 0.04


def test_light_between_bodies_vanishes():
    """Paths between white scratched bodies bring back all light; only those of more than 64 surfaces are cut off."""
    mirrors = layers(scenes.white_metal(), "round")[:12]
    paper = scenes.scratched(scenes.lambert(), coverage=0.4)
    ball = scenes.sphere(radius=0.8)
    meshes = [scenes.slotted(ball, 12), ball, scenes.plane(6.0, axis="y")]
    places = [(-0.9, 0, -6), (0.9, 0.2, -5.5), (0, -1, -6)]
    owned = [tuple(range(12)), (12,), (12,)]
    placed = [
        Instance(path=f"/{n}", mesh=n, transform=scenes.place(at=where).transform, materials=slots)
        for n, (where, slots) in enumerate(zip(places, owned, strict=True))
    ]
    world = scenes.scene(meshes, [*mirrors, paper], [scenes.dome()], placed, scenes.camera(30.0))
    film = scenes.shoot(world, spp=256, integrator="path", max_depth=64)
    assert film.stats["invalid_samples"] == 0 and film["scratches"].mean() > 0.1
    deviations, _ = excess(film)
    assert deviations.max() < 6.0
    noise = np.sqrt(film["variance"].sum()) / film["variance"].size
    assert noise < 2e-3 and abs(film["color"].mean() - 1.0) < 1e-3 + 4 * noise
    assert abs(scenes.shoot(world, spp=16)["color"].mean() - 1.0) > 0.05


@pytest.mark.parametrize("opacity", [0.0, 0.3])
def test_mirror_scratches_on_glass_vanish(opacity):
    """Nothing passes through them, so that the pane sends on what they leave uncovered."""
    surface = PreviewSurface(diffuse_color=(1.0, 1.0, 1.0), roughness=0.0, ior=1.8, opacity=opacity)
    film = look(scenes.plane(1.8), [scenes.scratched(surface, fresnel="mirror")], spp=256)
    deviations, _ = excess(film)
    assert deviations.max() < 6.0 and film["scratches"].mean() > 0.1
    assert abs(film["color"].mean() - 1.0) < 1e-3
