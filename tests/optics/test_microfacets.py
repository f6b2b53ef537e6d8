"""GGX: normalisation, visible normals, chi-square of the sampler, reciprocity, tiny roughness."""

import numpy as np
import pytest
import warp as wp
from scipy import stats

from scratchwarp.optics import microfacets_device as mf
from scratchwarp.optics.hash_device import pcg_hash, unit_float

wp.set_module_options({"enable_backward": False})

LOWEST_P = 1e-4
ROUGHNESS = [(0.5, 0.5), (0.15, 0.6), (1.0, 0.3)]


@wp.kernel
def _evaluate(wo: wp.vec3, h: wp.array(dtype=wp.vec3), ax: float, ay: float, out: wp.array(dtype=wp.vec3)):
    i = wp.tid()
    out[i] = wp.vec3(mf.ggx_d(h[i], ax, ay), mf.ggx_visible_pdf(wo, h[i], ax, ay), mf.ggx_g1(h[i], ax, ay))


@wp.kernel
def _sample(wo: wp.vec3, ax: float, ay: float, h: wp.array(dtype=wp.vec3), weight: wp.array(dtype=float)):
    i = wp.tid()
    u = wp.vec2(unit_float(pcg_hash(wp.uint32(2 * i))), unit_float(pcg_hash(wp.uint32(2 * i + 1))))
    h[i] = mf.ggx_sample_visible(wo, ax, ay, u)
    weight[i] = mf.ggx_reflection_weight(wo, mf.mirrored(wo, h[i]), ax, ay)


@wp.kernel
def _reflect(wo: wp.array(dtype=wp.vec3), wi: wp.array(dtype=wp.vec3), ax: float, ay: float,
             out: wp.array(dtype=wp.vec4)):  # fmt: skip
    i = wp.tid()
    h = mf.half_vector(wo[i], wi[i])
    forth = mf.ggx_reflection(wo[i], wi[i], h, ax, ay)
    pdf = mf.ggx_reflection_pdf(wo[i], h, ax, ay)
    out[i] = wp.vec4(forth, pdf, mf.ggx_reflection_weight(wo[i], wi[i], ax, ay), mf.ggx_g2(wo[i], wi[i], ax, ay))


def _direction(theta, phi):
    return np.stack([np.sin(theta) * np.cos(phi), np.sin(theta) * np.sin(phi), np.cos(theta) + 0 * phi], axis=-1)


def _run_evaluate(wo, h, ax, ay):
    out = wp.zeros(len(h), dtype=wp.vec3, device="cpu")
    wp.launch(_evaluate, len(h), inputs=[wp.vec3(*wo), wp.array(h, dtype=wp.vec3, device="cpu"), ax, ay], outputs=[out],
              device="cpu")  # fmt: skip
    return out.numpy().astype(float).T


def _run_sample(wo, n, ax, ay):
    h, weight = wp.zeros(n, dtype=wp.vec3, device="cpu"), wp.zeros(n, dtype=float, device="cpu")
    wp.launch(_sample, n, inputs=[wp.vec3(*wo), ax, ay], outputs=[h, weight], device="cpu")
    return h.numpy().astype(float), weight.numpy().astype(float)


def _hemisphere(nt, nphi):
    """Midpoints uniform in t and phi, where z = 1 - t^2 (fine near the normal), and the solid angle of each cell."""
    t, phi = np.meshgrid((np.arange(nt) + 0.5) / nt, (np.arange(nphi) + 0.5) / nphi * 2 * np.pi - np.pi, indexing="ij")
    directions = _direction(np.arccos(1 - t * t), phi).reshape(-1, 3)
    return directions, (2 * t * 2 * np.pi / (nt * nphi)).ravel()


@pytest.mark.parametrize(("ax", "ay"), ROUGHNESS)
@pytest.mark.parametrize("theta", [0.0, 0.9, 1.5])
def test_normalisation(ax, ay, theta):
    h, cell = _hemisphere(400, 400)
    d, visible, _ = _run_evaluate(_direction(theta, np.array(0.6)), h, ax, ay)
    # midpoint rule with 400 x 400 cells; the kink of max(wo . h, 0) leaves 1e-4
    assert np.sum(d * h[:, 2] * cell) == pytest.approx(1.0, abs=5e-4)
    assert np.sum(visible * cell) == pytest.approx(1.0, abs=5e-4)


@pytest.mark.parametrize(("ax", "ay"), ROUGHNESS)
@pytest.mark.parametrize("theta", [0.0, 0.9, 1.5])
def test_visible_normals_follow_their_density(ax, ay, theta):
    wo = _direction(theta, np.array(0.6))
    samples, _ = _run_sample(wo, 100_000, ax, ay)
    bins, sub = 12, 20
    h, cell = _hemisphere(bins * sub, bins * sub)
    pdf = (_run_evaluate(wo, h, ax, ay)[1] * cell).reshape(bins, sub, bins, sub).sum(axis=(1, 3))
    counts, _, _ = np.histogram2d(
        np.sqrt(1 - samples[:, 2]), np.arctan2(samples[:, 1], samples[:, 0]), bins, [[0, 1], [-np.pi, np.pi]]
    )
    expected = pdf.ravel() * len(samples)
    keep = expected > 10
    assert abs(counts.ravel()[~keep].sum() - expected[~keep].sum()) < 5 * np.sqrt(expected[~keep].sum() + 1) + 10
    chi2 = np.sum((counts.ravel()[keep] - expected[keep]) ** 2 / expected[keep])
    assert stats.chi2.sf(chi2, keep.sum() - 1) > LOWEST_P


