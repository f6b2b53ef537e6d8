"""Metrics: closed forms, scikit-image where it is installed; rivals: each returns to data of its own kind."""

import numpy as np
import pytest

from scratchwarp import measured
from scratchwarp.reflectance.measured.rival_shapes import SHAPES, angles

from .synthetic import direction


def _images(seed=0):
    rng = np.random.default_rng(seed)
    a = rng.random((40, 50, 3))
    return a, np.abs(a + 0.1 * rng.standard_normal(a.shape))


def test_equal_images():
    a, _ = _images()
    assert measured.compare(a, a) == {"delta_e": 0.0, "rmse": 0.0, "psnr": np.inf, "ssim": pytest.approx(1.0)}


def test_closed_forms():
    a = np.full((20, 20, 3), 0.5)
    a[0, 0] = 2.0
    found = measured.compare(a, a + 0.1)
    assert found["rmse"] == pytest.approx(0.1) and found["psnr"] == pytest.approx(20 * np.log10(2.0 / 0.1))
    # greys differ in lightness alone: 116 (0.6^(1/3) - 0.5^(1/3)); one pixel goes from 2 to 2.1
    steps = 116 * (np.cbrt([0.6, 2.1]) - np.cbrt([0.5, 2.0]))
    assert found["delta_e"] == pytest.approx((399 * steps[0] + steps[1]) / 400, rel=1e-6)
    # red against black: L, a, b of the primary, 53.24, 80.09, 67.20
    red = measured.compare(np.zeros((11, 11, 3)), np.broadcast_to((1.0, 0, 0), (11, 11, 3)))
    assert red["delta_e"] == pytest.approx(np.linalg.norm([53.24, 80.09, 67.20]), abs=0.02)
    assert red["psnr"] == -np.inf and red["ssim"] == 0.0
    # structure: of constant images only the means count, (2 x y + C1) / (x^2 + y^2 + C1) with range 1
    flat = measured.compare(np.ones((11, 11, 3)), np.full((11, 11, 3), 0.5))
    assert flat["ssim"] == pytest.approx((1.0 + 1e-4) / (1.25 + 1e-4), rel=1e-6)


def test_the_library_agrees():
    metrics = pytest.importorskip("skimage.metrics")
    a, b = _images()
    found = measured.compare(a, b)
    first, second = (x @ (0.2126, 0.7152, 0.0722) for x in (a, b))
    ssim = metrics.structural_similarity(
        first, second, data_range=first.max(), gaussian_weights=True, sigma=1.5, use_sample_covariance=False
    )
    assert found["ssim"] == pytest.approx(ssim, abs=1e-9)
    assert found["psnr"] == pytest.approx(metrics.peak_signal_noise_ratio(a, b, data_range=a.max()), abs=1e-9)


def test_bad_input_is_named():
    a, _ = _images()
    for other, message in ((a[:20], "b must have the shape of a"), (a[..., 0], "b must have shape"), (a[:5], "b must")):
        with pytest.raises(ValueError, match=message):
            measured.compare(a, other)
    with pytest.raises(ValueError, match="a must be finite"):
        measured.compare(np.full((11, 11, 3), np.nan), a)


@pytest.mark.parametrize("name", measured.RIVALS)
def test_rivals_return_to_their_own_data(name):
    shape = np.array([[0.7, *SHAPES[name].start]])
    shape[0, 1] += 0.3
    truth = measured.Rival(name, shape, np.array([0.1, 0.2, 0.3]), np.array([[0.5, 0.4, 0.3]]))
    data = truth.unfolded()
    found = measured.fit_rival(data, name, lobes=1)
    assert measured.compare(data, found.unfolded())["psnr"] > 80.0
    np.testing.assert_allclose(found.kd, truth.kd, rtol=1e-3)
    assert found.parameters == shape.size + 6
    wi, wo = direction(np.linspace(0.1, 1.4, 9), 0.3), direction(0.8, np.linspace(-3, 3, 9))
    np.testing.assert_allclose(truth.evaluate(wi, wo), truth.evaluate(wo, wi), rtol=1e-9)


@pytest.mark.parametrize("name", ["ward", "ggx"])
def test_lobes_keep_energy(name):
    """A narrow lobe of weight 1 reflects nearly everything at normal view: Ward's and GGX's integrals are 1."""
    t, phi = np.meshgrid((np.arange(600) + 0.5) / 600, (np.arange(200) + 0.5) / 200 * 2 * np.pi, indexing="ij")
    wi = direction(0.5 * np.pi * t**2, phi).reshape(-1, 3)
    cell = (np.sin(0.5 * np.pi * t**2) * np.pi * t / 600 * 2 * np.pi / 200).ravel()
    numbers = np.array([0.3, np.log(0.1), np.log(0.2), 1.0])[: len(SHAPES[name].low)]
    lobe = SHAPES[name].function(numbers, angles(wi, np.broadcast_to((0.0, 0.0, 1.0), wi.shape)))
    # Ward's normalisation holds for small slopes: off by about alpha^2 = 4 %; GGX loses the light sent below
    assert np.sum(lobe * wi[:, 2] * cell) == pytest.approx(1.0, abs=0.08)


def test_a_black_brdf_and_bad_models():
    assert not np.any(measured.fit_rival(np.zeros((288, 288, 3)), "ward").unfolded())
    with pytest.raises(ValueError, match="model.*phong"):
        measured.fit_rival(np.zeros((288, 288, 3)), "phong")
    with pytest.raises(ValueError, match="lobes.*9"):
        measured.fit_rival(np.zeros((288, 288, 3)), "ward", lobes=9)
