"""Cameras: which one, what it sees, how it is exposed."""

import numpy as np
import pytest
from pxr import Gf, Usd, UsdGeom

from scratchwarp import stage
from scratchwarp.scene import StageError

MESH = """
def Mesh "m" {
    int[] faceVertexCounts = [4]
    int[] faceVertexIndices = [0, 1, 2, 3]
    point3f[] points = [(4, 0, 7), (9, 0, 7), (9, 0, 9), (4, 0, 9)]
    uniform token subdivisionScheme = "none"
}
"""
BODY = """
def Xform "x" {
    double3 xformOp:translate = (1, 2, 3)
    float3 xformOp:rotateXYZ = (10, 20, 30)
    double3 xformOp:scale = (2, 2, 2)
    uniform token[] xformOpOrder = ["xformOp:translate", "xformOp:rotateXYZ", "xformOp:scale"]
    def Camera "c" {
        token projection = "%s"
        float horizontalAperture = 30
        float verticalAperture = 20
        float horizontalApertureOffset = 4
        float verticalApertureOffset = -3
        float focalLength = 40
        float2 clippingRange = (0.5, 100)
        float fStop = 2
        float focusDistance = 7
    }
}
"""


@pytest.mark.parametrize("projection", ["perspective", "orthographic"])
def test_rays_agree_with_usd(write, projection):
    """Gf.Frustum's own pick rays, in world space; single precision of the camera's attributes allows 1e-5."""
    metres = 0.1
    path = write(BODY % projection, metres=metres)
    scene = stage.read(path)
    opened = Usd.Stage.Open(str(path))
    frustum = UsdGeom.Camera.Get(opened, "/x/c").GetCamera().frustum
    left, right, bottom, top = scene.camera.window(300, 200)
    for u, v in [(0.5, 0.5), (0.0, 0.0), (1.0, 0.25), (0.3, 0.9)]:
        ray = frustum.ComputePickRay(Gf.Vec2d(2 * u - 1, 2 * v - 1))
        at = np.array([left + u * (right - left), bottom + v * (top - bottom), 0.0])
        if projection == "perspective":
            origin, direction = np.zeros(3), at + [0, 0, -1]
        else:
            origin, direction = at, np.array([0.0, 0.0, -1.0])
        rotation = scene.camera.transform[:3, :3]
        direction = rotation @ direction / np.linalg.norm(direction)
        np.testing.assert_allclose(direction, np.array(ray.direction), atol=1e-5)
        start = (rotation @ origin + scene.origin) / metres
        # The ray's start may lie anywhere along it: compare its distance from our line.
        aside = np.cross(np.array(ray.startPoint) - start, direction)
        np.testing.assert_allclose(aside, 0, atol=1e-4)


def test_lens_clipping_and_scale(read):
    camera = read(BODY % "perspective", metres=0.01).camera
    # focalLength / (2 fStop) = 10 tenths of a unit = 1 unit = 0.01 m; the scale of 2 counts for nothing.
    assert camera.lens_radius == pytest.approx(0.01)
    assert camera.focus_distance == pytest.approx(0.07)
    assert (camera.near, camera.far) == pytest.approx((0.005, 1.0))
    np.testing.assert_allclose(camera.transform[:3, :3] @ camera.transform[:3, :3].T, np.eye(3), atol=1e-12)
    np.testing.assert_array_equal(camera.transform[:3, 3], 0)


def test_orthographic_apertures_are_tenths_of_a_unit(read):
    camera = read(BODY % "orthographic", metres=0.01).camera
    assert camera.horizontal_aperture == pytest.approx(0.03)
    assert camera.vertical_offset == pytest.approx(-0.003)


def test_exposure_is_usds_own_product(read):
    camera = read("""def Camera "c" {
    float exposure = 1
    float exposure:iso = 400
    float exposure:time = 0.5
    float exposure:fStop = 2
    float exposure:responsivity = 3
}""").camera
    assert camera.exposure == pytest.approx(3 * 0.5 * 4 * 2 / 4)


def test_which_camera(read, said):
    two = 'def Camera "first" {}\ndef Xform "x" { def Camera "main_cam" {} def Camera "third" {} }\n'
    assert read(two).camera.path == "/x/main_cam"
    assert read(two, camera="third").camera.path == "/x/third"
    assert read(two, camera="/first").camera.path == "/first"
    assert read(two, camera="x/third").camera.path == "/x/third"
    with pytest.raises(StageError, match="no camera 'fourth'.*/first, /x/main_cam, /x/third"):
        read(two, camera="fourth")
    several = read('def Camera "a" {}\ndef Camera "b" {}')
    assert several.camera.path == "/a"
    said(several, "/a", "first of 2 cameras")


@pytest.mark.parametrize("up", ["Y", "Z"])
def test_without_a_camera_everything_is_framed(read, said, up):
    scene = read(MESH, up=up)
    said(scene, "no camera")
    low, high = scene.bounds()
    corners = np.array([[x, y, z] for x in (low[0], high[0]) for y in (low[1], high[1]) for z in (low[2], high[2])])
    local = corners @ scene.camera.transform[:3, :3]
    left, right, bottom, top = scene.camera.window(640, 480)
    assert (local[:, 2] < 0).all()
    x, y = local[:, 0] / -local[:, 2], local[:, 1] / -local[:, 2]
    assert left <= x.min() and x.max() <= right and bottom <= y.min() and y.max() <= top
    # Half of the frame's width at least is used in one direction, and up is up.
    assert max((x.max() - x.min()) / (right - left), (y.max() - y.min()) / (top - bottom)) > 0.4
    assert scene.camera.transform[:3, 1] @ scene.up > 0.5


def test_a_mirrored_camera_and_odd_values_warn(read, said):
    scene = read("""def Camera "c" {
    double3 xformOp:scale = (-1, 1, 1)
    uniform token[] xformOpOrder = ["xformOp:scale"]
    float focalLength = -5
    float2 clippingRange = (9, 1)
    float fStop = 4
    float4[] clippingPlanes = [(1, 0, 0, 0)]
}""")
    for word in ("mirrors", "focalLength is -5", "clippingRange", "pinhole", "clippingPlanes"):
        said(scene, "/c", word)
    assert np.linalg.det(scene.camera.transform) == pytest.approx(1)
    assert scene.camera.lens_radius == 0 and scene.camera.focal_length == 50


def test_a_collapsed_camera_is_refused(read):
    with pytest.raises(StageError, match="/c has a transform"):
        read("""def Camera "c" {
    double3 xformOp:scale = (0, 0, 0)
    uniform token[] xformOpOrder = ["xformOp:scale"]
}""")


def test_animated_camera(read):
    text = """def Camera "c" {
    double3 xformOp:translate.timeSamples = { 0: (0, 0, 0), 10: (10, 0, 0) }
    uniform token[] xformOpOrder = ["xformOp:translate"]
    float focalLength.timeSamples = { 0: 20, 10: 40 }
}"""
    scene = read(text, frame=5)
    np.testing.assert_allclose(scene.origin, [5, 0, 0])
    assert scene.camera.focal_length == 30
