"""Diffraction at sizes and wavelengths from nothing to far too much: finite, never negative, no more than all light."""

from dataclasses import replace

import numpy as np
import pytest

import scratchwarp as sw
from scratchwarp import diffraction, scene

from ..render import scenes

SIZES = np.array([0.0, 1e-9, 1e-3, 1.0, 1e3, 1e6])
WAVELENGTHS = np.array([1e-3, 1.0, 380.0, 780.0, 1e6, 1e12])
UP, SLANT = np.array([0.0, 0.0, 1.0]), np.array([0.3, 0.4, np.sqrt(0.75)])


@pytest.mark.parametrize("phase", ["small-angle", "angle-dependent"])
def test_any_size_and_wavelength(phase):
    s = diffraction.Scratch(
        width=SIZES[:, None, None], depth=SIZES[:, None], coherence_radius=60.0, azimuth=0.3, offset=0.0
    )
    for wi in (UP, SLANT, SLANT * [-1, -1, 1]):
        f = diffraction.brdf(wi, SLANT, s, WAVELENGTHS, phase)
        assert f.shape == (6, 6, 6) and np.isfinite(f).all() and f.min() >= 0.0
        assert (f[0] == 0.0).all()  # no width


@pytest.mark.parametrize("method", ["slices", "closed-form"])
def test_lights_at_any_size_and_wavelength(method):
    """At most the |D|^2 <= 4 of each scratch, W / (sqrt(pi) sigma) of them in the footprint."""
    s = diffraction.Scratch(width=SIZES[1:, None], depth=1.0, coherence_radius=60.0)
    share = SIZES[1:, None] / (np.sqrt(np.pi) * 60.0)
    for radius in (0.0, 1e-9, 1e-3, 0.5, 1.0, 2.0):
        value = diffraction.radiance(diffraction.SphereLight(UP, radius), UP, s, WAVELENGTHS, method=method)
        assert np.isfinite(value).all() and value.min() >= 0.0
        assert (value <= 4.0 * share * (1.0 + 1e-6)).all()


@pytest.mark.parametrize("method", ["slices", "closed-form"])
@pytest.mark.parametrize("x", [0.0, -0.0, 1e-300])
def test_lights_straight_across(method, x):
    """The centre in the plane across the scratch, where the printed bounds divide 0 by 0: as after a turn of all."""
    for center in ([x, -0.3, 0.9], [x, 0.0, 1.0]):
        light, turned = (diffraction.SphereLight(np.array(c), 0.2) for c in (center, [0.3, x, 0.9]))
        turned = turned if center[1] else light
        value = diffraction.radiance(light, UP, diffraction.Scratch(azimuth=0.0), 550.0, method=method)
        other = diffraction.radiance(turned, UP, diffraction.Scratch(azimuth=0.5 * np.pi), 550.0, method=method)
        assert value > 0.0 and value == pytest.approx(other, rel=1e-9)


@pytest.mark.parametrize("bad", [0.0, -500.0, np.inf, np.nan])
def test_no_wavelength_is_said(bad):
    with pytest.raises(ValueError, match="wavelength"):
        diffraction.brdf(UP, UP, diffraction.Scratch(), bad)


@pytest.mark.parametrize(
    ("width", "model", "diffracts"), [(3.0, "auto", True), (3e4, "auto", False), (3e4, "diffraction", True)]
)
def test_scratches_far_wider_than_light_is_coherent_are_tables(width, model, diffracts):
    """Unless asked for: their fringes are too many to integrate, and no light shows them."""
    layered = scenes.scratched(width=width, depth=1.0, model=model)
    world = scenes.scene([scenes.sphere(4, 8)], [replace(layered, wave=scene.Wave())], [scenes.dome()])
    plan = sw.make_plan(world)
    assert plan.on("diffraction") == diffracts and plan.on("scratches.table") == (not diffracts)
    assert any("wider than light is coherent" in w for w in plan.warnings) == (not diffracts)


@pytest.mark.parametrize("sigma", [1e-6, 1e-3, 1e3, 1e9])
def test_any_coherence_radius(sigma):
    s = diffraction.Scratch(coherence_radius=sigma, offset=np.array([0.0, 1.0, 1e6]))
    f = diffraction.brdf(UP, SLANT, s, 550.0)
    assert np.isfinite(f).all() and f.min() >= 0.0
    for method in ("gaussian", "paper", "exact"):
        mean = diffraction.footprint(30.0, 1e-6, 0.3, s.offset, sigma, method=method)
        assert np.isfinite(mean).all() and mean.min() >= 0.0
