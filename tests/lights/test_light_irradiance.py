"""Irradiance by sampling against closed forms and float64 quadrature."""

import numpy as np
import pytest

from scratchwarp import lights

from .light_cases import (
    ONE,
    ORIGIN,
    TURN,
    UP,
    corners_of,
    cylinder,
    disk,
    distant,
    dome,
    gradient,
    packed_dome,
    packed_mesh,
    polygon_irradiance,
    rect,
    sphere,
    surface_irradiance,
)

SAMPLES = 1 << 14
# Owen-scrambled Sobol error of smooth integrands is near N^-1.5; with the jump at the horizon about N^-0.75 = 7e-4
CLOSE = 1e-3


def irradiance(light, x=ORIGIN, n=UP, samples=SAMPLES):
    return float(lights.irradiance(light, x, n, samples=samples)[..., 0])


@pytest.mark.parametrize("angle", [1e-3, np.radians(0.53), 0.6, 1.5])
def test_distant_cap(angle):
    direction = np.array([0.3, 0.2, -1.0])
    cosine = 1.0 / np.linalg.norm(direction)
    assert irradiance(distant(angle=angle)) == pytest.approx(np.pi * np.sin(angle / 2) ** 2 * cosine, rel=CLOSE)


def test_distant_beyond_the_hemisphere():
    # half angle 2.5 about the normal: the hemisphere; about the opposite: the band from 0.64 off the pole
    assert irradiance(distant(direction=(0, 0, -1), angle=5.0)) == pytest.approx(np.pi, rel=2e-3)
    below = np.pi * (1 - np.sin(np.pi - 2.5) ** 2)
    assert irradiance(distant(direction=(0, 0, 1), angle=5.0)) == pytest.approx(below, rel=4e-3)


@pytest.mark.parametrize("angle", [0.0, 1e-7])
def test_parallel_light(angle):
    radiance = np.array([2.0, 1.0, 0.5]) / (np.pi * np.sin(angle / 2) ** 2 if angle else 1.0)
    light = distant(angle=angle, radiance=radiance)
    found = lights.irradiance(light, ORIGIN, UP, samples=1)
    np.testing.assert_allclose(found, np.array([2.0, 1.0, 0.5]) / np.sqrt(1.13), rtol=1e-6)
    assert lights.hit(light, ORIGIN, UP)["distance"] < 0


@pytest.mark.parametrize("radius", [1e-6, 1e-3, 0.1, 0.9, 1.08])
def test_sphere(radius):
    p = np.array([0.2, 0.3, 1.05])
    d = np.linalg.norm(p)
    light = sphere(center=p, radius=radius)
    expected = np.pi * radius**2 / d**2 * p[2] / d
    if radius > p[2]:  # dips below the horizon: the cap by a midpoint sum
        h, t = np.meshgrid((np.arange(2000) + 0.5) / 2000, (np.arange(2000) + 0.5) * np.pi / 1000, indexing="ij")
        drop = h * (1 - np.sqrt(1 - (radius / d) ** 2))
        cosine = (1 - drop) * p[2] / d + np.sqrt(drop * (2 - drop)) * np.cos(t) * np.sqrt(1 - (p[2] / d) ** 2)
        expected = 2 * np.pi * drop[-1, 0] / h[-1, 0] * np.maximum(cosine, 0.0).mean()
    assert irradiance(light) == pytest.approx(expected, rel=CLOSE)


def test_sphere_seen_from_its_inside_is_dark():
    assert irradiance(sphere(center=(0, 0, 0.1), radius=0.5)) == 0.0
    assert not lights.span(sphere(center=(0, 0, 0.1), radius=0.5), ORIGIN, (1, 0, 0), UP, 0.1)[2]


@pytest.mark.parametrize("record", [dict(radius=0.0), dict(radius=0.5, point=True)])
def test_point(record):
    p = np.array([0.2, 0.3, 1.05])
    expected = p[2] / np.linalg.norm(p) ** 3
    assert irradiance(sphere(center=p, **record), samples=1) == pytest.approx(expected, rel=1e-6)


