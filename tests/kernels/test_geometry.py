"""World triangles of a scene: winding, normals, uvs, tangents and the scale of patterns."""

from dataclasses import replace

import numpy as np
import pytest

from scratchwarp.kernels.geometry import pack, uv_set
from scratchwarp.scene import Material, PreviewSurface, TextureInput

from ..render import scenes as S

FLOAT = 2e-6  # float32 on the device: 1.2e-7 of each term, some ten terms


def packed(mesh, linear=None, directed=True, colored=False, materials=None, emitters=None, at=(0, 0, 0)):
    materials = materials or [Material("/mat")]
    instance = replace(S.place(at=at, linear=linear), materials=tuple(range(len(materials))))
    geometry = pack(S.scene([mesh], materials, [], [instance]), directed, colored, emitters or {})
    arrays = {}
    for name in ("points", "normals", "uvs", "tangents", "colors"):
        values = getattr(geometry.arrays, name).numpy()
        arrays[name] = values.reshape(-1, 3, values.shape[1]) if len(values) % 3 == 0 else values
    for name in ("dpdu", "dpdv", "material", "instance", "light", "pattern_scale"):
        arrays[name] = getattr(geometry.arrays, name).numpy()
    return arrays


def facet_normals(points):
    n = np.cross(points[:, 1] - points[:, 0], points[:, 2] - points[:, 0])
    return n / np.linalg.norm(n, axis=-1, keepdims=True)


MIRRORS = {
    "as it is": np.eye(3),
    "one axis mirrored": np.diag([-1.0, 1.0, 1.0]),
    "two axes mirrored": np.diag([-1.0, 1.0, -2.0]),
    "all axes mirrored and sheared": -np.array([[1.0, 0.5, 0.0], [0.0, 1.0, 0.0], [0.0, 0.2, 3.0]]),
}


@pytest.mark.parametrize("linear", MIRRORS.values(), ids=MIRRORS)
def test_triangles_stay_counter_clockwise_seen_from_outside(linear):
    a = packed(S.sphere(12, 24), linear)
    outward = a["points"].mean(1)
    assert ((facet_normals(a["points"]) * outward).sum(1) > 0).all()


@pytest.mark.parametrize("linear", MIRRORS.values(), ids=MIRRORS)
def test_shading_normals_are_those_of_the_ellipsoid(linear):
    """p = M q with |q| = 1 is the surface |M^-1 p|^2 = 1, whose gradient is M^-T M^-1 p."""
    a = packed(S.sphere(12, 24), linear)
    inverse = np.linalg.inv(linear)
    gradient = a["points"] @ inverse.T @ inverse
    expected = gradient / np.linalg.norm(gradient, axis=-1, keepdims=True)
    np.testing.assert_allclose(a["normals"], expected, atol=FLOAT)


@pytest.mark.parametrize("linear", MIRRORS.values(), ids=MIRRORS)
def test_corners_keep_their_uv_and_gradients_map_uv_to_the_surface(linear):
    mesh = S.sphere(12, 24)
    a = packed(mesh, linear)
    corners = mesh.points[mesh.triangles] @ linear.T
    away = np.linalg.norm(a["points"][:, :, None] - corners[:, None], axis=-1)
    same = np.take_along_axis(mesh.uvs["st"], away.argmin(2)[..., None], axis=1)
    np.testing.assert_allclose(a["uvs"], same, atol=FLOAT)
    for edge in (1, 2):
        step = a["uvs"][:, edge] - a["uvs"][:, 0]
        expected = a["points"][:, edge] - a["points"][:, 0]
        moved = step[:, :1] * a["dpdu"] + step[:, 1:] * a["dpdv"]
        np.testing.assert_allclose(moved, expected, atol=1e-5)


def test_facets_without_normals_are_flat():
    a = packed(S.box())
    np.testing.assert_allclose(a["normals"], np.repeat(facet_normals(a["points"])[:, None], 3, 1), atol=FLOAT)


@pytest.mark.parametrize("scale", [1.0, 3.0, -2.0])
def test_without_uvs_the_fallback_counts_metres(scale):
    """Box projection: dP/du and dP/dv are unit, in the facet's plane, and along the axes of the object."""
    a = packed(S.box(), np.eye(3) * scale)
    normals = facet_normals(a["points"])
    for d in (a["dpdu"], a["dpdv"]):
        np.testing.assert_allclose(np.abs(d).max(1), 1.0, atol=FLOAT)
        np.testing.assert_allclose(np.linalg.norm(d, axis=1), 1.0, atol=FLOAT)
        np.testing.assert_allclose((d * normals).sum(1), 0.0, atol=FLOAT)
    np.testing.assert_allclose((a["dpdu"] * a["dpdv"]).sum(1), 0.0, atol=FLOAT)


