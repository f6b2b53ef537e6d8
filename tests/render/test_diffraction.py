"""Diffraction in rendered images against the float64 library and in closed form."""

from dataclasses import replace

import numpy as np
import pytest

import scratchwarp as sw
from scratchwarp import diffraction
from scratchwarp.kernels import kernel_key
from scratchwarp.reflectance.diffraction.color import spectral_samples
from scratchwarp.scene import (
    Camera,
    Curves,
    CylinderLight,
    DiskLight,
    DistantLight,
    DomeLight,
    Layer,
    Material,
    PreviewSurface,
    Profile,
    RectLight,
    ScratchSurface,
    SphereLight,
    Texture,
    Wave,
)

from . import scenes

SIGMA = 60.0
LUMINANCE = np.array([0.2126, 0.7152, 0.0722])
LENGTH = 0.004
"""Of the one scratch [m]."""
# one kernel for all tests: its code does not depend on which of these lights are there
LIGHTS = {f"lights.{name}": True for name in ("distant", "sphere", "rect", "disk", "cylinder", "mesh", "dome")}
COMPILED = {**LIGHTS, "shadows": True}
WAVES = ("lists", "hierarchy", "areaLights", "segments", "bands", "coherent", "lookup", "outlines", "angles")
WAVES += ("pairs", "masks", "orientation", "distantLookup")
COMPILED |= {f"diffraction.{name}": True for name in WAVES}


def black():
    """A base that reflects nothing."""
    return PreviewSurface(diffuse_color=(0, 0, 0), specular_color=(0, 0, 0), use_specular_workflow=True)


def waves(**fields):
    """A material whose scratches of mirror floor diffract."""
    surface = fields.pop("surface", black())
    wave = fields.pop("wave", Wave(coherence_radius=SIGMA))
    fields = {"distribution": "curves", "curves": (0,), "fresnel": "mirror", "width": 3.0, "depth": 1.0, **fields}
    profile = Profile(path="/mat/box", shape=fields.pop("shape", "rectangle"))
    layer = Layer(name="fine", prim="/mat", profile=profile, **fields)
    return Material(path="/mat", surface=surface, layers=(layer,), wave=wave)


def stroke(angle, width=3.0, depth=1.0, away=1.0, length=LENGTH):
    """One straight scratch through the middle of the view."""
    end = 0.5 * length * np.array([np.cos(angle), np.sin(angle), 0.0])
    points = np.array([-end, end]) - [0, 0, away]
    return Curves("/c", points, np.array([2]), np.full(2, width), np.full(2, depth))


def straight_down(size=0.006):
    """A view along -z of a square of ``size`` metres, all rays parallel."""
    return Camera(
        path="/cam",
        transform=np.eye(4),
        horizontal_aperture=size,
        vertical_aperture=size,
        projection="orthographic",
    )


def render(material, light, curves, spp=1, size=16, camera=None, effects=None, **settings):
    floor = scenes.place(0, 0, (0, 0, -1))
    cam = camera or straight_down()
    world = scenes.scene([scenes.plane(0.02)], [material], [light], instances=[floor], cam=cam, curves=curves)
    asked = {"width": size, "height": size, "spp": spp, "filter": "box", **settings}
    return sw.render(world, sw.make_plan(world, sw.Settings(effects={**COMPILED, **(effects or {})}, **asked)))


def flux(film, size=0.006):
    """Radiance of the scratch summed over the area of the view [m^2]."""
    return film["scratches"].astype(float).mean((0, 1)) * size**2


def toward(azimuth, elevation):
    """A direction above the surface."""
    return np.array([np.cos(elevation) * np.cos(azimuth), np.cos(elevation) * np.sin(azimuth), np.sin(elevation)])


