import numpy as np
import OpenImageIO as oiio
import pytest

from scratchwarp import image


def save(path, pixels, kind=oiio.UINT8, **attributes):
    pixels = np.asarray(pixels)
    spec = oiio.ImageSpec(pixels.shape[1], pixels.shape[0], pixels.shape[2], kind)
    for key, value in attributes.items():
        spec.attribute(key.replace("_", ":"), value)
    out = oiio.ImageOutput.create(str(path))
    assert out.open(str(path), spec) and out.write_image(pixels) and out.close()
    return path


def to_linear(x):
    """IEC 61966-2-1."""
    return np.where(x <= 0.04045, x / 12.92, ((x + 0.055) / 1.055) ** 2.4)


RAMP = np.linspace(0, 255, 24).astype(np.uint8).reshape(2, 4, 3)


def test_eight_bit_colour_is_srgb_by_itself(tmp_path):
    path = save(tmp_path / "a.png", RAMP)
    pixels = image.read_texture(path)
    assert pixels.dtype == np.float32 and pixels.shape == (2, 4, 4)
    np.testing.assert_allclose(pixels[..., :3], to_linear(RAMP / 255), atol=2e-6)
    assert (pixels[..., 3] == 1).all()
    np.testing.assert_array_equal(image.read_texture(path, "sRGB"), pixels)
    np.testing.assert_allclose(image.read_texture(path, "raw")[..., :3], RAMP / 255, atol=1e-7)


def test_grey_is_repeated_and_raw_by_itself(tmp_path):
    pixels = image.read_texture(save(tmp_path / "a.png", RAMP[..., :1]))
    np.testing.assert_allclose(pixels[..., :3], np.repeat(RAMP[..., :1] / 255, 3, -1), atol=1e-7)
    assert (pixels[..., 3] == 1).all()


def test_alpha_is_not_multiplied_in(tmp_path):
    rgba = np.concatenate([RAMP, np.full((2, 4, 1), 51, np.uint8)], -1)
    pixels = image.read_texture(save(tmp_path / "a.png", rgba, oiio_UnassociatedAlpha=1), "raw")
    np.testing.assert_allclose(pixels, rgba / 255, atol=1e-7)
    two = image.read_texture(save(tmp_path / "b.png", rgba[..., 2:], oiio_UnassociatedAlpha=1), "raw")
    np.testing.assert_allclose(two[..., 2:], rgba[..., 2:] / 255, atol=1e-7)


@pytest.mark.parametrize("suffix", ["exr", "hdr", "tiff"])
def test_high_dynamic_range_is_left_alone(tmp_path, suffix):
    """RGBE keeps 8 bits of the largest channel, so to 1 / 128 of it."""
    values = np.array([[[4.0, 2.0, 1.0], [1000.0, 500.0, 250.0]]], np.float32)
    pixels = image.read_texture(save(tmp_path / f"a.{suffix}", values, oiio.FLOAT))
    np.testing.assert_allclose(pixels[..., :3], values, rtol=1 / 32 if suffix == "hdr" else 0)


def test_row_0_is_the_top(tmp_path):
    rows = np.array([[[0.0] * 3], [[1.0] * 3]], np.float32)
    assert image.read_texture(save(tmp_path / "a.exr", rows, oiio.FLOAT))[0, 0, 0] == 0


def test_colour_space_by_usd_name(tmp_path):
    """White stays white, and the ACEScg red primary falls outside Rec.709: AP1 red is (1.705, -0.130, -0.024)."""
    path = save(tmp_path / "a.exr", np.array([[[1, 1, 1], [1, 0, 0]]], np.float32), oiio.FLOAT)
    pixels = image.read_texture(path, "lin_ap1_scene")
    np.testing.assert_allclose(pixels[0, :, :3], [[1, 1, 1], [1.705, -0.130, -0.024]], atol=1e-3)
    for space in ("lin_rec709_scene", "data", "identity"):
        np.testing.assert_array_equal(image.read_texture(path, space)[0, 1], [1, 0, 0, 1])
    with pytest.raises(ValueError, match="'srbg'"):
        image.read_texture(path, "srbg")


def test_what_cannot_be_read_is_named(tmp_path):
    with pytest.raises(FileNotFoundError, match="none.png"):
        image.read_texture(tmp_path / "none.png")
    (tmp_path / "bad.png").write_text("this is no image")
    with pytest.raises(OSError, match="bad.png"):
        image.read_texture(tmp_path / "bad.png")
    (tmp_path / "bad.txt").write_text("this is no image")
    with pytest.raises(OSError, match="bad.txt"):
        image.read_texture(tmp_path / "bad.txt")


def test_cut_off_file_is_named(tmp_path):
    noise = np.random.default_rng(1).integers(0, 255, (64, 64, 3), np.uint8)
    path = save(tmp_path / "a.png", noise)
    path.write_bytes(path.read_bytes()[:2000])
    with pytest.raises(OSError, match="a.png"):
        image.read_texture(path)


def test_nan_and_inf_texels(tmp_path):
    values = np.ones((2, 3, 3), np.float32)
    values[1, 2, 0] = np.inf
    path = save(tmp_path / "a.exr", values, oiio.FLOAT)
    assert image.read_texture(path)[1, 2, 0] == 65504
    values[0, 1, 2] = np.nan
    with pytest.raises(ValueError, match=r"pixel \(1, 0\) is NaN"):
        image.read_texture(save(tmp_path / "a.exr", values, oiio.FLOAT))