def test_a_uv_set_that_is_a_point_or_a_line_falls_back_as_well():
    mesh = S.plane()
    nothing = packed(replace(mesh, uvs={}))
    for flat in (np.zeros((2, 3, 2)), mesh.uvs["st"] * [1.0, 0.0]):
        a = packed(replace(mesh, uvs={"st": flat}))
        for name in ("uvs", "dpdu", "dpdv"):
            np.testing.assert_array_equal(a[name], nothing[name])


def test_the_uv_set_of_the_textures_is_the_one_of_the_scratches():
    surface = PreviewSurface(roughness=TextureInput(0, uv_set="detail"))
    assert uv_set(Material("/mat", surface=surface)) == "detail" and uv_set(Material("/mat")) == "st"
    mesh = S.plane()
    mesh = replace(mesh, uvs={**mesh.uvs, "detail": 5.0 * mesh.uvs["st"]}, slots=[0, 1])
    a = packed(mesh, materials=[Material("/plain"), Material("/mat", surface=surface)])
    np.testing.assert_allclose(a["uvs"].max((1, 2)), [1.0, 5.0])
    assert a["material"].tolist() == [0, 1]


def test_tangents_follow_u_and_are_shared_by_neighbours():
    mesh = S.sphere(24, 48)
    a = packed(mesh)
    tangent = a["tangents"] / np.linalg.norm(a["tangents"], axis=-1, keepdims=True)
    q = a["points"].astype(np.float64)
    around = np.stack([q[..., 2], np.zeros(q.shape[:2]), -q[..., 0]], -1)
    length = np.linalg.norm(around, axis=-1, keepdims=True)
    inner = length[..., 0] > 0.2
    # at the seam one of the two neighbours in u is missing: half a step of 2 pi / 48 off
    cosine = (tangent * around / np.where(length > 0, length, 1.0)).sum(-1)[inner]
    assert cosine.min() > np.cos(np.pi / 48) - 1e-4 and np.median(cosine) > 1 - 1e-4


def test_authored_tangents_turn_with_the_instance():
    mesh = S.plane()
    turn = np.array([[0.0, -1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]])
    a = packed(replace(mesh, tangents=np.broadcast_to([1.0, 0.0, 0.0], (2, 3, 3))), turn)
    np.testing.assert_allclose(a["tangents"], np.broadcast_to([0.0, 1.0, 0.0], (2, 3, 3)), atol=FLOAT)


def test_patterns_are_scaled_in_micrometres():
    """A square of 2 m and uv [0, 1]^2, stretched to 6 m along x, holds 6e6 micrometres a unit of u."""
    a = packed(S.plane(2.0), np.diag([3.0, 1.0, 1.0]))
    np.testing.assert_allclose(a["pattern_scale"], [[6e6, 2e6]], rtol=1e-12)


def test_nothing_is_built_that_is_not_asked_for():
    a = packed(S.plane(), directed=False)
    assert len(a["tangents"]) == 1 and len(a["colors"]) == 1
    a = packed(S.plane(), colored=True)
    np.testing.assert_allclose(a["colors"], 0.18)  # the grey of a surface that says no colour


def test_light_and_instance_of_each_triangle():
    scene = S.scene([S.plane(), S.box()], [Material("/mat")], [], [S.place(1), S.place(0, at=(0, 0, 5))])
    g = pack(scene, False, False, {1: 7}).arrays
    assert g.instance.numpy().tolist() == [0] * 12 + [1] * 2
    assert g.light.numpy().tolist() == [-1] * 12 + [7] * 2


def test_a_triangle_without_area_makes_no_nan():
    mesh = S.Mesh(path="/line", points=[[0, 0, 0], [1, 0, 0], [2, 0, 0], [0, 1, 0]], triangles=[[0, 1, 2], [0, 1, 3]])
    a = packed(mesh)
    assert all(np.isfinite(values).all() for values in a.values())


def test_an_empty_scene():
    g = pack(S.scene([], [], []), True, True, {})
    assert g.arrays.empty == 1 and g.mesh is None and g.triangles == 0