@pytest.mark.parametrize("angle, depth", [(0.3, 1.0), (2.0, 2.7)])
def test_distant_light_against_the_library(angle, depth):
    """All light of one scratch: f E cos theta sqrt(pi) sigma length. The end of the scratch and the raster of the
    Gaussian footprint (3.2 of its deviations are kept: 1.4e-3) and the seam of two triangles set the tolerance."""
    omega_i = toward(angle + np.pi / 2, 1.2)
    light = DistantLight(path="/l", radiance=np.full(3, 2.0), direction=-omega_i)
    film = render(waves(), light, (stroke(angle, depth=depth),), spp=64)
    at, weights = spectral_samples(16)
    f = diffraction.brdf(omega_i, np.array([0, 0, 1.0]), diffraction.Scratch(3.0, depth, angle, 0.0, SIGMA), at)
    expected = 2.0 * omega_i[2] * np.sqrt(np.pi) * SIGMA * 1e-6 * LENGTH * (f @ weights)
    # gamut mapping keeps the luminance
    assert flux(film) @ LUMINANCE == pytest.approx(expected @ LUMINANCE, rel=1e-2, abs=0.0)


def test_exact_footprint_holds_as_much():
    """The mean over an ellipse in place of a Gaussian moves light, and loses none: the same closed form."""
    omega_i = toward(0.3 + np.pi / 2, 1.2)
    light = DistantLight(path="/l", radiance=np.full(3, 2.0), direction=-omega_i)
    material, curves, floor = waves(), (stroke(0.3),), [scenes.place(0, 0, (0, 0, -1))]
    world = scenes.scene([scenes.plane(0.02)], [material], [light], instances=floor, cam=straight_down(), curves=curves)
    asked = {"width": 16, "height": 16, "spp": 64, "filter": "box"}
    film = sw.render(world, sw.make_plan(world, sw.Settings(effects={"diffraction.exactFootprint": True}, **asked)))
    at, weights = spectral_samples(16)
    f = diffraction.brdf(omega_i, np.array([0, 0, 1.0]), diffraction.Scratch(3.0, 1.0, 0.3, 0.0, SIGMA), at)
    expected = 2.0 * omega_i[2] * np.sqrt(np.pi) * SIGMA * 1e-6 * LENGTH * (f @ weights)
    assert flux(film) @ LUMINANCE == pytest.approx(expected @ LUMINANCE, rel=1e-2, abs=0.0)


@pytest.mark.parametrize("kind", ["sphere", "rect"])
@pytest.mark.parametrize("offset", [0.0, 0.004, 0.012])
def test_area_lights_against_the_library(kind, offset):
    """A light 1 m away whose middle is ``offset`` off the line xi_1 = 0: inside, at its edge, beyond. A scratch of 0.2
    mm, along which directions hardly change, so that spreading them over the footprint may leave 2 %."""
    angle, size = 0.5, 0.01
    u, v = np.array([np.cos(angle), np.sin(angle), 0.0]), np.array([-np.sin(angle), np.cos(angle), 0.0])
    center = 0.6 * v + np.array([0, 0, 0.8]) + offset * u
    ex, ey = size * u, size * np.cross(center, u)
    if kind == "sphere":
        light = SphereLight(path="/l", radiance=np.full(3, 2.0), center=center - [0, 0, 1], radius=size)
        known = diffraction.SphereLight(center, size)
    else:
        normal = -center / np.linalg.norm(center)
        light = RectLight(path="/l", radiance=np.full(3, 2.0), center=center - [0, 0, 1], ex=ex, ey=ey, normal=normal)
        known = diffraction.PolygonLight(center + np.array([-ex - ey, ex - ey, ex + ey, -ex + ey]))
    length = 2e-4
    film = render(waves(), light, (stroke(angle, length=length),), spp=64, camera=straight_down(0.001))
    at, weights = spectral_samples(16)
    one = diffraction.Scratch(3.0, 1.0, angle, 0.0, SIGMA)
    f = diffraction.radiance(known, np.array([0, 0, 1.0]), one, at, slices=16)
    expected = 2.0 * np.sqrt(np.pi) * SIGMA * 1e-6 * length * (f @ weights)
    # beyond the edge, 1e-3 of the light, three middle wavelengths of the Gaussian along show: 5 %
    within = 0.03 if offset < 0.01 else 0.05
    assert flux(film, 0.001) @ LUMINANCE == pytest.approx(expected @ LUMINANCE, rel=within, abs=0.0)


