"""The base reflectance: furnace, reciprocity, chi-square of the sampler, mirrors as the limit of narrow lobes."""

import numpy as np
import pytest
from scipy import stats

from scratchwarp import optics, reflectance
from scratchwarp.optics import metals
from scratchwarp.reflectance.base import BaseSurface

LOWEST_P = 1e-4
SURFACES = {
    "lambert": BaseSurface(diffuse=(1.0, 0.5, 0.2), specular=0.0),
    "plastic": reflectance.preview_base(diffuse=1.0, roughness=0.4),
    "smooth plastic": reflectance.preview_base(diffuse=1.0, roughness=0.01),
    "semi-metal": reflectance.preview_base(diffuse=(1.0, 0.7, 0.3), metallic=0.5, roughness=0.6, clearcoat=0.7,
                                           clearcoat_roughness=0.4),
    "bright specular": reflectance.preview_base(diffuse=1.0, specular_workflow=True, specular_color=(0.9, 0.5, 0.1),
                                                roughness=0.3, clearcoat=1.0),
    "gold": BaseSurface(fresnel="conductor", eta=metals.rgb("gold")[0], k=metals.rgb("gold")[1], alpha_x=0.2,
                        alpha_y=0.6),
    "glossy dielectric": BaseSurface(diffuse=1.0, fresnel="dielectric", ior=1.8, alpha_x=0.3),
    "brushed": BaseSurface(diffuse=1.0, f0=0.3, alpha_x=0.05, alpha_y=0.9, clearcoat=1.0, clearcoat_alpha=0.2),
}  # fmt: skip
VIEWS = [0.0, 0.6, 1.2, 1.5]


def _direction(theta, phi=0.7):
    return np.stack(np.broadcast_arrays(np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta)), -1)


def _uniform(count, seed=5):
    return np.random.default_rng(seed).random((count, 3))


def _hemisphere(nt, nphi):
    """Midpoints uniform in t and phi with z = 1 - t^2, and their solid angles."""
    t, phi = np.meshgrid((np.arange(nt) + 0.5) / nt, (np.arange(nphi) + 0.5) / nphi * 2 * np.pi - np.pi, indexing="ij")
    return _direction(np.arccos(1 - t * t), phi), 2 * t * 2 * np.pi / (nt * nphi)


def test_white_lambert_and_white_smooth_metal_reflect_exactly_everything():
    wo = _direction(np.array(VIEWS))[:, None]
    white = reflectance.sample_base(BaseSurface(diffuse=1.0, specular=0.0), wo, _uniform(1000))
    np.testing.assert_array_equal(white.weight, 1.0)
    mirror = reflectance.sample_base(reflectance.preview_base(1.0, metallic=1.0, roughness=0.0), wo, _uniform(1000))
    np.testing.assert_array_equal(mirror.weight, 1.0)
    assert np.all(mirror.delta) and np.all(mirror.pdf == 1.0)
    np.testing.assert_allclose(mirror.omega_i, np.broadcast_to(wo * [-1, -1, 1], mirror.omega_i.shape), atol=1e-7)


def test_white_under_smooth_interfaces_reflects_exactly_everything():
    # the coupled diffuse lobe: F(o) + (1 - F(o)) integral of (1 - F(i)) / (1 - mean F) cos / pi = 1, integrated here
    surface = SURFACES["smooth plastic"]
    wi, cell = _hemisphere(400, 8)
    for theta in VIEWS:
        wo = _direction(theta)
        rest = np.sum(reflectance.evaluate_base(surface, wi, wo) * cell[..., None], axis=(0, 1))
        mirror = optics.Schlick(0.04).reflectance(np.cos(theta))
        np.testing.assert_allclose(rest + mirror, 1.0, atol=1e-4)
    coated = BaseSurface(f0=1.0, alpha_x=0.0, clearcoat=1.0)
    samples = reflectance.sample_base(coated, _direction(1.3), _uniform(4000))
    np.testing.assert_allclose(samples.weight, 1.0, atol=1e-6)


@pytest.mark.parametrize("name", SURFACES)
@pytest.mark.parametrize("theta", VIEWS)
def test_no_more_energy_than_came_in(name, theta):
    samples = reflectance.sample_base(SURFACES[name], _direction(theta), _uniform(40_000))
    mean, error = samples.weight.mean(axis=0), samples.weight.std(axis=0) / 200.0
    # bound 1; 4 standard errors of the estimate; nothing else is allowed
    assert np.all(mean <= 1.0 + 4.0 * error + 1e-6)
    assert mean[0] > 0.55  # all of these have a bright red channel: energy does not vanish either


