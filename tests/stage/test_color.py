"""Colours in linear Rec.709."""

import numpy as np
import pytest
from pxr import Gf

from scratchwarp.stage.color import to_rec709

SPACES = [
    "lin_ap1_scene",
    "lin_rec2020_scene",
    "srgb_rec709_scene",
    "g22_rec709_scene",
    "srgb_p3d65_scene",
    "g22_ap1_scene",
]


@pytest.mark.parametrize("space", SPACES)
def test_agrees_with_usd(space):
    """Gf.ColorSpace converts one single-precision colour at a time: 1e-5 is its rounding after the transfer curve."""
    colors = np.random.default_rng(0).random((32, 3))
    target = Gf.ColorSpace("lin_rec709_scene")
    expected = [target.Convert(Gf.ColorSpace(space), Gf.Vec3f(*c)).GetRGB() for c in colors.tolist()]
    np.testing.assert_allclose(to_rec709(colors, space), np.array(expected), atol=1e-5)


def test_srgb_is_the_standards_own_curve():
    """IEC 61966-2-1: 0.5 -> 0.21404, and the straight piece below 0.04045."""
    got = to_rec709([[0.5, 0.04, 1.0]], "srgb_rec709_scene")
    np.testing.assert_allclose(got, [[0.2140411, 0.04 / 12.92, 1.0]], rtol=2e-4)


@pytest.mark.parametrize("space", ["", "raw", "data", "identity", "unknown", "lin_rec709_scene"])
def test_some_spaces_leave_values_alone(space):
    np.testing.assert_array_equal(to_rec709([[0.1, -2.0, 30.0]], space), [[0.1, -2.0, 30.0]])


def test_unknown_spaces_are_refused_here_and_warned_of_on_stages(read, said):
    with pytest.raises(ValueError, match="'mauve'"):
        to_rec709([1, 2, 3], "mauve")
    scene = read('def RectLight "l" { color3f inputs:color = (1, 0.5, 0.25) ( colorSpace = "mauve" ) }')
    said(scene, "/l.inputs:color", "mauve")
    np.testing.assert_allclose(scene.lights[0].radiance, [1, 0.5, 0.25])


def test_color_space_api_is_inherited(read):
    """A linear Rec.2020 colour on a light below a prim with ColorSpaceAPI."""
    scene = read("""
def Xform "x" (prepend apiSchemas = ["ColorSpaceAPI"]) {
    uniform token colorSpace:name = "lin_rec2020_scene"
    def RectLight "l" { color3f inputs:color = (0.25, 0.5, 0.75) }
}""")
    np.testing.assert_allclose(scene.lights[0].radiance, to_rec709([0.25, 0.5, 0.75], "lin_rec2020_scene"), rtol=1e-6)
