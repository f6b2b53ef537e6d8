"""Explicit scratches on BasisCurves."""

import numpy as np
import pytest
from scipy.interpolate import BSpline, CubicHermiteSpline

from scratchwarp.scene import StageError
from scratchwarp.stage.curve_basis import STEPS, CurveKind, polylines

LAYER = """
def Mesh "m" (prepend apiSchemas = ["MaterialBindingAPI"]) {
    rel material:binding = </mat>
    int[] faceVertexCounts = [3]
    int[] faceVertexIndices = [0, 1, 2]
    point3f[] points = [(0, 0, 0), (1, 0, 0), (1, 1, 0)]
    uniform token subdivisionScheme = "none"
}
def Material "mat" (prepend apiSchemas = ["ScratchLayerAPI:own"]) {
    uniform token scratch:layer:own:distribution = "curves"
    float scratch:layer:own:width = 7
    float scratch:layer:own:depth = 3
    rel scratch:layer:own:curves = </w/c>
    rel scratch:layer:own:profile = </mat/p>
    def ScratchProfile "p" {}
}
def Camera "cam" {
    double3 xformOp:translate = (0, 0, 10)
    uniform token[] xformOpOrder = ["xformOp:translate"]
}
"""


def curves(body, kind='uniform token type = "linear"'):
    return f"""{LAYER}
def Xform "w" {{
    double3 xformOp:scale = (2, 2, 2)
    uniform token[] xformOpOrder = ["xformOp:scale"]
    def BasisCurves "c" (prepend apiSchemas = ["ScratchCurvesAPI"]) {{
        {kind}
        int[] curveVertexCounts = [2, 3]
        point3f[] points = [(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0), (1, 2, 0)]
        {body}
    }}
}}
"""


def test_points_and_widths_follow_the_transform_depths_do_not(read):
    """Widths are diameters in object space: 5e-6 units, scaled by 2, of 0.01 m each make 0.1 um."""
    body = """
        float[] widths = [0.000005] ( interpolation = "constant" )
        float[] primvars:scratch:depth = [1, 2] ( interpolation = "uniform" )
"""
    scene = read(curves(body), metres=0.01)
    (got,) = scene.curves
    assert scene.materials[0].layers[0].curves == (0,)
    assert got.counts.tolist() == [2, 3] and (got.width_unit, got.depth_unit) == ("um", "um")
    np.testing.assert_allclose(
        got.points + scene.origin, 0.02 * np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0), (1, 1, 0), (1, 2, 0)]), atol=1e-12
    )
    np.testing.assert_allclose(got.widths, 0.1, rtol=1e-6)
    np.testing.assert_allclose(got.depths, [1, 1, 2, 2, 2])


def test_the_width_primvar_is_in_micrometres(read):
    body = """
        float[] widths = [1] ( interpolation = "constant" )
        float[] primvars:scratch:width = [1, 2, 3, 4, 5] ( interpolation = "vertex" )
        float[] primvars:scratch:depth = [9, 8] ( interpolation = "uniform" )
        int[] primvars:scratch:depth:indices = [1, 0]
"""
    (got,) = read(curves(body), metres=0.01).curves
    np.testing.assert_allclose(got.widths, [1, 2, 3, 4, 5])
    np.testing.assert_allclose(got.depths, [8, 8, 9, 9, 9])


def test_what_curves_leave_out_the_layer_gives(read, said):
    scene = read(curves(""))
    np.testing.assert_allclose(scene.curves[0].widths, 7)
    np.testing.assert_allclose(scene.curves[0].depths, 3)
    said(scene, "/w/c", "no widths")


def test_uv_space_is_not_transformed(read):
    body = 'uniform token scratch:curves:space = "uv"\nfloat[] widths = [0.01] ( interpolation = "constant" )\n'
    (got,) = read(curves(body), metres=0.01).curves
    assert (got.space, got.width_unit, got.depth_unit) == ("uv", "uv", "um")
    np.testing.assert_allclose(got.points[1], [1, 0, 0])
    np.testing.assert_allclose(got.widths, 0.01)


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("curveVertexCounts = [2, 3]", "curveVertexCounts = [2, 2]", ["/w/c", "add up to 4"]),
        ("curves = </w/c>", "curves = </m>", ["/mat layer 'own'", "/m are no BasisCurves"]),
        ("curves = </w/c>", "curves = </gone>", ["/mat layer 'own'", "/gone"]),
        ("rel scratch:layer:own:curves = </w/c>", "", ["/mat layer 'own'", "no target"]),
        ("uniform token type", "float[] widths = [1, 2, 3, 4]\nuniform token type", ["/w/c.widths", "4 values"]),
        ("uniform token type", "float[] widths = [nan]\nuniform token type", ["/w/c.widths", "not finite"]),
    ],
)
def test_odd_curves_warn(read, said, old, new, words):
    said(read(curves("").replace(old, new)), *words)


