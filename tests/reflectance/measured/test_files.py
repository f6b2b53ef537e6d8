"""Files of measured BRDFs: round trips bit for bit, and one clear message for what is damaged or foreign."""

import os
import struct
from pathlib import Path

import numpy as np
import pytest

from scratchwarp import measured, stencils

from .synthetic import grid, rgl_fields, smooth, write_merl, write_tensors

REAL = os.environ.get("SCRATCHWARP_UTIA")


@pytest.fixture
def values():
    return np.random.default_rng(0).normal(size=(288, 288, 3))


def test_utia_round_trip_is_exact(tmp_path, values):
    path = tmp_path / "a.bin"
    measured.save_utia(path, values)
    brdf = measured.load(path)
    np.testing.assert_array_equal(np.asarray(brdf), values)
    assert brdf.format == "utia" and brdf.path == str(path)
    measured.save_utia(tmp_path / "b.bin", brdf)
    assert (tmp_path / "b.bin").read_bytes() == path.read_bytes()


def test_utia_layout(tmp_path, values):
    """Planes of red, green, blue; in each a row an illumination and a column a view; float64."""
    path = tmp_path / "a.bin"
    measured.save_utia(path, values)
    raw = np.fromfile(path, "<f8")
    assert path.stat().st_size == 1990656
    assert raw[(2 * 288 + 17) * 288 + 5] == values[17, 5, 2]


def test_formats_are_known_by_their_contents_too(tmp_path, values):
    measured.save_utia(tmp_path / "a", values)
    write_merl(tmp_path / "b", np.ones((3, 90, 90, 180)))
    write_tensors(tmp_path / "c", rgl_fields([0.0, 1.0]))
    assert [measured.load(tmp_path / name).format for name in "abc"] == ["utia", "merl", "rgl"]


def test_damaged_files_name_file_and_size(tmp_path, values):
    path = tmp_path / "broken.bin"
    measured.save_utia(path, values)
    whole = path.read_bytes()
    path.write_bytes(whole[:-1])
    with pytest.raises(ValueError, match=r"broken\.bin: 1990655 bytes, but a UTIA BRDF has 1990656.*truncated"):
        measured.load(path)
    path.write_bytes(whole + b"x")
    with pytest.raises(ValueError, match="1990657 bytes.*another format"):
        measured.load(path)
    path.write_bytes(struct.pack("<d", np.nan) + whole[8:])
    with pytest.raises(ValueError, match=r"broken\.bin: 1 of 248832 values.*not finite"):
        measured.load(path)
    path.write_bytes(b"")
    with pytest.raises(ValueError, match="0 bytes"):
        measured.load(path)
    foreign = tmp_path / "picture.png"
    foreign.write_bytes(b"\x89PNG" + bytes(100))
    with pytest.raises(ValueError, match=r"picture\.png: 104 bytes are no BRDF of UTIA"):
        measured.load(foreign)
    with pytest.raises(OSError, match="missing"):
        measured.load(tmp_path / "missing.bin")


def test_damaged_merl(tmp_path):
    path = tmp_path / "m.binary"
    write_merl(path, np.ones((3, 90, 90, 180)))
    whole = path.read_bytes()
    for data, message in (
        (whole[:5000], "5000 bytes, but a MERL BRDF has 34992012; the file is truncated"),
        (whole + b"x", "too long"),
        (b"abc", r"3 bytes that do not begin with 90 90 180"),
        (struct.pack("<3i", 90, 90, 360) + whole[12:], "do not begin with 90 90 180"),
    ):
        path.write_bytes(data)
        with pytest.raises(ValueError, match=message):
            measured.load(path)


def test_damaged_rgl(tmp_path):
    path = tmp_path / "r.bsdf"
    fields = rgl_fields([0.0, 1.0])
    write_tensors(path, fields)
    whole = path.read_bytes()
    for data, message in (
        (whole[:-10], "the file is truncated"),
        (whole[:40], "end inside the list of fields"),
        (b"RIFF" + whole, "do not begin with tensor_file"),
        (whole[:12] + bytes([7]) + whole[13:], "version 7.0"),
    ):
        path.write_bytes(data)
        with pytest.raises(ValueError, match=rf"r\.bsdf: .*{message}"):
            measured.load(path)
    for change, message in (
        ({"ndf": None}, "has no field 'ndf'"),
        ({"rgb": None, "spectra": fields["rgb"]}, "ends in _rgb.bsdf"),
        ({"sigma": np.float32([1.0, 2.0])}, "field 'sigma' is float32"),
        ({"theta_i": fields["theta_i"][::-1].copy()}, "'theta_i' must ascend"),
        ({"phi_i": np.float32([0.0, 1.0, 2.0])}, "field 'vndf' has shape"),
    ):
        write_tensors(path, {k: v for k, v in {**fields, **change}.items() if v is not None})
        with pytest.raises(ValueError, match=message):
            measured.load(path)


def test_what_cannot_be_saved(tmp_path):
    for brdf, message in ((np.zeros((3, 288, 288)), "shape"), (np.full((288, 288, 3), np.inf), "finite")):
        with pytest.raises(ValueError, match=f"brdf must.*{message}"):
            measured.save_utia(tmp_path / "x.bin", brdf)
    assert not (tmp_path / "x.bin").exists()


def test_the_fit_takes_a_measurement(tmp_path):
    w = grid()
    measured.save_utia(tmp_path / "a.bin", smooth(w[:, None], w[None], 0.7, 0.08))
    brdf = measured.load(tmp_path / "a.bin")
    model = stencils.fit(brdf, modes=1)
    # a Gaussian that fades along its ridge is no stencil: one mode reaches 27 dB, further ones mend its shape
    assert measured.compare(brdf, stencils.unfolded(model))["psnr"] > 25.0
    assert measured.compare(brdf, stencils.unfolded(stencils.fit(brdf)))["psnr"] > 30.0
    # the lobe is wide in x, so that the scratches run along y
    assert abs(np.degrees(model.modes[0].azimuth) - 90.0) < 1.0


@pytest.mark.skipif(not REAL, reason="SCRATCHWARP_UTIA names no folder of measured BRDFs")
def test_real_measurements(tmp_path):
    files = sorted(Path(str(REAL)).glob("*.bin"))
    assert files, f"no .bin in {REAL}"
    for file in files[:3]:
        brdf = measured.load(file)
        measured.save_utia(tmp_path / file.name, brdf)
        assert (tmp_path / file.name).read_bytes() == file.read_bytes()
        ours = measured.compare(brdf, stencils.unfolded(stencils.fit(brdf)))
        assert ours["psnr"] > 20.0, f"{file.name}: {ours}"
