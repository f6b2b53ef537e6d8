"""Pyramids against sums over the image, and directions at twice their angle."""

import numpy as np
import pytest
import warp as wp

from scratchwarp.reflectance import pyramid_device as pd
from scratchwarp.reflectance.pyramid import doubled, doubled_vectors, pack_pyramids, pyramid

wp.set_module_options({"enable_backward": False})


@wp.kernel
def _look(p: pd.Pyramids, uv: wp.array(dtype=wp.vec2d), jx: wp.vec2, jy: wp.vec2, out: wp.array(dtype=wp.vec4)):
    i = wp.tid()
    found = pd.averaged(p, 1, uv[i], jx, jy, (float(i % 64) + 0.5) / 64.0)
    out[i] = found.value


def look(image, uv, jx, jy):
    """Mean over 64 draws at each uv."""
    packed = pack_pyramids([np.zeros((2, 2, 4), np.float32), image])
    where = np.repeat(np.asarray(uv, float), 64, axis=0)
    out = wp.zeros(len(where), dtype=wp.vec4, device="cpu")
    at = wp.array(where, dtype=wp.vec2d, device="cpu")
    wp.launch(_look, len(where), inputs=[packed, at, wp.vec2(*jx), wp.vec2(*jy), out], device="cpu")
    return out.numpy().reshape(-1, 64, 4).mean(1)


@pytest.mark.parametrize("shape", [(1, 1), (4, 4), (7, 5), (1, 9), (33, 2)])
def test_every_level_has_the_mean_of_the_image(shape):
    image = np.random.default_rng(1).random((*shape, 4)).astype(np.float32)
    levels = pyramid(image)
    assert levels[-1].shape == (1, 1, 4) and len(levels) == int(np.ceil(np.log2(max(shape)))) + 1
    for level in levels:
        # halves of odd sizes share texels, each counted by how much of it they cover
        np.testing.assert_allclose(level.mean((0, 1)), image.mean((0, 1)), atol=1e-6)


def test_a_footprint_sees_the_mean_under_it():
    """A ramp along u, one hump of a cosine: footprints along u see it averaged, across they see it as it is."""
    n = 64
    u = (np.arange(n) + 0.5) / n
    image = np.broadcast_to(np.cos(2 * np.pi * u)[None, :, None], (n, n, 4)).astype(np.float32)
    at = np.stack([np.array([0.1, 0.3, 0.77, 5.3, -2.45]), np.full(5, 0.5)], 1)
    for jx, jy, width in (
        ((0.25, 0.0), (0.0, 0.01), 0.25),
        ((0.0, 0.4), (0.01, 0.0), 0.0),
        ((0.002, 0.0), (0.0, 0.002), 0.0),
    ):
        # the mean of cos over a width w is sinc(w) of it; levels blur by a texel or two more, (pi 2 / 64)^2 / 6 < 1 %
        expected = np.cos(2 * np.pi * at[:, 0]) * np.sinc(width)
        np.testing.assert_allclose(look(image, at, jx, jy)[:, 0], expected, atol=0.02)
    assert np.abs(look(image, at, (3.0, 0.0), (0.0, 3.0))).max() < 0.02


def test_directions_are_averaged_as_lines():
    """179 and 1 degrees meet at 0, not at 90; opposite vectors are the same line."""
    angles = np.radians([[179.0, 1.0]])
    turned = np.zeros((1, 2, 4), np.float32)
    turned[..., 0] = angles / np.pi
    vectors = np.zeros((1, 2, 4), np.float32)
    vectors[..., 0], vectors[..., 1] = 0.5 + 0.5 * np.cos(angles), 0.5 + 0.5 * np.sin(angles)
    for image in (doubled(turned, "angle"), doubled(vectors, "vector"), doubled(1.0 - vectors, "vector")):
        mean = pyramid(image)[-1][0, 0]
        assert 0.5 * np.arctan2(mean[1], mean[0]) == pytest.approx(0.0, abs=1e-5)
        assert np.hypot(*mean[:2]) == pytest.approx(np.cos(np.radians(2.0)), abs=1e-5)
    grey = np.full((1, 1, 4), 127.0 / 255.0, np.float32)
    assert not doubled(grey, "vector").any()
    assert not doubled_vectors(np.zeros((2, 2))).any()
    with pytest.raises(ValueError, match="encoding"):
        doubled(grey, "polar")
