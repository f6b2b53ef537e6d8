import numpy as np
import OpenImageIO as oiio
import pytest

from scratchwarp import image


def srgb(linear):
    """IEC 61966-2-1."""
    x = np.clip(linear, 0, 1)
    return np.where(x <= 0.0031308, 12.92 * x, 1.055 * x ** (1 / 2.4) - 0.055)


def read_png(path):
    hints = oiio.ImageSpec()
    hints.attribute("oiio:UnassociatedAlpha", 1)
    return oiio.ImageInput.open(str(path), hints).read_image(oiio.UINT8)


def test_png_is_the_srgb_curve(tmp_path, small_film):
    """8 bits round to half a step; OpenColorIO's curve differs from the formula by less than 1e-5."""
    film = small_film()
    image.write(film, tmp_path / "a.png")
    shown = read_png(tmp_path / "a.png")
    assert shown.shape == (5, 7, 3)
    np.testing.assert_allclose(shown, srgb(film.aovs["color"]) * 255, atol=0.51)


def test_disabled_correction_keeps_linear_values(tmp_path, small_film):
    film = small_film()
    image.write(film, tmp_path / "a.png", view=image.color_view("disabled"))
    np.testing.assert_allclose(read_png(tmp_path / "a.png"), np.clip(film.aovs["color"], 0, 1) * 255, atol=0.51)


def test_straight_alpha(tmp_path, small_film):
    film = small_film()
    film.aovs["color"][:] = 0.25
    film.aovs["alpha"][:] = 0.5
    film.aovs["alpha"][0, 0] = 0  # light that covers nothing
    film.aovs["alpha"][0, 1] = 0
    film.aovs["color"][0, 1] = 0
    image.write(film, tmp_path / "a.png")
    shown = read_png(tmp_path / "a.png")
    np.testing.assert_allclose(shown[1, 1], [*(srgb(np.full(3, 0.5)) * 255), 127.5], atol=0.51)
    np.testing.assert_allclose(shown[0, 0], [255, 255, 255, 0.25 * 255], atol=0.51)
    assert shown[0, 1, 3] == 0


def test_open_color_io_views(monkeypatch):
    monkeypatch.delenv("OCIO", raising=False)
    grey = np.full((1, 1, 3), 0.18, np.float32)
    toned = image.color_view("openColorIO").apply(grey)
    assert 0.2 < toned[0, 0, 0] < srgb(0.18)  # ACES shows mid grey darker than the plain curve does
    with pytest.raises(ValueError, match="'nope'.*Un-tone-mapped"):
        image.color_view("openColorIO", "sRGB - Display", "nope").apply(grey)
    with pytest.raises(ValueError, match="'nope'.*sRGB - Display"):
        image.color_view("openColorIO", "nope").apply(grey)
    monkeypatch.setenv("OCIO", "/nowhere/config.ocio")
    with pytest.raises(ValueError, match="/nowhere/config.ocio"):
        image.color_view("openColorIO").apply(grey)


def test_color_view_refuses_what_it_does_not_know():
    with pytest.raises(ValueError, match="'gamma'.*sRGB"):
        image.color_view("gamma")
    with pytest.raises(ValueError, match="openColorIO"):
        image.color_view("sRGB", view="Raw")