@pytest.mark.parametrize("kind", ["disk", "cylinder"])
def test_round_lights_against_polygons(kind):
    """A disk against a regular 90-gon, a thin cylinder against the rectangle that it looks like from afar (its near
    side is closer by radius / distance = 1 %): 3 % as above."""
    angle, size, length = 0.5, 0.01, 2e-4
    u = np.array([np.cos(angle), np.sin(angle), 0.0])
    center = np.array([-0.6 * np.sin(angle), 0.6 * np.cos(angle), 0.8])
    normal = -center / np.linalg.norm(center)
    ex, ey = size * u, size * np.cross(normal, u)
    fields = {"path": "/l", "radiance": np.full(3, 2.0), "center": center - [0, 0, 1]}
    if kind == "disk":
        light = DiskLight(**fields, ex=ex, ey=ey, normal=normal)
        turn = np.linspace(0, 2 * np.pi, 90, endpoint=False)[:, None]
        known = diffraction.PolygonLight(center + np.cos(turn) * ex + np.sin(turn) * ey)
    else:
        light = CylinderLight(**fields, axis=3 * ey, radius=size)
        known = diffraction.PolygonLight(center + np.array([-ex - 3 * ey, ex - 3 * ey, ex + 3 * ey, -ex + 3 * ey]))
    film = render(waves(), light, (stroke(angle, length=length),), spp=64, camera=straight_down(0.001))
    at, weights = spectral_samples(16)
    one = diffraction.Scratch(3.0, 1.0, angle, 0.0, SIGMA)
    f = diffraction.radiance(known, np.array([0, 0, 1.0]), one, at, slices=16)
    expected = 2.0 * np.sqrt(np.pi) * SIGMA * 1e-6 * length * (f @ weights)
    assert flux(film, 0.001) @ LUMINANCE == pytest.approx(expected @ LUMINANCE, rel=0.03, abs=0.0)


@pytest.mark.parametrize("shape, phase", [("vGroove", "smallAngle"), ("rectangle", "angleDependent")])
def test_cross_sections_and_phases_against_the_library(shape, phase):
    """A V groove, and a depth that counts with the cosines of both directions, under a small sphere: 3 % as above."""
    angle, size, length = 0.5, 0.01, 2e-4
    center = np.array([-0.6 * np.sin(angle), 0.6 * np.cos(angle), 0.8])
    light = SphereLight(path="/l", radiance=np.full(3, 2.0), center=center - [0, 0, 1], radius=size)
    material = waves(shape=shape, wave=Wave(coherence_radius=SIGMA, phase=phase))
    film = render(material, light, (stroke(angle, length=length),), spp=64, camera=straight_down(0.001))
    at, weights = spectral_samples(16)
    profile = sw.profiles.shape(shape, depth=1.0 / 3.0, isolated=True) if shape != "rectangle" else None
    one = diffraction.Scratch(3.0, 1.0, angle, 0.0, SIGMA, profile=profile)
    how = "small-angle" if phase == "smallAngle" else "angle-dependent"
    known = diffraction.SphereLight(center, size)
    f = diffraction.radiance(known, np.array([0, 0, 1.0]), one, at, phase=how, slices=16)
    expected = 2.0 * np.sqrt(np.pi) * SIGMA * 1e-6 * length * (f @ weights)
    assert flux(film, 0.001) @ LUMINANCE == pytest.approx(expected @ LUMINANCE, rel=0.03, abs=0.0)


@pytest.mark.parametrize("shape", ["vGroove", "rectangle"])
def test_tables_of_wide_lights_against_wavelengths(shape):
    """The same dome by the table of colours and by 64 wavelengths: the table is linear between depths 6 nm apart, 0.5 %
    of a fringe."""
    films = [
        render(waves(shape=shape, wave=Wave(SIGMA, samples=64, sampling=how)), scenes.dome(), (stroke(0.3),), size=4)
        for how in ("lookup", "wavelengths")
    ]
    looked, sampled = (flux(f) for f in films)
    np.testing.assert_allclose(looked, sampled, rtol=1e-2)


