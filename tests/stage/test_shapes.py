"""Intrinsic shapes as meshes."""

import numpy as np
import pytest

PI = np.pi
# body, volume, area of the true shape; 128 segments around and 64 from pole to pole leave some 8e-4 of them.
SHAPES = {
    "Sphere": ("double radius = 2", 32 * PI / 3, 16 * PI),
    "Cube": ("double size = 3", 27, 54),
    "Cylinder": ("double radius = 2\ndouble height = 3", 12 * PI, 20 * PI),
    "Cone": ("double radius = 3\ndouble height = 4", 12 * PI, 24 * PI),
    "Capsule": ("double radius = 1\ndouble height = 2", 2 * PI + 4 * PI / 3, 8 * PI),
    "Cylinder_1": (
        "double radiusTop = 1\ndouble radiusBottom = 2\ndouble height = 3",
        7 * PI,
        (5 + 3 * np.sqrt(10)) * PI,
    ),
}


@pytest.mark.parametrize("axis", "XYZ")
@pytest.mark.parametrize("orientation", ["rightHanded", "leftHanded"])
@pytest.mark.parametrize("kind", SHAPES)
def test_volume_area_and_normals(read, kind, axis, orientation):
    body, volume, area = SHAPES[kind]
    turn = "" if kind in ("Sphere", "Cube") else f'uniform token axis = "{axis}"'
    scene = read(f'def {kind} "s" {{\n{body}\n{turn}\nuniform token orientation = "{orientation}"\n}}')
    mesh = scene.meshes[0]
    p = mesh.points[mesh.triangles]
    cross = np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0])
    sign = 1 if orientation == "rightHanded" else -1
    assert sign * np.einsum("mi,mi->", p[:, 0], cross) / 6 == pytest.approx(volume, rel=2e-3)
    assert np.linalg.norm(cross, axis=1).sum() / 2 == pytest.approx(area, rel=2e-3)
    if mesh.normals is not None:
        assert (sign * np.einsum("mci,mi->mc", mesh.normals, cross) > 0).all()
        np.testing.assert_allclose(np.linalg.norm(mesh.normals, axis=2), 1, atol=1e-6)
    if turn:
        longest = "XYZ".index(axis)
        extent = np.ptp(mesh.points, axis=0)
        assert np.delete(extent, longest) == pytest.approx([np.delete(extent, longest)[0]] * 2)


@pytest.mark.parametrize(("axis", "extent"), [("X", (0, 5, 2)), ("Y", (2, 0, 5)), ("Z", (2, 5, 0))])
def test_planes(read, axis, extent):
    """Width lies along X (Z for axis X), length along Y (Z for axis Y)."""
    mesh = read(f'def Plane "p" {{\ndouble width = 2\ndouble length = 5\nuniform token axis = "{axis}"\n}}').meshes[0]
    np.testing.assert_allclose(np.ptp(mesh.points, axis=0), extent, atol=1e-12)
    p = mesh.points[mesh.triangles]
    cross = np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0])
    assert (cross["XYZ".index(axis) == np.arange(3)[None].repeat(2, 0)] > 0).all()


def test_colour_and_size(read, said):
    scene = read("""
def Sphere "a" { color3f[] primvars:displayColor = [(1, 0, 0)] }
def Sphere "b" { double radius = 0 }
def Cube "c" { double size = 0 }
""")
    assert [i.path for i in scene.instances] == ["/a"]
    np.testing.assert_array_equal(scene.meshes[0].colors[7, 1], [1, 0, 0])
    said(scene, "/b", "not positive")
    said(scene, "/c", "not positive")
