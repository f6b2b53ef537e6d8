"""Normal maps as files: what is written comes back, and maps of other programs are understood."""

import numpy as np
import OpenImageIO as oiio
import pytest

from scratchwarp import image


@pytest.fixture
def normals():
    n = np.random.default_rng(0).normal(size=(7, 11, 3))
    n[..., 2] = np.abs(n[..., 2]) + 0.1
    return (n / np.linalg.norm(n, axis=-1, keepdims=True)).astype(np.float32)


def test_round_trip(normals, tmp_path):
    """16 bits: a step of 2 / 65535; float: its own rounding."""
    for name, off in (("a.png", 3e-5), ("a.exr", 3e-7)):
        image.write_normals(normals, tmp_path / name)
        np.testing.assert_allclose(image.read_normals(tmp_path / name), normals, atol=off)
    assert oiio.ImageInput.open(str(tmp_path / "a.png")).spec().format == oiio.UINT16


def test_what_a_preview_surface_reads(normals, tmp_path):
    """scale 2, bias -1, raw."""
    image.write_normals(normals, tmp_path / "a.png")
    raw = image.read_texture(tmp_path / "a.png", "auto")
    np.testing.assert_allclose(2.0 * raw[..., :3] - 1.0, normals, atol=3e-5)


def _write(path, pixels, kind):
    output = oiio.ImageOutput.create(str(path))
    output.open(str(path), oiio.ImageSpec(pixels.shape[1], pixels.shape[0], pixels.shape[2], kind))
    output.write_image(pixels)
    output.close()


def test_maps_of_other_programs(normals, tmp_path):
    """8 bits, y downwards, two channels' worth of data, signed floats, a hole."""
    _write(tmp_path / "eight.png", np.rint(255 * (0.5 * normals + 0.5)).astype(np.uint8), oiio.UINT8)
    np.testing.assert_allclose(image.read_normals(tmp_path / "eight.png"), normals, atol=0.02)
    flipped = normals * np.float32([1, -1, 1])
    image.write_normals(flipped, tmp_path / "directx.png")
    np.testing.assert_allclose(image.read_normals(tmp_path / "directx.png", flip_green=True), normals, atol=3e-5)
    flat = (0.5 * normals + 0.5) * np.float32([1, 1, 0])
    _write(tmp_path / "two.exr", flat.astype(np.float32), oiio.FLOAT)
    np.testing.assert_allclose(image.read_normals(tmp_path / "two.exr"), normals, atol=1e-5)
    signed = normals.copy()
    signed[0, 0] = 0.0
    signed[0, 1] = (0.0, -0.6, -0.8)
    _write(tmp_path / "signed.exr", signed, oiio.FLOAT)
    found = image.read_normals(tmp_path / "signed.exr")
    np.testing.assert_array_equal(found[0, :2], np.float32([[0, 0, 1], [0, -1, 0]]))
    np.testing.assert_allclose(found[1:], normals[1:], atol=1e-6)


def test_bad_input_is_named(normals, tmp_path):
    for values, name, message in (
        (normals, "a.jpg", r"a\.jpg: the suffix"),
        (normals[..., :2], "a.png", "shape"),
        (2.0 * normals, "a.png", "unit, got a length of 2"),
        (np.full((2, 2, 3), np.nan), "a.png", "unit"),
    ):
        with pytest.raises(ValueError, match=message):
            image.write_normals(values, tmp_path / name)
    with pytest.raises(OSError, match="no such"):
        image.write_normals(normals, tmp_path / "no such" / "a.png")
    assert not list(tmp_path.iterdir())