@pytest.mark.parametrize("theta", [0.0, 0.8, 1.4])
def test_mean_weight_is_the_albedo(theta):
    wo, (ax, ay) = _direction(theta, np.array(1.1)), (0.3, 0.6)
    _, weight = _run_sample(wo, 200_000, ax, ay)
    wi, cell = _hemisphere(500, 500)
    out = wp.zeros(len(wi), dtype=wp.vec4, device="cpu")
    views = wp.array(np.broadcast_to(wo, wi.shape).copy(), dtype=wp.vec3, device="cpu")
    wp.launch(_reflect, len(wi), inputs=[views, wp.array(wi, dtype=wp.vec3, device="cpu"), ax, ay], outputs=[out],
              device="cpu")  # fmt: skip
    value, pdf, ratio, g2 = out.numpy().astype(float).T
    albedo = np.sum(value * wi[:, 2] * cell)
    assert albedo < 1.0 and weight.mean() == pytest.approx(albedo, abs=4 * weight.std() / np.sqrt(len(weight)) + 5e-4)
    # all four are one formula seen from different sides
    np.testing.assert_allclose(value * wi[:, 2], ratio * pdf, rtol=1e-4, atol=1e-7)
    assert np.all((g2 >= 0) & (g2 <= 1 + 1e-6))


def test_reflection_is_reciprocal():
    rng = np.random.default_rng(2)
    w = rng.normal(size=(2, 1000, 3))
    w[..., 2] = np.abs(w[..., 2])
    w /= np.linalg.norm(w, axis=-1, keepdims=True)
    both = []
    for a, b in ((w[0], w[1]), (w[1], w[0])):
        out = wp.zeros(1000, dtype=wp.vec4, device="cpu")
        arrays = [wp.array(x, dtype=wp.vec3, device="cpu") for x in (a, b)]
        wp.launch(_reflect, 1000, inputs=[*arrays, 0.05, 0.2], outputs=[out], device="cpu")
        both.append(out.numpy()[:, 0])
    np.testing.assert_allclose(both[0], both[1], rtol=1e-5)
    assert np.all(both[0] >= 0)


@pytest.mark.parametrize("alpha", [1e-4, 1e-3])
def test_tiny_roughness_keeps_its_shape(alpha):
    # seen from above, |slope / alpha|^2 = q has the CDF q / (1 + q); float32 normals resolve 6e-8 / alpha of it
    h, weight = _run_sample((0.0, 0.0, 1.0), 100_000, alpha, alpha)
    q = np.sum((h[:, :2] / h[:, 2:] / alpha) ** 2, axis=1)
    assert stats.chisquare(np.histogram(q / (1 + q), 32, (0, 1))[0]).pvalue > LOWEST_P
    assert np.quantile(weight, 1e-3) > 0.99 and np.all(np.isfinite(weight))
    d = _run_evaluate((0.0, 0.0, 1.0), np.array([[0.0, 0.0, 1.0], [alpha, 0.0, 1.0]]), alpha, alpha)[0]
    np.testing.assert_allclose(d * np.pi * alpha**2, [1.0, 0.25], rtol=1e-5)


def test_grazing_and_hidden_directions_are_finite():
    wo = np.array([[1, 0, 0], [1, 0, 1e-7], [0, 0, 1], [0.6, 0, 0.8], [0.6, 0, -0.8]], float)
    wi = np.array([[-1, 0, 0], [-1, 0, 1e-7], [0, 0, -1], [-0.6, 0, -0.8], [0, 0, 1]], float)
    out = wp.zeros(5, dtype=wp.vec4, device="cpu")
    arrays = [wp.array(x, dtype=wp.vec3, device="cpu") for x in (wo, wi)]
    wp.launch(_reflect, 5, inputs=[*arrays, 1e-4, 0.5], outputs=[out], device="cpu")
    assert np.all(np.isfinite(out.numpy())) and np.all(out.numpy()[2:, 0] == 0.0)


def test_against_mitsuba():
    mi = pytest.importorskip("mitsuba")
    mi.set_variant("scalar_rgb")
    ax, ay, wo = 0.2, 0.7, _direction(1.0, np.array(0.4))
    theirs = mi.MicrofacetDistribution(mi.MicrofacetType.GGX, ax, ay, True)
    h, _ = _hemisphere(7, 9)
    d, visible, g1 = _run_evaluate(wo, h, ax, ay)
    np.testing.assert_allclose(d, [theirs.eval(list(x)) for x in h], rtol=1e-4)
    np.testing.assert_allclose(visible, [theirs.pdf(list(wo), list(x)) for x in h], rtol=1e-4, atol=1e-7)
    np.testing.assert_allclose(g1, [theirs.smith_g1(list(x), [0, 0, 1]) for x in h], rtol=1e-4)
