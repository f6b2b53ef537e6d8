"""Where the image lies: apertures, offsets and conform policies of both projections, against Mitsuba 3.

Each window is worked out by hand from UsdGeom's camera (20 x 15 at focal length 35) and UsdRender's policies. Edges of
the ball and the floor cross the image, so a window off by a twentieth of a pixel is off by 5 % of a pixel on them.
"""

import numpy as np
import pytest

from .ball_stage import APERTURE, pair
from .mitsuba_reference import agreement, luminance, rgb

SUN = """
def DistantLight "light"
{
    float inputs:angle = 0
    float inputs:intensity = 3
    double3 xformOp:rotateXYZ = (-90, 0, 0)
    uniform token[] xformOpOrder = ["xformOp:rotateXYZ"]
}
def RenderSettings "settings"
{
    rel camera = </camera>
    uniform token aspectRatioConformPolicy = "POLICY"
    uniform int2 resolution = (640, 480)
}
"""
METADATA = 'renderSettingsPrimPath = "/settings"'
OFFSETS = "float horizontalApertureOffset = {}\n float verticalApertureOffset = {}"
# policy, image size, (horizontal, vertical) offset, window, Mitsuba's pixel
PERSPECTIVE = {
    # higher than the aperture: the height grows to 20 * 30 / 20
    "portrait": ("expandAperture", (20, 30), (2, -1), (-8, 12, -16, 14), 0.25),
    # wider: the width is kept and the height shrinks to 20 / 2
    "crop wide": ("cropAperture", (40, 20), (1.5, 1), (-8.5, 11.5, -4, 6), 0.125),
    # higher: the height is kept and the width shrinks to 15 / 2
    "crop high": ("cropAperture", (15, 30), (0.5, 0.25), (-3.25, 4.25, -7.25, 7.75), 0.125),
    "adjust width": ("adjustApertureWidth", (30, 20), (0, 0.75), (-11.25, 11.25, -6.75, 8.25), 0.1875),
    "adjust height": ("adjustApertureHeight", (40, 10), (0, 0.5), (-10, 10, -2, 3), 0.125),
    # the aperture stays, pixels become 1 x 0.75
    "adjust pixels": ("adjustPixelAspectRatio", (20, 20), (1, 0.75), (-9, 11, -6.75, 8.25), 0.125),
}


def same(ours, theirs, variance):
    region = ours["alpha"] == 1.0
    off, _ = agreement(ours, theirs, variance, region)
    edges = (np.diff(ours["primId"], axis=0) != 0).sum()
    assert region.sum() > 50 and edges > 10
    assert off < 5e-3
    # an edge is found by 1024 stratified samples in ours and in theirs: some 0.5 % of a pixel
    worst = np.abs(luminance(ours["color"]) - luminance(theirs)).max() / luminance(theirs).max()
    print(worst)
    assert worst < 0.02, worst


LIGHT = {"type": "directional", "direction": [0, -1, 0], "irradiance": rgb(3)}


@pytest.mark.parametrize("name", PERSPECTIVE)
def test_perspective(tmp_path, name):
    policy, size, offsets, window, pixel = PERSPECTIVE[name]
    text = SUN.replace("POLICY", policy)
    same(*pair(tmp_path, text, LIGHT, window, pixel, size, APERTURE + OFFSETS.format(*offsets), METADATA))


def test_orthographic(tmp_path):
    # aperture in tenths of stage units: 8 x 6, widened to 12 x 6; offsets 0.6 and 0.3; a pixel is 0.3
    camera = """uniform token projection = "orthographic"
    float horizontalAperture = 80
    float verticalAperture = 60
    """ + OFFSETS.format(6, 3)
    text = SUN.replace("POLICY", "expandAperture")
    same(*pair(tmp_path, text, LIGHT, (-5.4, 6.6, -2.7, 3.3), 0.06, (40, 20), camera, METADATA, None))


def test_depth_of_field(tmp_path):
    """fStop 4 at 3.5 units of focal length: a lens of radius 3.5 / 4 / 2, sharp at the plane 5 units away."""
    camera = APERTURE + "float fStop = 4\n float focusDistance = 5"
    window, lens = (-10, 10, -7.5, 7.5), (3.5 / 4 / 2, 5.0)
    text = SUN.replace("POLICY", "expandAperture")
    ours, theirs, variance = pair(tmp_path, text, LIGHT, window, 0.25, (40, 30), camera, METADATA, lens=lens, spp=2048)
    sharp, _, _ = pair(tmp_path, text, LIGHT, window, 0.25, (40, 30), metadata=METADATA, spp=64)
    assert np.abs(luminance(sharp["color"]) - luminance(theirs)).max() > 0.2 * theirs.max()
    assert np.abs(luminance(ours["color"]) - luminance(theirs)).max() < 0.03 * luminance(theirs).max()
    assert abs(ours["color"].mean() / theirs.mean() - 1) < 2e-3
