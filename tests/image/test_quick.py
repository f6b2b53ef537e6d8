"""Quick pictures are those of the sRGB view, in PNG that others read."""

import numpy as np
import OpenImageIO as oiio
import pytest

from scratchwarp.image import SRGB
from scratchwarp.image.quick import eight_bit, png


def test_it_is_the_view_within_a_step():
    ramp = np.linspace(-0.1, 1.2, 3 * 4000, dtype=np.float32).reshape(40, 100, 3)
    wanted = np.rint(255 * np.clip(SRGB.apply(ramp), 0, 1))
    assert np.abs(eight_bit(ramp).astype(int) - wanted).max() <= 1
    odd = np.array([[[np.nan, np.inf, -np.inf]]], np.float32)
    assert eight_bit(odd).tolist() == [[[0, 255, 0]]]


def test_the_png_is_read_back(tmp_path):
    pixels = np.random.default_rng(1).integers(0, 256, (5, 7, 3), dtype=np.uint8)
    (tmp_path / "a.png").write_bytes(png(pixels))
    reader = oiio.ImageInput.open(str(tmp_path / "a.png"))
    assert reader is not None
    np.testing.assert_array_equal(reader.read_image(oiio.UINT8), pixels)


def test_other_pixels_are_refused():
    with pytest.raises(ValueError, match="uint8"):
        png(np.zeros((2, 2, 4), np.uint8))