def apart(film, want):
    """Relative root mean square of what two images have of scratches."""
    return np.sqrt(np.mean((film["scratches"] - want["scratches"]) ** 2) / np.mean(want["scratches"] ** 2))


@pytest.mark.parametrize("depth", [0.4, 1.3, 5.2])
def test_distant_lights_by_table_by_wavelengths_and_by_three(depth):
    """The table is exact where the footprint spreads nothing, as 64 wavelengths all but are (5e-4); three of them are a
    rainbow."""
    omega_i = toward(0.3 + np.pi / 2, 1.25)
    light = DistantLight(path="/l", radiance=np.full(3, 2.0), direction=-omega_i)
    films = [
        render(waves(wave=Wave(SIGMA, samples=64, sampling=how), depth=depth), light, (stroke(0.3, depth=depth),))
        for how in ("wavelengths", "lookup", "rgb")
    ]
    assert apart(films[1], films[0]) < 2e-3
    assert apart(films[2], films[0]) > 0.1
    # beside the line xi_1 = 0, where the Gaussian along has fallen to a third
    aside = omega_i + 1.05 * 0.55 / (2 * np.pi * SIGMA) * np.array([np.cos(0.3), np.sin(0.3), 0.0])
    light = DistantLight(path="/l", radiance=np.full(3, 2.0), direction=-aside / np.linalg.norm(aside))
    films = [
        render(waves(wave=Wave(SIGMA, samples=64, sampling=how), depth=depth), light, (stroke(0.3, depth=depth),))
        for how in ("wavelengths", "lookup")
    ]
    assert apart(films[1], films[0]) < 2e-3


def test_images_of_domes_against_the_library():
    """A scratch under a sky that is bright in one part, relative to an even one, seen along the normal: the library's
    quadrature over the half sphere. 7 parts on either side, each with its mean: 3 %."""
    angle, rows, columns = 0.5, 32, 64
    polar = (np.arange(rows)[:, None] + 0.5) / rows * np.pi
    around = np.pi - (np.arange(columns) + 0.5) / columns * 2.0 * np.pi  # from +Z towards +X
    ring = np.sin(polar)
    w = np.stack([ring * np.sin(around), np.cos(polar) * np.ones(columns), ring * np.cos(around)], axis=-1)
    warm = 0.2 + np.exp(3.0 * (w @ toward(angle + np.pi / 2, 1.1)) - 3.0)
    pixels = np.concatenate([np.repeat(warm[..., None], 3, -1), np.ones((rows, columns, 1))], -1).astype(np.float32)
    light = DomeLight(path="/l", radiance=np.ones(3), texture=0)
    scene_of = {"curves": (stroke(angle),), "instances": [scenes.place(0, 0, (0, 0, -1))], "cam": straight_down()}
    texture = Texture(path="sky", pixels=pixels)
    found = []
    for one in (light, scenes.dome()):
        world = scenes.scene([scenes.plane(0.02)], [waves()], [one], textures=(texture,), **scene_of)
        asked = sw.Settings(width=8, height=8, spp=4, filter="box", effects=COMPILED)
        found.append(flux(sw.render(world, sw.make_plan(world, asked))) @ LUMINANCE)
    at, weights = spectral_samples(12)
    # the library's rows run from its normal +z
    polar, turn = (np.arange(64) + 0.5) / 64 * np.pi, (np.arange(128) + 0.5) / 64 * np.pi
    ring = np.sin(polar)[:, None]
    up = np.stack([ring * np.cos(turn), ring * np.sin(turn), np.cos(polar)[:, None] * np.ones(128)], axis=-1)
    sky = diffraction.DomeLight(0.2 + np.exp(3.0 * (up @ toward(angle + np.pi / 2, 1.1)) - 3.0))
    one = diffraction.Scratch(3.0, 1.0, angle, 0.0, SIGMA)
    exact = [
        diffraction.radiance(d, np.array([0, 0, 1.0]), one, at, method="quadrature") @ weights @ LUMINANCE
        for d in (sky, diffraction.DomeLight([[1.0]]))
    ]
    assert found[0] / found[1] == pytest.approx(exact[0] / exact[1], rel=0.03)


