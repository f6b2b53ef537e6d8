"""What a footprint holds of a stretch of scratch, against double precision."""

import numpy as np
import warp as wp
from scipy.special import ndtr

from scratchwarp.kernels.glint_stretch_device import between

wp.set_module_options({"enable_backward": False})


@wp.kernel
def cut(low: wp.array(dtype=float), high: wp.array(dtype=float), out: wp.array(dtype=wp.vec3)):
    """The cut Gaussian of each pair of ends."""
    i = wp.tid()
    held = between(low[i], high[i])
    out[i] = wp.vec3(held.part, held.mean, held.variance)


def moments(a, b):
    """Part, mean and variance of the normal distribution cut to [a, b], from the side where nothing cancels."""
    left = a + b < 0
    a, b = np.where(left, a, -b), np.where(left, b, -a)
    part = ndtr(b) - ndtr(a)
    at_a, at_b = (np.exp(-0.5 * x * x) / np.sqrt(2 * np.pi) for x in (a, b))
    mean = (at_a - at_b) / part
    return part, np.where(left, mean, -mean), 1 + (a * at_a - b * at_b) / part - mean * mean


def test_cut_gaussians():
    """Parts within 1e-5 of their value: 5e-7 of each tail, six times the part at most where 0.2 is cut from the middle.

    Shorter stretches are a slope (relative error 0.01 / 24 times the curvature, at most 4^2 here).
    """
    rng = np.random.default_rng(0)
    low = rng.uniform(-4.5, 4.0, 20000)
    high = np.minimum(low + 10 ** rng.uniform(-2, 1, low.size), 7.0)
    out = wp.empty(low.size, dtype=wp.vec3, device="cpu")
    ends = [wp.array(x.astype(np.float32), dtype=float, device="cpu") for x in (low, high)]
    wp.launch(cut, dim=low.size, inputs=ends, outputs=[out], device="cpu")
    part, mean, variance = out.numpy().T
    low, high = (x.numpy().astype(np.float64) for x in ends)
    exact = moments(low, high)
    wide = high - low > 0.2001
    held = wide & (exact[0] > 2e-6)
    assert wide.sum() > 5000
    np.testing.assert_allclose(part[held], exact[0][held], rtol=1e-5)
    np.testing.assert_allclose(part[~wide], exact[0][~wide], rtol=0.04 * 17 / 24)
    # the mean and the variance are differences of terms up to the ends' size
    np.testing.assert_allclose(mean[held], exact[1][held], atol=2e-4)
    np.testing.assert_allclose(variance[held], exact[2][held], atol=2e-3)


def test_all_and_nothing():
    """A stretch over everything holds 1, one far outside nothing; neither has a part below 0."""
    low = np.array([-1e9, -8, 6, -1e9, 7.9], dtype=np.float32)
    high = np.array([1e9, 8, 9, -7, 30], dtype=np.float32)
    out = wp.empty(low.size, dtype=wp.vec3, device="cpu")
    ends = [wp.array(x, dtype=float, device="cpu") for x in (low, high)]
    wp.launch(cut, dim=low.size, inputs=ends, outputs=[out], device="cpu")
    part, mean, variance = out.numpy().T
    np.testing.assert_allclose(part, [1, 1, 0, 0, 0], atol=1e-6)
    assert (part >= 0).all()
    np.testing.assert_allclose(mean[:2], 0, atol=1e-6)
    np.testing.assert_allclose(variance[:2], 1, atol=1e-6)
