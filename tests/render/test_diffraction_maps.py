"""Masks, directions and variation of layers that diffract."""

from dataclasses import replace

import numpy as np
import pytest

import scratchwarp as sw
from scratchwarp import diffraction, profiles
from scratchwarp.reflectance.diffraction.color import spectral_samples
from scratchwarp.scene import DistantLight, Layer, Profile, Texture, Wave
from scratchwarp.scratches.along import varied
from scratchwarp.scratches.generate import random_scratches

from . import scenes
from .test_diffraction import COMPILED, LUMINANCE, SIGMA, straight_down, stroke, toward, waves

OMEGA = toward(0.3 + np.pi / 2, 1.2)
SUN = DistantLight(path="/l", radiance=np.full(3, 2.0), direction=-OMEGA)


def image(values):
    """A map of one channel [h, w] or two [h, w, 2]."""
    values = np.asarray(values, np.float32)
    pixels = np.zeros((*values.shape[:2], 4), np.float32)
    pixels[..., : 1 if values.ndim == 2 else 2] = values if values.ndim == 3 else values[..., None]
    return Texture("/map", pixels)


def shoot(curves=(), texture=None, primvar=None, size=8, view=0.006, spp=1, **fields):
    """Scratches' radiance of a square of 2 cm, of which the middle ``view`` is seen."""
    mesh = scenes.plane(0.02)
    if primvar is not None:
        values = np.asarray(primvar, float).reshape(4, -1)
        mesh = replace(mesh, primvars={"own": values[mesh.triangles]})
    world = scenes.scene(
        [mesh], [waves(**fields)], [SUN], instances=[scenes.place(0, 0, (0, 0, -1))], cam=straight_down(view),
        curves=curves, textures=(texture,) if texture is not None else (),
    )  # fmt: skip
    asked = sw.Settings(width=size, height=size, spp=spp, filter="box", effects=COMPILED)
    plan = sw.make_plan(world, asked)
    assert not plan.warnings
    return sw.render(world, plan)["scratches"].astype(float)


LINES = {"distribution": "linear", "pitch": 50.0, "width": 2.0, "depth": 0.3, "curves": (), "angle": 0.3}


def test_masks_scale_regular_patterns():
    """Even light is seen through a mask of 0.3, given as a primvar or as an image."""
    whole = shoot(**LINES)
    assert whole.max() > 0.0
    for masked in (
        shoot(primvar=[0.3, 0.3, 0.3, 0.3], mask_primvar="own", **LINES),
        shoot(texture=image([[0.3, 0.3], [0.3, 0.3]]), mask_texture=0, **LINES),
    ):
        np.testing.assert_allclose(masked, 0.3 * whole, rtol=1e-3, atol=1e-4 * whole.max())


def test_masks_cut_single_scratches():
    """One scratch across an image whose left half is black: nothing there, all of it on the right, but for the texels
    (64 of 0.3 mm) and pixels in the middle."""
    half = np.zeros((64, 64))
    half[:, 32:] = 1.0
    curves = (stroke(0.3),)
    whole = shoot(curves, view=0.006)
    masked = shoot(curves, image(half), view=0.006, mask_texture=0)
    assert whole[:, :3].sum() > 0.2 * whole.sum()
    assert masked[:, :3].max() == 0.0
    np.testing.assert_allclose(masked[:, 5:], whole[:, 5:], rtol=1e-5)


@pytest.mark.parametrize("laid", ["linear", "random"])
def test_maps_turn_scratches(laid):
    """A map of 17.2 degrees everywhere is the layer turned by as much: by an angle in an image, a vector, degrees and
    vectors of a primvar. Images hold the angle in float32; single scratches are drawn by nine
    points in place of two."""
    fields = {**LINES, "distribution": laid, "coverage": 0.02, "length": 3000.0, "angle_spread": 1e-4}
    turned = shoot(**fields, size=16)
    fields["angle"] = 0.0
    assert turned.mean() > 0.0
    vector = np.array([np.cos(0.3), np.sin(0.3)])
    images = [(image(np.full((2, 2), 0.3 / np.pi)), "angle"), (image(np.tile(0.5 + 0.5 * vector, (2, 2, 1))), "vector")]
    shown = [shoot(texture=t, orientation_texture=0, orientation_encoding=e, size=16, **fields) for t, e in images]
    degrees = np.full(4, np.degrees(0.3))
    for primvar in (degrees, np.tile(vector, 4), np.tile([*vector, 0.0], 4)):
        shown.append(shoot(primvar=primvar, orientation_primvar="own", size=16, **fields))
    for each in shown:
        assert each.mean() == pytest.approx(turned.mean(), rel=0.01)
        np.testing.assert_allclose(each, turned, atol=0.02 * turned.max())