@pytest.mark.parametrize("coverage", [0.05, 0.8])
def test_furnace(coverage):
    """Scratches on a mirror under an even white dome: base and scratches return at most what arrives, and nearly all
    of it but what diffracts below the horizon (lobe fraction of 6 um scratches: 0.98)."""
    mirror = PreviewSurface(diffuse_color=(1, 1, 1), metallic=1.0, roughness=0.0)
    laid = {"distribution": "random", "coverage": coverage, "width": 6.0, "length": 4000.0, "depth_variation": 0.5}
    material = waves(surface=mirror, **laid)
    film = render(material, scenes.dome(), (), size=4, spp=1)
    color = film["color"]
    assert np.isfinite(color).all() and color.min() >= 0.0
    assert color.max() <= 1.0 + 1e-3
    assert color.min() >= 0.85
    assert film["scratches"].mean() > 0.3 * coverage


def test_scale_and_place_do_not_matter():
    """The same picture when the scene is described in other units is the stage's business; here: far from the origin
    of the layout, and half of a scratch on either side of the plane's diagonal."""
    light = DistantLight(path="/l", radiance=np.full(3, 2.0), direction=-toward(np.pi / 4 + np.pi / 2, 1.2))
    whole = render(waves(), light, (stroke(np.pi / 4),))
    along = stroke(np.pi / 4)
    middle = along.points.mean(0)
    halves = replace(
        along,
        points=np.array([along.points[0], middle, middle, along.points[1]]),
        counts=np.array([2, 2]),
        widths=np.full(4, 3.0),
        depths=np.full(4, 1.0),
    )
    split = render(waves(), light, (halves,))
    np.testing.assert_allclose(split["color"], whole["color"], rtol=1.5e-2, atol=1e-4 * whole["color"].max())


def test_nothing_is_built_without_the_schema():
    material = replace(waves(surface=ScratchSurface()), wave=None)
    light = DistantLight(path="/l", radiance=np.ones(3), direction=np.array([0, 0, -1.0]))
    world = scenes.scene([scenes.plane(0.02)], [material], [light], curves=(stroke(0.1),))
    plan = sw.make_plan(world, sw.Settings(width=4, height=4))
    assert not any(choice.enabled for name, choice in plan.effects.items() if name.startswith("diffraction"))
    assert "no material has ScratchWaveAPI" in plan.explain()
    key = vars(kernel_key(world, plan))
    assert not [name for name, value in key.items() if name.startswith("glint") and value is True]


def test_directions_build_no_area_light_code():
    light = DistantLight(path="/l", radiance=np.ones(3), direction=np.array([0, 0, -1.0]))
    world = scenes.scene([scenes.plane(0.02)], [waves()], [light], curves=(stroke(0.1),))
    plan = sw.make_plan(world, sw.Settings(width=4, height=4))
    assert plan.on("diffraction.segments") and not plan.on("diffraction.areaLights")
    key = kernel_key(world, plan)
    assert key.glints and not key.glint_areas and not key.glint_lookup
    assert not any(p for own in plan.layers for p in own) and not plan.tables
    assert plan.effects["diffraction.areaLights"].reason == "every light is a point or a direction"
    dome = replace(world, lights=(DomeLight(path="/d", radiance=np.ones(3)),))
    assert sw.make_plan(dome, sw.Settings(width=4, height=4)).on("diffraction.areaLights")


def grating(pitch, coherent=True, **fields):
    """Parallel scratches along x at a pitch [um]."""
    wave = Wave(coherence_radius=SIGMA, summation="coherent" if coherent else "incoherent")
    return waves(distribution="linear", pitch=pitch, curves=(), wave=wave, **fields)


