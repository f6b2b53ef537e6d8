"""Diffuse and specular multipliers of lights: each scales its own lobe, whichever way the light was found."""

import importlib.util
from pathlib import Path

import numpy as np
import pytest

import scratchwarp as sw
from scratchwarp.scene import Material, PreviewSurface, RectLight

spec = importlib.util.spec_from_file_location("scenes", Path(__file__).parent / "scenes.py")
S = importlib.util.module_from_spec(spec)
spec.loader.exec_module(S)


def film(diffuse, specular, forced=True):
    light = RectLight(
        path="/key",
        radiance=np.full(3, 5.0),
        center=(2.0, 2.0, -3.0),
        ex=(0.7, 0.0, -0.7),
        ey=(0.0, 1.0, 0.0),
        normal=(-0.7071, 0.0, -0.7071),
        diffuse=diffuse,
        specular=specular,
    )
    glossy = Material("/mat", surface=PreviewSurface(diffuse_color=(0.6, 0.3, 0.1), roughness=0.4))
    scene = S.scene([S.sphere(16, 32)], [glossy], [light])
    effects = {"lights.multipliers": forced, "shadows": True}
    return sw.render(scene, sw.make_plan(scene, sw.Settings(width=32, height=32, spp=64, effects=effects)))


def test_multipliers_add_up():
    """The image is linear in both: diffuse 2, specular 3 is twice the diffuse part and three times the other.

    The same samples are used throughout, so only the weights' rounding differs: 1e-4 of the brightest pixel.
    """
    both, diffuse, specular = film(2.0, 3.0)["color"], film(1.0, 0.0)["color"], film(0.0, 1.0)["color"]
    assert diffuse.mean() > 0.01 and specular.mean() > 0.001
    assert np.abs(both - 2 * diffuse - 3 * specular).max() < 1e-4 * both.max()


def test_multipliers_of_one_change_neither_image_nor_noise():
    """Compiled in or not, the estimator is the same: light and lobe sampling are weighed against each other."""
    with_code, without = film(1.0, 1.0), film(1.0, 1.0, forced=False)
    np.testing.assert_allclose(with_code["color"], without["color"], atol=1e-4 * without["color"].max())
    assert with_code["variance"].mean() == pytest.approx(without["variance"].mean(), rel=1e-2)