RECTS = {
    "plain": dict(),
    "close": dict(center=(0.1, 0.2, 1e-3)),
    "closest": dict(center=(0.1, 0.2, 1e-5)),
    "far": dict(center=(3.0, 4.0, 8.0)),
    "farther": dict(center=(300.0, 400.0, 800.0)),
    "grazing": dict(center=(5.0, 0.0, 0.05)),
    "big": dict(ex=(1000.0, 0, 0), ey=(0, 300.0, 0), center=(500.0, 0, 1.0)),
    "long": dict(ex=(10.0, 0, 0), ey=(0, 1e-3, 0)),
    "sheared": dict(ey=(0.3, 0.5, 0)),
    "tilted": dict(ex=(0.5, 0.1, 0.2), ey=(-0.2, 0.5, 0.25), normal=np.cross((-0.2, 0.5, 0.25), (0.5, 0.1, 0.2))),
}


@pytest.mark.parametrize("name", RECTS)
def test_rect(name):
    light = rect(**RECTS[name])
    expected = polygon_irradiance(corners_of(light), ORIGIN, UP)
    # the sheared one is sampled by area
    assert irradiance(light) == pytest.approx(expected, rel=5e-3 if name == "sheared" else CLOSE)


def test_rect_and_disk_shine_to_one_side():
    for light in (rect(normal=(0, 0, 1)), disk(normal=(0, 0, 1)), packed_mesh(transform=np.diag([1.0, 1, 1, 1]))):
        x = np.array([0.0, 0.0, 0.5]) if not isinstance(light, lights.PackedLights) else UP
        n = UP if not isinstance(light, lights.PackedLights) else -UP
        assert irradiance(light, x, n, 64) == 0.0
        assert not lights.span(light, x, (1, 0, 0), n, 0.1)[2]


@pytest.mark.parametrize("height", [1e-3, 0.05, 0.5, 5.0, 1e4])
def test_round_disk_on_its_axis(height):
    light = disk(center=(0, 0, height), ex=(0.4, 0.3, 0), ey=(-0.3, 0.4, 0))
    assert irradiance(light) == pytest.approx(np.pi * 0.25 / (0.25 + height**2), rel=2 * CLOSE)


def test_ellipse():
    for changes in (dict(), dict(ey=(0.3, 0.5, 0)), dict(center=(0.5, 0.2, 0.3))):
        light = disk(**changes)
        r, t = np.meshgrid((np.arange(400) + 0.5) / 400, (np.arange(800) + 0.5) * np.pi / 400, indexing="ij")
        points = light.center + (r * np.cos(t))[..., None] * light.ex + (r * np.sin(t))[..., None] * light.ey
        areas = r * (1 / 400) * (np.pi / 400) * np.linalg.norm(np.cross(light.ex, light.ey))
        expected = surface_irradiance(points, light.normal, areas, ORIGIN, UP)
        assert irradiance(light) == pytest.approx(expected, rel=2 * CLOSE)


CYLINDERS = {
    "plain": dict(),
    "near": dict(center=(0.2, 0.0, 0.4), axis=(0.7, 0.0, 0.0)),
    "tube": dict(center=(1.0, 0.3, 0.5), axis=(3.0, 0.0, 0.2), radius=0.02),
    "end_on": dict(center=(2.0, 0.0, 0.4), axis=(1.0, 0.0, 0.0)),
    "far": dict(center=(30.0, 0.0, 40.0)),
}


@pytest.mark.parametrize("name", CYLINDERS)
def test_cylinder(name):
    light = cylinder(**CYLINDERS[name])
    half = np.linalg.norm(light.axis)
    axis = light.axis / half
    across = np.linalg.svd(axis[None])[2][1:]
    z, t = np.meshgrid(half * ((np.arange(2000) + 0.5) / 1000 - 1), (np.arange(600) + 0.5) * np.pi / 300, indexing="ij")
    normals = np.cos(t)[..., None] * across[0] + np.sin(t)[..., None] * across[1]
    points = light.center + z[..., None] * axis + light.radius * normals
    area = half / 1000 * light.radius * np.pi / 300
    assert irradiance(light) == pytest.approx(surface_irradiance(points, normals, area, ORIGIN, UP), rel=2 * CLOSE)


