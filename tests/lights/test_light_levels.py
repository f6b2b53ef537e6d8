"""Smaller copies of a latlong image keep the light of every texel over its solid angle."""

import numpy as np
import pytest

from scratchwarp.lights.levels import levels


@pytest.mark.parametrize("shape", [(32, 64), (17, 33), (5, 3)])
def test_levels_keep_the_light(shape):
    pixels = np.random.default_rng(0).random((*shape, 4)).astype(np.float32)

    def light(image):
        band = -np.diff(np.cos(np.pi * np.arange(image.shape[0] + 1) / image.shape[0]))
        return np.einsum("ijc,i->c", image, band, dtype=np.float64) / image.shape[1]

    made = levels(pixels)
    assert made[0].shape == ((shape[0] + 1) // 2, (shape[1] + 1) // 2, 4) and made[-1].shape[0] == 2
    for image in made:
        np.testing.assert_allclose(light(image), light(pixels), rtol=1e-5)
    assert np.allclose(levels(np.ones((*shape, 4), np.float32))[-1], 1.0)
