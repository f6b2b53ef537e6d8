"""Texture look-up against a float64 reference in NumPy."""

import numpy as np
import pytest
import warp as wp

from scratchwarp.reflectance import texture_device as td
from scratchwarp.reflectance.texture import pack_textures

wp.set_module_options({"enable_backward": False})


@wp.kernel
def _look_up(
    atlas: td.TextureAtlas, index: int, wrap_s: int, wrap_t: int, uv: wp.array[wp.vec2], out: wp.array[wp.vec4]
):
    i = wp.tid()
    out[i] = td.texel_bilinear(atlas, index, uv[i], wrap_s, wrap_t)


def look_up(images, index, uv, wrap_s=2, wrap_t=2):
    out = wp.zeros(len(uv), dtype=wp.vec4, device="cpu")
    where = wp.array(np.asarray(uv, np.float32), dtype=wp.vec2, device="cpu")
    atlas = pack_textures(images)
    wp.launch(_look_up, len(uv), inputs=[atlas, index, wrap_s, wrap_t, where], outputs=[out], device="cpu")
    return out.numpy()


def reference(image, uv, wrap_s, wrap_t):
    """One texel at a time, float64."""
    h, w, _ = image.shape

    def fetch(i, size, wrap):
        if wrap == 0:
            return i if 0 <= i < size else None
        if wrap == 1:
            return min(max(i, 0), size - 1)
        if wrap == 2:
            return i % size
        return [*range(size), *reversed(range(size))][i % (2 * size)]

    result = np.zeros((len(uv), 4))
    for k, (s, t) in enumerate(uv):
        x, y = s * w - 0.5, (1 - t) * h - 0.5
        i, j = int(np.floor(x)), int(np.floor(y))
        for di, dj in ((0, 0), (1, 0), (0, 1), (1, 1)):
            column, row = fetch(i + di, w, wrap_s), fetch(j + dj, h, wrap_t)
            if column is not None and row is not None:
                result[k] += abs(1 - di - (x - i)) * abs(1 - dj - (y - j)) * image[row, column]
    return result


RNG = np.random.default_rng(0)
IMAGES = [RNG.random((h, w, 4), dtype=np.float32) for h, w in ((5, 7), (1, 1), (3, 16))]


@pytest.mark.parametrize("wrap_s", range(4))
@pytest.mark.parametrize("wrap_t", range(4))
def test_bilinear_under_every_wrap(wrap_s, wrap_t):
    uv = np.float32(RNG.uniform(-2.5, 3.5, (300, 2)))
    for index, image in enumerate(IMAGES):
        found = look_up(IMAGES, index, uv, wrap_s, wrap_t)
        # float32 coordinates up to 3.5 * 16 texels: 4e-6 of a texel, and values in [0, 1]
        np.testing.assert_allclose(found, reference(image, uv.astype(float), wrap_s, wrap_t), atol=3e-5)


def test_row_zero_is_on_top():
    image = np.zeros((2, 2, 4), np.float32)
    image[0] = 1.0
    found = look_up([image], 0, [(0.3, 0.75), (0.3, 0.25)], 1, 1)
    np.testing.assert_allclose(found[:, 0], [1.0, 0.0])


def test_far_and_bad_coordinates_stay_finite():
    uv = [(1e30, -1e30), (np.nan, 0.5), (np.inf, -np.inf), (12345.25, -54321.75)]
    for wrap in range(4):
        assert np.isfinite(look_up(IMAGES, 0, uv, wrap, wrap)).all()
    near = look_up(IMAGES, 0, [(0.25, 0.25)])
    np.testing.assert_allclose(look_up(IMAGES, 0, [(1024.25, -63.75)]), near, atol=1e-4)


def test_images_of_another_shape_are_refused():
    for bad in (np.zeros((2, 2, 3), np.float32), np.zeros((0, 2, 4), np.float32)):
        with pytest.raises(ValueError, match=r"images\[1\]"):
            pack_textures([IMAGES[0], bad])


def test_no_image_is_an_atlas_too():
    assert pack_textures([]).texels.shape[0] == 1