def test_cylinder_seen_from_within_its_radius_is_dark():
    light = cylinder(center=(2.0, 0.0, 0.1), axis=(1.0, 0.0, 0.0))
    assert irradiance(light) == 0.0


def test_constant_dome():
    assert irradiance(dome()) == pytest.approx(np.pi, rel=2e-3)


def test_image_dome():
    pixels = gradient(64, 128)
    found = lights.irradiance(packed_dome(pixels, rotation=TURN, radiance=(2.0, 1.0, 1.0)), ORIGIN, UP, samples=SAMPLES)
    # midpoint rule over an image refined 8 times by bilinear interpolation, in float64
    rows, columns = 512, 1024
    v, s = (np.arange(rows) + 0.5) / rows, (np.arange(columns) + 0.5) / columns
    y, x = v * 64 - 0.5, s * 128 - 0.5
    i, j = np.floor(y).astype(int), np.floor(x).astype(int)
    fy, fx = (y - i)[:, None, None], (x - j)[None, :, None]
    rgb = pixels[..., :3].astype(float)

    def row(k):
        line = rgb[np.clip(k, 0, 63)]
        return (1 - fx) * line[:, j % 128] + fx * line[:, (j + 1) % 128]

    image = (1 - fy) * row(i) + fy * row(i + 1)
    polar, longitude = np.pi * v[:, None], np.pi * (1 - 2 * s)[None, :]
    w = np.stack(
        np.broadcast_arrays(np.sin(polar) * np.sin(longitude), np.cos(polar), np.sin(polar) * np.cos(longitude)), -1
    )
    cosine = np.maximum((w @ TURN.T) @ UP, 0.0) * np.sin(polar) * (np.pi / rows) * (2 * np.pi / columns)
    expected = (image * cosine[..., None]).sum((0, 1)) * (2.0, 1.0, 1.0)
    np.testing.assert_allclose(found, expected, rtol=3e-3)


@pytest.mark.parametrize(
    ("toward", "column", "row"),
    [
        ((0, 0, 1), 4, 2),
        ((1, 0, 0), 2, 2),
        ((-1, 0, 0), 6, 2),
        ((0, 0, -1), 0, 2),
        ((0, 1, 0), 4, 0),
        ((0, -1, 0), 4, 3),
    ],
)
def test_latlong_directions(toward, column, row):
    """OpenEXR: the left edge is longitude pi, the centre +Z, +X a quarter from the left; the top is +Y."""
    pixels = np.zeros((4, 8, 4), np.float32)
    pixels[..., 0] = np.arange(8)
    pixels[..., 1] = np.arange(4)[:, None]
    w = np.array(toward, float) + (1e-3, 1e-3, 1e-3) * (np.array(toward) == 0)
    found = lights.hit(packed_dome(pixels), ORIGIN, w / np.linalg.norm(w))["radiance"]
    assert abs(found[1] - row) <= 0.51
    if toward[1] == 0 and toward[2] != -1:
        assert found[0] == pytest.approx(column - 0.5, abs=0.02)


def test_mesh_matches_the_rect_of_its_shape():
    expected = polygon_irradiance(corners_of(rect()), ORIGIN, UP)
    assert irradiance(packed_mesh()) == pytest.approx(expected, rel=3e-3)


def test_mirrored_mesh_shines_from_its_outside():
    matrix = np.diag([-0.6, 0.5, 1.0, 1.0])
    matrix[:3, 3] = (0.3, 0.4, 0.8)
    # mirrored in x, the quad's outside still faces -z
    assert irradiance(packed_mesh(transform=matrix)) == pytest.approx(irradiance(packed_mesh()), rel=5e-3)


def test_colours_add():
    found = lights.irradiance(rect(radiance=(1.0, 2.0, 0.0)), ORIGIN, UP, samples=256)
    assert found[1] == pytest.approx(2 * found[0]) and found[2] == 0.0


def test_radiance_of_one_is_what_a_ray_sees():
    for light in (rect(), disk(), sphere(), cylinder(), distant(), dome()):
        s = lights.sample(light, ORIGIN, (0.4, 0.6))
        np.testing.assert_allclose(lights.hit(light, ORIGIN, s["wi"])["radiance"], ONE)
