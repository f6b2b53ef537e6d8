"""The true geometry of the groove stages: closed, where the grooves are, and as bright as they are."""

import numpy as np
import pytest

from scratchwarp import grooves
from scratchwarp.pipelines import demo_grooves, demo_relief

CUTS = demo_grooves.cuts(0.25)
PLATE = demo_relief.crossed(demo_grooves.SIDE, CUTS)


def faces(shape):
    """Each polygon of a shape, z up: points [k, 3], normal [3]."""
    back = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])
    points, normals = shape.points @ back, shape.normals @ back
    starts = np.concatenate([[0], np.cumsum(shape.counts)])
    return [(points[a:b], normals[a]) for a, b in zip(starts[:-1], starts[1:], strict=True)]


def area(face):
    """Vector area of a polygon [k, 3]."""
    return 0.5 * np.cross(face - face[0], np.roll(face, -1, axis=0) - face[0]).sum(axis=0)


def depth(p):
    """Lowest groove of the layout at ``p`` [2]."""
    lowest = 0.0
    for cut in CUTS:
        length = np.linalg.norm(cut.end - cut.start)
        u = (cut.end - cut.start) / length
        along, across = (p - cut.start) @ u, (p - cut.start) @ (-u[1], u[0])
        if 0.0 < along < length:
            lowest = min(lowest, np.interp(across, *cut.section.T, left=0.0, right=0.0))
    return lowest


@pytest.mark.parametrize("shape", [PLATE, demo_grooves.ruled()], ids=["crossed", "ruled"])
def test_plates_are_closed_surfaces(shape):
    """The vector areas of all facets add up to those of the flat plate, as they do where no hole is left, and normals
    are those of the winding. The ruled plate ends with whole grooves, within three pitches."""
    areas = np.array([area(face) for face, _ in faces(shape)])
    normals = np.array([normal for _, normal in faces(shape)])
    side = demo_grooves.SIDE
    short = 0.0 if shape is PLATE else 3.0 * side * demo_grooves.RULED_PITCH / demo_grooves.UNIT
    assert np.abs(areas.sum(0)[:2]).max() < 1e-9 * side * side
    assert 0.0 <= side * side - areas.sum(0)[2] + 1e-9 * side * side <= short + 2e-9 * side * side
    assert np.all((areas * normals).sum(1) > 0.99 * np.linalg.norm(areas, axis=1))


def test_crossing_facets_lie_in_the_lowest_groove():
    """The middle of every facet is as deep as the layout says; walls stand between two heights."""
    level = [face for face, normal in faces(PLATE) if abs(normal[2]) > 1e-9]
    assert len(level) > 50
    assert max(abs(face[:, 2].mean() - depth(face[:, :2].mean(0))) for face in level) < 1e-9


def triangles(shape, center, reach):
    """Triangles [n, 3, 3] of a shape near a place [2] of the plate, and normals [n, 3]."""
    found = []
    for face, normal in faces(shape):
        low, high = face[:, :2].min(0), face[:, :2].max(0)
        if np.all(low < center + reach) and np.all(high > center - reach):
            found += [(np.array([face[0], face[k], face[k + 1]]), normal) for k in range(1, len(face) - 1)]
    return np.array([t for t, _ in found]), np.array([n for _, n in found])


def hits(corners, origins, direction):
    """Distance [rays] along one direction and number of the first triangle met; inf where there is none."""
    a, e1, e2 = corners[:, 0], corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    p = np.cross(direction, e2)
    det = np.sum(e1 * p, axis=1)
    det = np.where(np.abs(det) < 1e-15, np.inf, det)
    s = origins[:, None] - a
    u = np.sum(s * p, axis=2) / det
    q = np.cross(s, e1)
    v, t = q @ direction / det, np.sum(q * e2, axis=2) / det
    t = np.where((u >= -1e-9) & (v >= -1e-9) & (u + v <= 1.0 + 1e-9) & (t > 1e-7), t, np.inf)
    return t.min(1), t.argmin(1)


def cast(shape, center, axis1, axis2, o, i):
    """Mean radiance of white diffuse triangles through an ellipse under unit irradiance, by a ray through a
    random point of each of 64 x 64 even cells of it."""
    corners, normals = triangles(shape, center, 3.0)
    even = (np.stack(np.meshgrid(np.arange(64), np.arange(64))) + np.random.default_rng(7).random((2, 64, 64))) / 64
    r, turn = np.sqrt(even[0]), 2.0 * np.pi * even[1]
    flat = center + (r * np.cos(turn)).ravel()[:, None] * axis1 + (r * np.sin(turn)).ravel()[:, None] * axis2
    top = np.column_stack([flat, np.zeros(len(flat))]) + 2.0 * o
    t, number = hits(corners, top, -o)
    assert np.isfinite(t).all()
    normal = normals[number]
    lit, _ = hits(corners, top - t[:, None] * o + 1e-6 * normal, i)
    return float(np.mean(np.maximum(normal @ i, 0.0) * np.isinf(lit)) / np.pi)


def crossing():
    """Where the first two scratches cross that do."""
    for k, a in enumerate(CUTS):
        for b in CUTS[:k]:
            s, t = np.linalg.solve(np.column_stack([a.end - a.start, b.start - b.end]), b.start - a.start)
            if 0.1 < s < 0.9 and 0.1 < t < 0.9:
                return a.start + s * (a.end - a.start)
    raise AssertionError("no two scratches cross")


@pytest.mark.parametrize("place", ["crossing", "end", "ruled"])
def test_geometry_is_as_bright_as_the_grooves(place):
    """``grooves.radiance`` over a footprint against rays on the triangles, diffuse. With a ray in each of 4096 cells
    the standard error is 4096^-0.75 times a few for as many edges, some 0.3 %; a facet out of place is 2 % and more."""
    side = demo_grooves.SIDE
    if place == "ruled":
        unit = demo_grooves.UNIT
        pitch, wide = demo_grooves.RULED_PITCH / unit, demo_grooves.RULED_WIDTH / unit
        section = np.subtract(demo_grooves.RULED, (0.5, 0.0)) * (wide, demo_grooves.RULED_DEPTH / unit)
        rows = -0.5 * side + 0.5 * wide + pitch * np.arange(130, 150)
        paths, sections = [[(-side, y), (side, y)] for y in rows], [section] * len(rows)
        shape, center = demo_grooves.ruled(), np.array([0.1, rows[9] + 0.07])
    else:
        paths, sections = [(c.start, c.end) for c in CUTS], [c.section for c in CUTS]
        shape, center = PLATE, crossing() if place == "crossing" else CUTS[0].end
    pattern = grooves.Pattern(paths, sections)
    o, i = np.array([0.35, -0.4, 0.85]), np.array([-0.5, 0.3, 0.8])
    o, i = o / np.linalg.norm(o), i / np.linalg.norm(i)
    axis1, axis2 = np.array([0.22, 0.05]), np.array([-0.03, 0.14])
    expected = grooves.radiance(pattern, center, axis1, axis2, o, i, grooves.Diffuse(1.0))
    flat = i[2] / np.pi
    found = cast(shape, center, axis1, axis2, o, i)
    assert abs(found - expected) < 0.01 * expected
    assert abs(found - flat) > 0.02 * flat