@pytest.mark.parametrize("name", SURFACES)
@pytest.mark.parametrize("theta", [0.3, 1.3])
def test_samples_agree_with_value_and_density(name, theta):
    surface, wo = SURFACES[name], _direction(theta)
    s = reflectance.sample_base(surface, wo, _uniform(100_000))
    alive = (s.pdf > 0) & ~s.delta & (s.omega_i[:, 2] > 0)
    value = reflectance.evaluate_base(surface, s.omega_i[alive], wo)
    np.testing.assert_allclose(s.pdf[alive], reflectance.base_density(surface, s.omega_i[alive], wo), rtol=5e-3)
    # rounding of the sampled direction moves D by 2 * 6e-8 / alpha^2 (alpha = 0.05: 5e-5) a step
    np.testing.assert_allclose(s.weight[alive] * s.pdf[alive, None], value, rtol=5e-3, atol=1e-6)
    # chi-square of directions over t = sqrt(1 - z) and phi
    bins, sub = 10, 24
    wi, cell = _hemisphere(bins * sub, bins * sub)
    mass = reflectance.base_density(surface, wi, wo) * cell
    expected = mass.reshape(bins, sub, bins, sub).sum(axis=(1, 3)).ravel() * len(s.pdf)
    w = s.omega_i[alive]
    counts = np.histogram2d(np.sqrt(1 - np.minimum(w[:, 2], 1)), np.arctan2(w[:, 1], w[:, 0]), bins,
                            [[0, 1], [-np.pi, np.pi]])[0].ravel()  # fmt: skip
    keep = expected > 50
    assert keep.sum() > 5
    # narrow lobes leave the midpoint rule up to 1 % in a cell: that much is allowed on top of the noise
    excess = np.maximum(np.abs(counts - expected)[keep] - 0.01 * expected[keep], 0.0)
    assert stats.chi2.sf(np.sum(excess**2 / expected[keep]), keep.sum()) > LOWEST_P
    assert abs(counts[~keep].sum() - expected[~keep].sum()) < 6 * np.sqrt(expected[~keep].sum() + 10)


@pytest.mark.parametrize("name", SURFACES)
def test_reciprocity(name):
    a, b = (_direction(np.linspace(0.05, 1.5, 15)[:, None], np.linspace(-3, 3, 13) + shift) for shift in (0.0, 0.9))
    b = b[::-1]
    forth = reflectance.evaluate_base(SURFACES[name], a, b) / a[..., 2:]
    back = reflectance.evaluate_base(SURFACES[name], b, a) / b[..., 2:]
    np.testing.assert_allclose(forth, back, rtol=2e-4, atol=1e-7)


def test_nothing_below_the_horizon():
    up, down = _direction(0.4), -_direction(0.4)
    for name, surface in SURFACES.items():
        assert not np.any(reflectance.evaluate_base(surface, down, up)), name
        assert not np.any(reflectance.evaluate_base(surface, up, down)), name
        assert not np.any(reflectance.sample_base(surface, down, _uniform(10)).weight), name


def test_lambert_is_albedo_over_pi_times_cosine():
    wi = _direction(np.linspace(0.0, 1.5, 7))
    value = reflectance.evaluate_base(SURFACES["lambert"], wi, _direction(0.8))
    np.testing.assert_allclose(value, wi[:, 2:] * np.array([1.0, 0.5, 0.2]) / np.pi, rtol=1e-6)


@pytest.mark.parametrize("theta", [0.2, 1.0, 1.4])
def test_a_narrow_lobe_tends_to_the_mirror(theta):
    wo, u = _direction(theta), _uniform(20_000)
    index = dict(zip(("eta", "k"), metals.rgb("copper"), strict=True))
    mirror = reflectance.sample_base(BaseSurface(fresnel="conductor", alpha_x=0.9e-3, **index), wo, u)
    narrow = reflectance.sample_base(BaseSurface(fresnel="conductor", alpha_x=1.1e-3, **index), wo, u)
    exact = metals.conductor("copper").reflectance(np.cos(theta))
    assert np.all(mirror.delta) and not np.any(narrow.delta)
    np.testing.assert_allclose(mirror.weight, np.broadcast_to(exact, mirror.weight.shape), rtol=2e-6)
    # shadowing and the spread of Fresnel are of order alpha / cos: 1e-3 / 0.17
    np.testing.assert_allclose(narrow.weight.mean(axis=0), exact, rtol=8e-3)