def test_random_scratches_follow_a_swirl():
    """Circles about the middle: every point of a scratch as far from it as the others, to the steps' second order."""
    layer = Layer("fine", "/mat", Profile("/p"), distribution="random", width=4.0, length=4000.0, density=3.0)

    def field(uv):
        x, y = (uv - 0.5).T
        turn = 2.0 * (np.arctan2(y, x) + 0.5 * np.pi)
        return np.stack([np.cos(turn), np.sin(turn)], axis=1)

    made = random_scratches(layer, (0.0, 0.0), (1.0, 1.0), (2e4, 2e4), field)
    points = (made.points[:, :2] - 0.5).reshape(len(made.counts), -1, 2) * 2e4
    radius = np.linalg.norm(points, axis=-1)
    away = radius.mean(1) > 3000.0
    assert away.sum() > 100
    assert (np.ptp(radius[away], axis=1) / radius[away].mean(1)).max() < 0.02
    lengths = np.linalg.norm(np.diff(points, axis=1), axis=-1).sum(1)
    np.testing.assert_allclose(lengths, 4000.0, rtol=1e-9)


def test_depths_vary_along_scratches():
    """Depths come back after a variation length, are spread over the variation, and the scratch stays where it
    is."""
    layer = Layer(
        "fine", "/mat", Profile("/p"), distribution="curves", curves=(0,), depth_variation=0.5, variation_length=200.0
    )
    curves = replace(stroke(0.3), depths=np.full(2, 1.0))
    made = varied(curves, layer, np.full(3, 1e6), False)
    run = np.linalg.norm(made.points - made.points[0], axis=1)
    assert run[-1] == pytest.approx(0.004) and (np.diff(run) > 0).all()
    assert np.diff(run).max() <= 25.1e-6
    assert made.depths.min() < 0.55 and made.depths.max() > 1.45
    assert np.histogram(made.depths, 4, (0.5, 1.5))[0].min() > 0.1 * len(run)
    np.testing.assert_allclose(made.depths[8:], made.depths[:-8], atol=0.15)
    np.testing.assert_allclose(made.widths, 3.0, rtol=1e-12)


def test_pattern_with_variation_is_the_mean_of_its_lines():
    """Widths uniform in 1 -+ 0.5 by six nodes, depths by the mean of their cosine over a normal spread, and four
    cross-sections: against means by the library, 1 %."""
    at, weights = spectral_samples(64)
    up = np.array([0.0, 0.0, 1.0])

    def mean(parts):
        total = 0.0
        for width, depth, profile in parts:
            one = diffraction.Scratch(width, depth, 0.3, 0.0, SIGMA, profile=profile)
            f = diffraction.brdf(OMEGA, up, one, at) @ weights @ LUMINANCE
            total += f * np.sqrt(np.pi) * SIGMA / 50.0
        return 2.0 * OMEGA[2] * total / len(parts)

    wave = Wave(SIGMA, samples=64)
    wide = shoot(wave=wave, **LINES, width_variation=0.5) @ LUMINANCE
    nodes = 2.0 * (1.0 + 0.5 * np.linspace(-0.995, 0.995, 200))
    np.testing.assert_allclose(wide, mean([(w, 0.3, None) for w in nodes]), rtol=0.01)
    end = Profile(path="/mat/vee", shape="vGroove")
    mixed = shoot(wave=wave, shape="trapezoid", profile_end=end, profile_variation=1.0, **LINES) @ LUMINANCE
    first, last = (profiles.shape(name, depth=0.15, isolated=True) for name in ("trapezoid", "vGroove"))
    known = [(2.0, 0.3, profiles.between(first, last, p)) for p in (0.125, 0.375, 0.625, 0.875)]
    np.testing.assert_allclose(mixed, mean(known), rtol=0.01)
