"""Fresnel: closed forms at known angles, host against device, limits and refusals."""

import subprocess
import sys

import numpy as np
import pytest
import warp as wp

from scratchwarp import optics
from scratchwarp.optics import fresnel_device as fd
from scratchwarp.optics.fresnel import amplitudes, fit_lazanyi_error

wp.set_module_options({"enable_backward": False})

# silver and gold in the red (eta far below k), iron, aluminium, a weak absorber, a dielectric, an index below 1
INDICES = [(0.05, 4.2), (0.14, 3.7), (2.91, 3.09), (1.1, 6.5), (1.5, 0.01), (1.5, 0.0), (0.66, 0.0)]


@wp.kernel
def _conductor(c: wp.array(dtype=float), eta: float, k: float, out: wp.array(dtype=float)):
    i = wp.tid()
    out[i] = fd.fresnel_conductor(c[i], eta, k)


@wp.kernel
def _dielectric(c: wp.array(dtype=float), ior: float, out: wp.array(dtype=float)):
    i = wp.tid()
    out[i] = fd.fresnel_dielectric(c[i], ior)


@wp.kernel
def _lazanyi(c: wp.array(dtype=float), eta: float, k: float, a: float, alpha: float, out: wp.array(dtype=wp.vec2)):
    i = wp.tid()
    out[i] = wp.vec2(fd.fresnel_lazanyi(c[i], eta, k), fd.fresnel_lazanyi_error(c[i], eta, k, a, alpha))


def _launch(kernel, cosines, *args, dtype=float):
    c = wp.array(cosines, dtype=float, device="cpu")
    out = wp.zeros(len(cosines), dtype=dtype, device="cpu")
    wp.launch(kernel, len(cosines), inputs=[c, *args], outputs=[out], device="cpu")
    return out.numpy().astype(float)


COSINES = np.concatenate([[0.0, 1e-6, 1e-4, 1e-2], np.linspace(0.02, 1.0, 99)]).astype(np.float32)


@pytest.mark.parametrize(("eta", "k"), INDICES)
def test_device_conductor_agrees_with_complex_arithmetic(eta, k):
    exact = optics.Conductor(eta, k).reflectance(COSINES)[:, 0]
    # float32 with some 20 operations: 20 * 6e-8; k = 0 below the critical angle has the sharp corner of a square root,
    # where an error e of the argument becomes sqrt(e)
    np.testing.assert_allclose(_launch(_conductor, COSINES, eta, k), exact, atol=3e-6 if k > 0 or eta > 1 else 2e-3)


@pytest.mark.parametrize("ior", [1.0001, 1.33, 1.5, 2.4, 0.75, 0.5])
def test_device_dielectric_agrees_with_host(ior):
    exact = optics.Dielectric(float(np.float32(ior))).reflectance(COSINES)[:, 0]
    assert np.all(np.isfinite(exact))
    np.testing.assert_allclose(_launch(_dielectric, COSINES, ior), exact, atol=2e-3 if ior < 1 else 3e-6)


def test_device_lazanyi_agrees_with_host():
    a, alpha = fit_lazanyi_error(2.91, 3.09)
    both = _launch(_lazanyi, COSINES, 2.91, 3.09, a, alpha, dtype=wp.vec2)
    for column, model in enumerate(("lazanyi", "lazanyi-error")):
        expected = optics.Conductor(2.91, 3.09, model).reflectance(COSINES)[:, 0]
        np.testing.assert_allclose(both[:, column], expected, atol=2e-6)


def test_iron_at_known_angles():
    iron = optics.Conductor(2.91, 3.09)
    values = iron.reflectance(np.cos(np.radians([0.0, 60.0, 70.0])))[:, 0]
    np.testing.assert_allclose(values, [0.531329, 0.514429, 0.506943], atol=1e-6)
    assert optics.Conductor(2.91, 3.09, "lazanyi").reflectance(0.5)[0] == pytest.approx(0.545975, abs=1e-6)
    assert fit_lazanyi_error(2.91, 3.09) == pytest.approx((3.2719, 6.2486), abs=1e-4)


def test_brewster_and_critical_angle():
    ior = 1.5
    cosine = 1.0 / np.hypot(1.0, ior)  # tan(theta_B) = ior: only s reflects, r_s = (1 - ior^2) / (1 + ior^2)
    assert abs(amplitudes(cosine, ior)[1]) < 1e-15
    expected = 0.5 * ((1 - ior**2) / (1 + ior**2)) ** 2
    assert optics.Dielectric(ior).reflectance(cosine)[0] == pytest.approx(expected, abs=1e-15)
    critical = np.sqrt(1.0 - (1 / 1.5) ** 2)
    assert np.all(optics.Dielectric(1 / 1.5).reflectance(np.linspace(0.0, critical - 1e-9, 20)) == pytest.approx(1.0))
    assert optics.Dielectric(1 / 1.5).reflectance(critical + 0.01)[0] < 0.6


@pytest.mark.parametrize(
    "reflector",
    [optics.Mirror(), optics.Schlick(0.04), optics.Schlick((0.9, 0.5, 0.3)), optics.Dielectric(1.5, "schlick")]
    + [optics.Dielectric(0.7, m) for m in ("exact", "schlick")]
    + [optics.Conductor((0.2, 0.9, 1.3), (3.1, 2.3, 2.0), m) for m in ("exact", "lazanyi", "lazanyi-error", "schlick")],
)
def test_every_reflector_is_a_power_ratio_and_one_at_grazing(reflector):
    values = reflector.reflectance(np.linspace(0.0, 1.0, 200).reshape(4, 50))
    assert values.shape == (4, 50, reflector.channels)
    assert np.all((values >= 0.0) & (values <= 1.0 + 1e-12))
    np.testing.assert_allclose(reflector.reflectance(0.0), 1.0, atol=1e-12)
    assert hash(reflector) == hash(type(reflector)(**vars(reflector))) and isinstance(reflector.token, str)


def test_tokens_tell_reflectors_apart():
    tokens = {r.token for r in (optics.Mirror(), optics.Schlick(0.5), optics.Conductor(1, 2), optics.Conductor(1, 2.5),
                                optics.Conductor(1, 2, "schlick"), optics.Dielectric(1.5))}  # fmt: skip
    assert len(tokens) == 6


@pytest.mark.parametrize(
    ("build", "name"),
    [
        (lambda: optics.Conductor(-1.0, 2.0), "eta"),
        (lambda: optics.Conductor(1.0, float("nan")), "k"),
        (lambda: optics.Conductor([1.0, 2.0], 1.0), "eta"),
        (lambda: optics.Conductor(0.0, 0.0), "eta"),
        (lambda: optics.Conductor(1.0, 2.0, "fast"), "model"),
        (lambda: optics.Dielectric(0.0), "ior"),
        (lambda: optics.Dielectric(1.5, "lazanyi"), "model"),
        (lambda: optics.Schlick(1.5), "f0"),
        (lambda: optics.Mirror().reflectance(1.1), "cos_theta"),
        (lambda: optics.Mirror().reflectance(float("nan")), "cos_theta"),
    ],
)
def test_bad_input_is_refused_by_name(build, name):
    with pytest.raises(ValueError, match=name):
        build()


def test_importing_optics_leaves_warp_alone():
    code = "import sys; from scratchwarp import optics; optics.Conductor(1, 2); sys.exit('warp' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0