def test_weights_scale_their_lobes_and_their_probabilities():
    surface, wo, wi = SURFACES["semi-metal"], _direction(0.5), _direction(0.9, 2.0)
    whole = reflectance.evaluate_base(surface, wi, wo)
    diffuse = reflectance.evaluate_base(surface, wi, wo, w_specular=0.0)
    specular = reflectance.evaluate_base(surface, wi, wo, w_diffuse=0.0)
    np.testing.assert_allclose(diffuse + specular, whole, rtol=1e-6)
    mixed = reflectance.evaluate_base(surface, wi, wo, w_diffuse=0.3, w_specular=0.6)
    np.testing.assert_allclose(mixed, 0.3 * diffuse + 0.6 * specular, rtol=1e-5)
    assert reflectance.base_density(surface, wi, wo, w_specular=0.0) == pytest.approx(wi[2] / np.pi, rel=1e-6)
    nothing = reflectance.sample_base(surface, wo, _uniform(5), w_diffuse=0.0, w_specular=0.0)
    assert not np.any(nothing.weight) and not np.any(nothing.pdf)
    for weights in ((1.0, 0.0), (0.0, 1.0), (0.3, 0.6)):
        s = reflectance.sample_base(surface, wo, _uniform(100_000), *weights)
        grid, cell = _hemisphere(300, 300)
        exact = np.sum(reflectance.evaluate_base(surface, grid, wo, *weights) * cell[..., None], axis=(0, 1))
        error = s.weight.std(axis=0) / np.sqrt(len(s.weight))
        np.testing.assert_allclose(s.weight.mean(axis=0), exact, atol=float(4 * error.max() + 2e-4))


def test_preview_surface_follows_its_specification():
    red = (0.8, 0.2, 0.1)
    plain = reflectance.preview_base(red, roughness=0.5)
    assert plain.f0 == pytest.approx((0.04,) * 3) and plain.f90 == pytest.approx((1.0,) * 3)
    assert plain.diffuse == pytest.approx(red) and plain.alpha_x == plain.alpha_y == pytest.approx(0.25)
    metal = reflectance.preview_base(red, metallic=1.0)
    assert metal.f0 == pytest.approx(red) and metal.f90 == pytest.approx(red) and metal.diffuse == (0.0,) * 3
    half = reflectance.preview_base(red, metallic=0.5)
    tint = 0.5 + 0.5 * np.array(red)
    np.testing.assert_allclose(half.f90, tint, rtol=1e-6)
    np.testing.assert_allclose(half.f0, 0.5 * 0.04 * tint + 0.5 * tint, rtol=1e-6)
    spec = reflectance.preview_base(red, metallic=1.0, specular_workflow=True, specular_color=(0.1, 0.2, 0.3))
    assert spec.f0 == pytest.approx((0.1, 0.2, 0.3)) and spec.diffuse == pytest.approx(red)
    coat = reflectance.preview_base(ior=2.0, clearcoat=0.5, clearcoat_roughness=0.3)
    assert (coat.clearcoat, coat.clearcoat_alpha) == pytest.approx((0.5, 0.09))
    assert coat.clearcoat_f0 == pytest.approx(1 / 9)


@pytest.mark.parametrize("theta", [0.0, 1.0, 1.5607])
@pytest.mark.parametrize("alpha", [0.0, 1e-4, 1.01e-3, 1.0])
def test_hard_parameters_stay_finite(theta, alpha):
    wi, _ = _hemisphere(20, 20)
    dark, inside = {"f0": 0.0, "f90": 0.0}, {"fresnel": "dielectric", "ior": 0.5}
    for extra in ({"f0": 1.0}, dark, inside, {"fresnel": "conductor"}):
        surface = BaseSurface(diffuse=1.0, alpha_x=alpha, alpha_y=1.0 - alpha, clearcoat=1.0, **extra)
        s = reflectance.sample_base(surface, _direction(theta), _uniform(2000))
        assert all(np.all(np.isfinite(a)) and np.all(a >= 0) for a in (s.weight, s.pdf))
        assert np.all(np.isfinite(reflectance.evaluate_base(surface, wi, _direction(theta))))
        assert s.weight.mean() <= 1.0 + 4 * s.weight.std() / np.sqrt(2000) + 1e-6


@pytest.mark.parametrize(
    ("build", "name"),
    [
        (lambda: BaseSurface(diffuse=1.5), "diffuse"),
        (lambda: BaseSurface(alpha_x=float("nan")), "alpha_x"),
        (lambda: BaseSurface(fresnel="thin"), "fresnel"),
        (lambda: BaseSurface(f0=0.5, f90=0.2), "f0"),
        (lambda: reflectance.preview_base(roughness=-0.1), "roughness"),
        (lambda: reflectance.evaluate_base(BaseSurface(), [0, 0, 2.0], [0, 0, 1.0]), "omega_i"),
        (lambda: reflectance.evaluate_base(BaseSurface(), [0, 0, 1.0], [0, 1.0]), "omega_o"),
        (lambda: reflectance.sample_base(BaseSurface(), [0, 0, 1.0], [0.5, 0.5, 1.0]), "u must"),
    ],
)
def test_bad_input_is_refused_by_name(build, name):
    with pytest.raises(ValueError, match=name):
        build()