def test_grating_against_the_library():
    """145 scratches 5 um apart, their field added up and squared at every quarter of a nanometre, against the orders
    of the renderer. The Gaussian of an order is 5 nm wide at most and the eye nearly straight over it: 1 %."""
    pitch, width, depth, xi2 = 5.0, 2.0, 0.4, 0.22
    omega_o, omega_i = np.array([0, 0, 1.0]), np.array([0.0, xi2, np.sqrt(1 - xi2**2)])
    light = DistantLight(path="/l", radiance=np.full(3, 2.0), direction=-omega_i)
    film = render(grating(pitch, width=width, depth=depth), light, (), size=2)
    at = np.arange(380.25, 780.0, 0.25)
    lines = [diffraction.Scratch(width, depth, 0.0, pitch * (i - 72), SIGMA) for i in range(145)]
    f = diffraction.brdf_coherent(omega_i, omega_o, lines, at, base=False)
    _, weights = spectral_samples(at)
    expected = 2.0 * omega_i[2] * (f @ weights)
    # gamut mapping keeps the luminance
    assert film["scratches"].mean((0, 1)) @ LUMINANCE == pytest.approx(expected @ LUMINANCE, rel=1e-2)


def test_rainbow_of_a_compact_disc():
    """A 1.6 um grating seen from straight above under a point light: along the line xi_1 = 0 of the picture the first
    order shows lambda = pitch xi_2. Measured from the picture: where the luminance over xi_2 has its middle, against
    the middle of what the eye sees of the order's strength over lambda / pitch, within 2 %."""
    pitch, width, depth, size, wide = 1.6, 0.6, 0.12, 128, 0.5
    at_light = np.array([0.0, 0.4, 1.0])  # over the plane
    light = SphereLight(path="/l", radiance=np.full(3, 2.0), center=at_light - [0, 0, 1], radius=0.0, point=True)
    material, floor = grating(pitch, width=width, depth=depth), [scenes.place(0, 0, (0, 0, -1))]
    world = scenes.scene([scenes.plane(2.0)], [material], [light], instances=floor, cam=straight_down(wide))
    asked = sw.Settings(width=size, height=size, spp=4, filter="box", effects=COMPILED)
    film = sw.render(world, sw.make_plan(world, asked))
    y = (0.5 - (np.arange(size) + 0.5) / size) * wide  # row 0 is the top
    far = np.hypot(at_light[1] - y, at_light[2])
    xi2 = (at_light[1] - y) / far
    # a point light's irradiance times the cosine falls with far^-3; the line is as wide as far in the picture
    column = (film["scratches"] @ LUMINANCE).sum(1) * far**2
    at = np.arange(380.0, 781.0)
    _, weights = spectral_samples(at)
    strength = np.sin(2 * np.pi * depth / (at * 1e-3)) ** 2 * (weights @ LUMINANCE)
    expected = (at * strength).sum() / strength.sum() * 1e-3 / pitch
    first = (xi2 > 0.2) & (xi2 < 0.5)
    weight = column[first] * np.abs(np.gradient(xi2))[first]
    assert (weight * xi2[first]).sum() / weight.sum() == pytest.approx(expected, rel=0.02)
    assert weight.sum() > 0.0


def test_incoherent_pattern_is_as_bright_as_its_orders():
    """Under a light of even radiance all around, orders or no orders: the same light, but for what of order 0 counts as
    the base's, a (1 - a) |D|^2 against a |D|^2."""
    films = [render(grating(2.0, c, width=0.8, depth=0.2), scenes.dome(), (), size=2, spp=4) for c in (True, False)]
    coherent, incoherent = (f["scratches"].mean((0, 1)) for f in films)
    assert coherent @ LUMINANCE == pytest.approx(0.6 * (incoherent @ LUMINANCE), rel=0.1)


def test_pattern_in_uv_is_the_pattern_in_micrometres():
    """Widths, depths and pitches as fractions of a uv square of 2 cm."""
    side = 0.02 * 1e6
    light = DistantLight(path="/l", radiance=np.full(3, 2.0), direction=-toward(np.pi / 2, 1.3))
    sized = {"width": 2.0, "depth": 0.4}
    plain = render(grating(20.0, coherent=False, **sized), light, (), size=2)
    in_uv = {"width": 2.0 / side, "depth": 0.4 / side, "space": "uv"}
    mapped = render(grating(20.0 / side, coherent=False, **in_uv), light, (), size=2)
    assert plain["scratches"].max() > 0.0
    np.testing.assert_allclose(mapped["color"], plain["color"], rtol=1e-3)