def test_points_that_are_not_finite_are_refused(read):
    with pytest.raises(StageError, match=r"/w/c: points\[3\]"):
        read(curves("").replace("(1, 1, 0), (1, 2, 0)", "(nan, 1, 0), (1, 2, 0)"))


def sample(basis, wrap, points, varying=None):
    kind = CurveKind("cubic", basis, wrap)
    counts = np.array([len(points)])
    ends = np.zeros((int(kind.varying(counts).sum()), 0)) if varying is None else np.asarray(varying, float)[:, None]
    return polylines(kind, counts, np.asarray(points, float), ends)[0]


POINTS = np.array([(0, 0, 0), (1, 2, 0), (3, 2, 1), (4, 0, 1), (5, -2, 0), (7, -1, 3), (8, 0, 2)], float)


def test_b_splines_agree_with_scipy():
    """A uniform cubic B-spline of n vertices is defined over n - 3 spans between the knots."""
    n = len(POINTS)
    reference = BSpline(np.arange(n + 4), POINTS, 3)(np.linspace(3, n, (n - 3) * STEPS + 1))
    np.testing.assert_allclose(sample("bspline", "nonperiodic", POINTS), reference, atol=1e-12)
    wrapped = np.concatenate([POINTS[-1:], POINTS, POINTS[:2]])
    reference = BSpline(np.arange(n + 7), wrapped, 3)(np.linspace(3, n + 3, n * STEPS + 1))
    np.testing.assert_allclose(sample("bspline", "periodic", POINTS), reference, atol=1e-12)


def test_catmull_rom_splines_agree_with_scipy():
    """Hermite pieces whose tangents are half the chord between a vertex's neighbours."""
    n = len(POINTS)
    tangents = (POINTS[2:] - POINTS[:-2]) / 2
    reference = CubicHermiteSpline(np.arange(1, n - 1), POINTS[1:-1], tangents)
    at = np.linspace(1, n - 2, (n - 3) * STEPS + 1)
    np.testing.assert_allclose(sample("catmullRom", "nonperiodic", POINTS), reference(at), atol=1e-12)
    pinned = sample("catmullRom", "pinned", POINTS)
    np.testing.assert_allclose(pinned[[0, -1]], POINTS[[0, -1]], atol=1e-12)
    np.testing.assert_allclose(pinned[::STEPS], POINTS, atol=1e-12)


def test_bezier_curves_agree_with_de_casteljau():
    got = sample("bezier", "nonperiodic", POINTS)
    assert len(got) == 2 * STEPS + 1
    for i, t in enumerate(np.arange(STEPS + 1) / STEPS):
        hull = POINTS[:4]
        while len(hull) > 1:
            hull = (1 - t) * hull[:-1] + t * hull[1:]
        np.testing.assert_allclose(got[i], hull[0], atol=1e-12)
    closed = sample("bezier", "periodic", POINTS[:6])
    np.testing.assert_allclose(closed[[0, STEPS, -1]], POINTS[[0, 3, 0]], atol=1e-12)


def test_varying_values_are_blended_along_segments():
    got = sample("bspline", "pinned", POINTS[:3], varying=[0, 10, 40])[:, 3]
    np.testing.assert_allclose(got[[0, STEPS // 2, STEPS, -1]], [0, 5, 10, 40])


def test_linear_loops_close_and_short_curves_are_dropped():
    kind = CurveKind("linear", "bezier", "periodic")
    lines, lengths = polylines(kind, np.array([3]), POINTS[:3], np.zeros((3, 0)))
    assert lengths.tolist() == [4]
    np.testing.assert_array_equal(lines[[0, 3]], POINTS[[0, 0]])
    lines, lengths = polylines(
        CurveKind("cubic", "bezier", "nonperiodic"), np.array([2, 4]), POINTS[:6], np.zeros((2, 0))
    )
    assert lengths.tolist() == [0, STEPS + 1]
    np.testing.assert_allclose(lines[0], POINTS[2])
