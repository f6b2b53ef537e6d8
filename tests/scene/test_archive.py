"""NumPy files that claim more than they hold, or than there is memory: one message, before anything is allocated."""

import io
import struct
import zipfile

import numpy as np
import pytest

from scratchwarp import image, profiles
from scratchwarp.pipelines import profile_from_topography
from scratchwarp.scene import Budget, TooLarge, check_archive


def header(shape, dtype="<f8"):
    """The head of an .npy file that claims a shape, and two numbers of it."""
    text = repr({"descr": dtype, "fortran_order": False, "shape": shape}).encode() + b"\n"
    return b"\x93NUMPY\x01\x00" + struct.pack("<H", len(text)) + text + bytes(16)


def archive(path, **members):
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as made:
        for name, data in members.items():
            made.writestr(f"{name}.npy", data)
    return path


@pytest.mark.parametrize("shape", [(10**6, 10**6), (1 << 62, 8), (3,)])
def test_more_than_is_there(tmp_path, shape):
    path = archive(tmp_path / "map.npz", height_m=header(shape), dx_m=header(()), dy_m=header(()))
    with pytest.raises(TooLarge, match=r"map\.npz: height_m: claims to be an array of .* and holds 16; it is damaged"):
        profile_from_topography.load(path)
    with pytest.raises(ValueError, match=r"map\.npz: height_m"):
        image.read_layers(path)
    plain = tmp_path / "map.npy"
    plain.write_bytes(header(shape))
    with pytest.raises(ValueError, match=r"map\.npy: claims to be"):
        profile_from_topography.load(plain, pitch=1.0)


def test_more_than_there_is_memory_for(tmp_path):
    """A hundred megabytes of zeros in a hundred kilobytes, where a few are allowed."""
    path = archive(tmp_path / "bomb.npz", height_m=header((100, 10**6), "|i1")[:-16] + bytes(10**8))
    assert path.stat().st_size < 200_000
    check_archive(path)
    with pytest.raises(TooLarge, match=r"bomb\.npz: height_m: an array of 100 x 1000000 int8 would take"):
        check_archive(path, Budget(5e7))


def test_a_table_that_is_damaged_is_simulated_again(tmp_path):
    profile = profiles.shape("quartic", depth=0.5)
    kept = profiles.store(tmp_path)
    first = profiles.simulate(profile, resolution=16, rays=8, store=kept)
    (file,) = tmp_path.glob("*.npz")
    archive(file, by_bounce=header((10**5, 10**5)))
    again = profiles.simulate(profile, resolution=16, rays=8, store=kept)
    np.testing.assert_array_equal(first.by_bounce, again.by_bounce)


def test_what_is_no_array_is_left_to_its_reader(tmp_path):
    for data in (b"", b"hello", header((2,))):
        stream = io.BytesIO(data)
        check_archive(stream)
        assert stream.tell() == 0
    path = tmp_path / "map.npz"
    path.write_bytes(b"PK nothing")
    with pytest.raises(ValueError, match=r"map\.npz: holds no height map"):
        profile_from_topography.load(path)
