from pathlib import Path

import numpy as np
import OpenImageIO as oiio
import pytest

from scratchwarp import image
from scratchwarp.image import exr
from scratchwarp.whole import whole


def test_exr_keeps_every_layer_at_its_precision(tmp_path, small_film):
    """Half keeps 11 bits, so colours agree to 2^-11 of their value; float layers agree exactly."""
    film = small_film()
    image.write(film, tmp_path / "a.exr")
    layers, header = image.read_layers(tmp_path / "a.exr")
    assert set(layers) == set(film.aovs)
    for name, values in film.aovs.items():
        exact = name in ("depth", "P", "primId")
        np.testing.assert_allclose(layers[name], values, rtol=0 if exact else 2**-11, atol=0 if exact else 1e-7)
    assert header["scratchwarp:seed"] == "4294967295"
    assert header["scratchwarp:spp"] == 16
    assert header["scratchwarp:wallSeconds"] == 1.5
    assert header["worldToCamera"] == film.metadata["worldToCamera"]
    assert header["compression"] == "zip"
    np.testing.assert_allclose(header["chromaticities"], exr.CHROMATICITIES, rtol=1e-6)


def test_exr_channel_names_and_types(tmp_path, small_film):
    image.write(small_film(), tmp_path / "a.exr")
    spec = oiio.ImageInput.open(str(tmp_path / "a.exr")).spec()
    kinds = dict(zip(spec.channelnames, (str(t) for t in spec.channelformats), strict=True))
    half = {"R", "G", "B", "A"}
    half |= {f"{n}.{c}" for n in ("albedo", "base", "scratches") for c in "RGB"} | {f"normal.{c}" for c in "XYZ"}
    single = {"depth.Z", "primId", "P.X", "P.Y", "P.Z"}
    assert kinds == {n: "half" for n in half} | {n: "float" for n in single}


def test_colours_beyond_half_are_written_as_float(tmp_path, small_film):
    film = small_film()
    film.aovs["color"][2, 3, 1] = 1e6
    image.write(film, tmp_path / "a.exr")
    np.testing.assert_array_equal(image.read_layers(tmp_path / "a.exr")[0]["color"], film.aovs["color"])


def test_crop_becomes_the_data_window(tmp_path, small_film):
    image.write(small_film(crop=(10, 17, 20, 25), full_size=(64, 48)), tmp_path / "a.exr")
    spec = oiio.ImageInput.open(str(tmp_path / "a.exr")).spec()
    assert (spec.x, spec.y, spec.width, spec.height) == (10, 20, 7, 5)
    assert (spec.full_x, spec.full_y, spec.full_width, spec.full_height) == (0, 0, 64, 48)
    with pytest.raises(ValueError, match="crop"):
        image.write(small_film(crop=(10, 18, 20, 25), full_size=(64, 48)), tmp_path / "b.exr")


def test_chosen_aovs(tmp_path, small_film):
    image.write(small_film(), tmp_path / "a.exr", aovs=["depth"])
    assert set(image.read_layers(tmp_path / "a.exr")[0]) == {"color", "alpha", "depth"}
    with pytest.raises(ValueError, match="'dept'.*depth"):
        image.write(small_film(), tmp_path / "b.exr", aovs=["dept"])


def test_npz_round_trip(tmp_path, small_film):
    film = small_film()
    image.write(film, tmp_path / "a.npz")
    layers, metadata = image.read_layers(tmp_path / "a.npz")
    for name, values in film.aovs.items():
        np.testing.assert_array_equal(layers[name], values)
    assert metadata["scratchwarp:seed"] == 4294967295


@pytest.mark.parametrize("suffix", image.SUFFIXES)
@pytest.mark.parametrize("value", [np.nan, np.inf])
def test_no_nan_is_written(tmp_path, suffix, value, small_film):
    film = small_film()
    film.aovs["color"][3, 2, 1] = value
    (tmp_path / f"a{suffix}").write_text("the image of yesterday")
    with pytest.raises(ValueError, match=r"'color' is (nan|inf) at pixel \(x 2, y 3\)"):
        image.write(film, tmp_path / f"a{suffix}")
    assert (tmp_path / f"a{suffix}").read_text() == "the image of yesterday"
    assert len(list(tmp_path.iterdir())) == 1


@pytest.mark.parametrize("error", [KeyboardInterrupt, RuntimeError])
def test_interrupted_write_leaves_the_old_file(tmp_path, error):
    target = tmp_path / "a.exr"
    target.write_text("old")
    with pytest.raises(error), whole(target) as draft:
        draft.write_text("half")
        raise error
    assert target.read_text() == "old"
    assert list(tmp_path.iterdir()) == [target]


def test_unknown_suffix_lists_the_known(tmp_path, small_film):
    for call in (lambda p: image.write(small_film(), p), image.check_writable):
        with pytest.raises(ValueError, match=r"'.jpg'.*\.exr, \.png, \.npz"):
            call(tmp_path / "a.jpg")


def test_unwritable_outputs_are_named_beforehand(tmp_path, small_film):
    with pytest.raises(OSError, match="no folder.*missing"):
        image.check_writable(tmp_path / "missing" / "a.exr")
    (tmp_path / "b.exr").mkdir()
    with pytest.raises(OSError, match="is a folder"):
        image.check_writable(tmp_path / "b.exr")
    image.check_writable(tmp_path / "c.exr")
    assert [path.name for path in tmp_path.iterdir()] == ["b.exr"]
    with pytest.raises(OSError, match=str(Path("missing") / "a.exr")):
        image.write(small_film(), tmp_path / "missing" / "a.exr")


def test_a_folder_that_takes_no_file_is_named_beforehand(tmp_path, monkeypatch):
    def refuse(path, mode):
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(Path, "open", refuse)
    with pytest.raises(OSError, match="a.exr.*Permission denied"):
        image.check_writable(tmp_path / "a.exr")


def test_layers_of_different_size_are_refused(tmp_path):
    with pytest.raises(ValueError, match="differ in size"):
        image.write_layers({"a": np.zeros((2, 3)), "b": np.zeros((3, 3))}, tmp_path / "a.exr")


def test_reading_back_what_is_no_image(tmp_path):
    with pytest.raises(FileNotFoundError):
        image.read_layers(tmp_path / "none.exr")
    (tmp_path / "bad.exr").write_text("no image")
    with pytest.raises(OSError, match="bad.exr"):
        image.read_layers(tmp_path / "bad.exr")
