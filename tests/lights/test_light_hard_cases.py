"""Degenerate, huge, tiny and touching lights: everything stays finite and nothing is made up."""

import numpy as np
import pytest

from scratchwarp import lights
from scratchwarp.scene import Mesh

from .light_cases import (
    ORIGIN,
    QUAD,
    SEEN,
    UP,
    cylinder,
    disk,
    distant,
    packed_dome,
    packed_mesh,
    rect,
    sphere,
    sphere_directions,
)

TRIANGLES = np.array([[0, 1, 2], [0, 2, 3], [0, 0, 1]])

HARD = {
    **SEEN,
    "zero_rect": rect(ex=(0, 0, 0)),
    "line_rect": rect(ey=(0.6, 0, 0)),
    "zero_disk": disk(ex=(0, 0, 0), ey=(0, 0, 0)),
    "zero_cylinder": cylinder(radius=0.0),
    "flat_cylinder": cylinder(axis=(0, 0, 0)),
    "huge_rect": rect(ex=(1e6, 0, 0), ey=(0, 1e6, 0)),
    "giant_rect": rect(ex=(1e12, 0, 0), ey=(0, 1e12, 0)),
    "huge_sphere": sphere(center=(0, 0, 2e6), radius=1e6),
    "tiny_sphere": sphere(radius=1e-20),
    "touching_sphere": sphere(center=(0, 0, 0.5), radius=0.5),
    "edge_on_rect": rect(center=(1.0, 0, 0), ex=(0.5, 0, 0), ey=(0, 0.5, 0)),
    "corner_rect": rect(center=(0.6, 0.5, 0.0)),
    "far_away": sphere(center=(1e9, 0, 1e9), radius=1.0),
    "tube": cylinder(axis=(1e5, 0, 0), radius=1e-4),
    "point": sphere(point=True),
    "here": sphere(center=(0, 0, 0), point=True),
    "parallel": distant(angle=0.0),
    "everything": distant(angle=2 * np.pi),
    "black_dome": packed_dome(np.zeros((4, 8, 4), np.float32)),
    "one_texel": packed_dome(np.ones((1, 1, 4), np.float32)),
    "mesh": packed_mesh(),
    "mesh_with_slivers": packed_mesh(Mesh(path="/slivers", points=QUAD.points, triangles=TRIANGLES[:, ::-1])),
    "no_mesh": packed_mesh(Mesh(path="/nothing", points=np.zeros((3, 3)), triangles=[[0, 1, 2]])),
    "empty_mesh": packed_mesh(Mesh(path="/empty", points=np.zeros((0, 3)), triangles=np.zeros((0, 3)))),
}

POINTS = np.array([ORIGIN, [0.3, 0.4, 0.8], [0.3, 0.4, 1.0], [0.9, 0.9, 0.8], [1e6, -1e6, 1e3], [0.3, 0.4, 0.7999999]])


@pytest.mark.parametrize("name", HARD)
def test_everything_is_finite(name):
    light = HARD[name]
    u = np.array([[a, b] for a in (0.0, 1e-8, 0.3, 0.5, 1 - 2**-24) for b in (0.0, 0.25, 0.75, 1 - 2**-24)])
    s = lights.sample(light, POINTS[:, None], u)
    for key, values in s.items():
        assert np.isfinite(values).all(), key
    assert np.isfinite(s["pdf"] ** 2).all(), "float32 of the power heuristic"
    assert (s["distance"] >= 0).all() and (s["radiance"] >= 0).all()
    np.testing.assert_allclose(np.linalg.norm(s["wi"], axis=-1), 1.0, atol=1e-5)
    w = np.concatenate([sphere_directions(50), np.eye(3), -np.eye(3)])
    for values in lights.hit(light, POINTS[:, None], w).values():
        assert np.isfinite(values).all()
    for sine in (-1.0, -0.5, 0.0, 1e-7, 0.999999, 1.0):
        lo, hi, ok = lights.span(light, POINTS[:, None], [(1, 0, 0), (0, 1, 0), (0.6, 0.8, 0)], UP, sine)
        assert np.isfinite(lo).all() and np.isfinite(hi).all() and (lo <= hi)[ok].all()
    assert np.isfinite(lights.irradiance(light, POINTS, UP, samples=64)).all()


@pytest.mark.parametrize("name", [n for n in HARD if n.startswith(("zero_", "flat_", "line_", "no_", "empty_"))])
def test_lights_without_area_are_dark(name):
    light = HARD[name]
    assert (lights.irradiance(light, POINTS, UP, samples=16) == 0).all()
    assert (lights.hit(light, ORIGIN, sphere_directions(100))["distance"] < 0).all()


def test_plane_filling_rect_is_half_of_everything():
    """Radiance 1 from all of the upper hemisphere."""
    for name in ("huge_rect", "giant_rect"):
        assert lights.irradiance(HARD[name], ORIGIN, UP, samples=4096)[0] == pytest.approx(np.pi, rel=2e-3)


def test_distant_all_around_is_a_dome():
    assert lights.irradiance(HARD["everything"], ORIGIN, UP, samples=4096)[0] == pytest.approx(np.pi, rel=2e-3)


@pytest.mark.parametrize(
    ("call", "name"),
    [
        (lambda: lights.sample(rect(), (0, 0), (0.5, 0.5)), "x"),
        (lambda: lights.sample(rect(), ORIGIN, (0.5, 1.0)), "u"),
        (lambda: lights.sample(rect(), (0, 0, np.nan), (0.5, 0.5)), "x"),
        (lambda: lights.hit(rect(), ORIGIN, (0, 0, 2)), "w"),
        (lambda: lights.span(rect(), ORIGIN, (0, 0.1, 1), UP, 0.0), "u"),
        (lambda: lights.span(rect(), ORIGIN, (1, 0, 0), UP, 1.5), "sin_theta"),
        (lambda: lights.span(rect(), ORIGIN, (0, 0, 1), UP, 0.5), "orthogonal"),
        (lambda: lights.irradiance(rect(), ORIGIN, UP, samples=0), "samples"),
        (lambda: lights.irradiance(lights.pack_lights([rect(), rect()]), ORIGIN, UP), "light"),
    ],
)
def test_bad_input_is_refused_by_name(call, name):
    with pytest.raises(ValueError, match=name):
        call()
