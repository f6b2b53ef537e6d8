"""Light that scratches reflect, against the integral over their mirror cone in float64.

L = sum over the table's rows next to phi_o, and over phi_i, of rho cos(phi_i) L_i(-theta_o, phi_i): the lamps are
intersected here in NumPy, and nothing is sampled. Lamps from a hundredth of the cone to half of it are found by light
sampling, by cone sampling and by both, so a wrong density or weight of either shows as a bias. Tolerance: 4 standard
deviations of the noise, below 1 %, plus 1e-3 for the quadrature (2e5 points in phi, one of them at an edge).
"""

import numpy as np
import pytest

import scratchwarp as sw
from scratchwarp import profiles
from scratchwarp.reflectance.profile_table import rows_to_unit_energy
from scratchwarp.scene import (
    Camera,
    CylinderLight,
    DiskLight,
    DistantLight,
    Instance,
    Material,
    Mesh,
    MeshLight,
    PreviewSurface,
    RectLight,
    SphereLight,
)

from . import scenes

THETA, PHI = np.radians(-25), np.radians(12)
TOWARD = np.array([np.sin(-THETA), np.cos(THETA) * np.sin(0.3), np.cos(THETA) * np.cos(0.3)])
SIDE = np.cross((0.0, 1, 0), TOWARD) / np.linalg.norm(np.cross((0.0, 1, 0), TOWARD))
UP = np.cross(TOWARD, SIDE)
TILT = (TOWARD + 0.4 * UP) / np.linalg.norm(TOWARD + 0.4 * UP)
EX, EY = SIDE, np.cross(TILT, SIDE)
CENTER = 2.0 * TOWARD
RADIANCE = np.array([3.0, 2.0, 1.0])


def on_plane(w):
    """Offsets from the centre, in EX and EY, of where directions [n, 3] meet the lamp's plane."""
    along = (CENTER @ TILT) / (w @ TILT)
    offset = along[:, None] * w - CENTER
    return offset @ EX, offset @ EY, along > 0


def rect(size):
    lamp = RectLight(path="/l", radiance=RADIANCE, center=CENTER, ex=size * EX, ey=0.6 * size * EY, normal=-TILT)

    def hit(w):
        x, y, ok = on_plane(w)
        return ok & (abs(x) < size) & (abs(y) < 0.6 * size)

    return lamp, hit


def disk(size):
    lamp = DiskLight(path="/l", radiance=RADIANCE, center=CENTER, ex=size * EX, ey=0.6 * size * EY, normal=-TILT)

    def hit(w):
        x, y, ok = on_plane(w)
        return ok & ((x / size) ** 2 + (y / (0.6 * size)) ** 2 < 1)

    return lamp, hit


def ball(size):
    def hit(w):
        along = w @ CENTER
        return (along > 0) & (CENTER @ CENTER - along**2 < size**2)

    return SphereLight(path="/l", radiance=RADIANCE, center=CENTER, radius=size), hit


def sun(size):
    angle = np.arctan(size / 2)
    return (
        DistantLight(path="/l", radiance=RADIANCE, direction=-TOWARD, angle=2 * angle),
        lambda w: w @ TOWARD > np.cos(angle),
    )


def tube(size):
    axis, radius = size * (SIDE + 0.3 * UP), 0.4 * size
    along = axis / np.linalg.norm(axis)

    def hit(w):
        # where the ray enters and leaves the endless tube
        wp, cp = w - np.outer(w @ along, along), CENTER - (CENTER @ along) * along
        a, b, c = (wp * wp).sum(-1), wp @ cp, cp @ cp - radius**2
        root = np.sqrt(np.maximum(b * b - a * c, 0))
        near = (b - root) / a
        far = (b + root) / a
        inside = [np.abs((t[:, None] * w - CENTER) @ along) < np.linalg.norm(axis) for t in (near, far)]
        # the far side is seen from within, where the tube does not shine
        return (b * b > a * c) & (near > 0) & inside[0] & (far > 0)

    return CylinderLight(path="/l", radiance=RADIANCE, center=CENTER, axis=axis, radius=radius), hit


def quad(size):
    return MeshLight(path="/l", radiance=RADIANCE, instance=1), rect(size)[1]


LAMPS = {"rect": rect, "disk": disk, "sphere": ball, "distant": sun, "cylinder": tube, "mesh": quad}
PROFILES = {"vGroove": 0.13, "round": 0.25, "rectangle": 0.7}


def expected(table, hit):
    t = profiles.simulate(table.profile, resolution=table.resolution, rays=table.rays, max_bounces=table.max_bounces)
    rho = rows_to_unit_energy(np.asarray(t.mirror, float), t.weights, t.lost)
    bins = len(t.weights)
    at = (PHI + np.pi / 2) / (np.pi / bins) - 0.5
    low = int(np.floor(at))
    row = (1 - (at - low)) * rho[low] + (at - low) * rho[low + 1]
    n = 200_000
    phi = np.pi * ((np.arange(n) + 0.5) / n - 0.5)
    w = np.stack([np.full(n, -np.sin(THETA)), np.cos(THETA) * np.sin(phi), np.cos(THETA) * np.cos(phi)], 1)
    found = row[np.minimum((phi + np.pi / 2) / np.pi * bins, bins - 1).astype(int)] * np.cos(phi) * hit(w)
    return found.sum() * np.pi / n * RADIANCE, (hit(w) * np.cos(phi)).sum() / np.cos(phi).sum()


def shoot(light, shape, quad=None, blocker=None, effects=None, spp=1024, **fields):
    """(film of a fully scratched plane seen from (THETA, PHI), its table). ``quad``: the mesh that shines."""
    omega = np.array([np.sin(THETA), np.cos(THETA) * np.sin(PHI), np.cos(THETA) * np.cos(PHI)])
    right = np.cross((0.0, 1, 0), omega) / np.linalg.norm(np.cross((0.0, 1, 0), omega))
    view = np.eye(4)
    view[:3] = np.stack([right, np.cross(omega, right), omega, 0.5 * omega], 1)
    cam = Camera(
        path="/cam", transform=view, projection="orthographic", horizontal_aperture=1e-5, vertical_aperture=1e-5
    )
    mirror = {"model": "table", "distribution": "linear", "width": 20.0, "pitch": 20.0, "depth": 20 * PROFILES[shape]}
    profile = sw.scene.Profile(path="/mat/p", shape=shape)
    materials = [scenes.scratched(profile=profile, **mirror), Material("/black", PreviewSurface((0, 0, 0)))]
    meshes, placed = [scenes.plane(0.1)], [Instance("/plane", 0, np.eye(4), (0,))]
    if quad is not None:
        meshes.append(quad)
        placed.append(Instance("/quad", 1, np.eye(4), (1,), light=0))
    if blocker is not None:
        meshes.append(blocker)
        placed.append(Instance("/blocker", len(meshes) - 1, np.eye(4), (1,)))
    world = scenes.scene(meshes, materials, [light], placed, cam, **fields)
    effects = scenes.EVERYTHING if effects is None else effects
    plan = sw.make_plan(world, sw.Settings(width=8, height=8, spp=spp, filter="box", effects=effects))
    film = sw.render(world, plan)
    assert film.stats["invalid_samples"] == 0 and (film["primId"] == 0).all()
    return film, plan.tables[0]


def emitter(lamp, size):
    """The mesh of a mesh light."""
    if lamp != "mesh":
        return None
    corners = [CENTER + a * size * EX + b * 0.6 * size * EY for a, b in ((-1, -1), (-1, 1), (1, 1), (1, -1))]
    return Mesh("/quad", corners, [[0, 1, 2], [0, 2, 3]])


def agree(film, wanted):
    found = film["color"].mean((0, 1), dtype=float)
    noise = np.sqrt(film["variance"].sum()) / film["variance"].size / (found @ [0.2126, 0.7152, 0.0722] + 1e-9)
    assert noise < 1e-2
    np.testing.assert_allclose(found, wanted, rtol=1e-3 + 4 * noise, atol=1e-7)


@pytest.mark.parametrize("size", [0.02, 0.3, 1.6])
@pytest.mark.parametrize("shape", PROFILES)
@pytest.mark.parametrize("lamp", LAMPS)
def test_mirror_cone(lamp, shape, size):
    light, hit = LAMPS[lamp](size)
    film, table = shoot(light, shape, emitter(lamp, size))
    wanted, share = expected(table, hit)
    assert 0.004 < share < 0.95
    assert shape != "round" or wanted.min() > 1e-3
    agree(film, wanted)


@pytest.mark.parametrize("size", [0.2, 0.6])
@pytest.mark.parametrize("lamp", LAMPS)
def test_half_hidden(lamp, size):
    """A sheet half-way to the lamp hides where its x is positive."""
    light, hit = LAMPS[lamp](size)
    sheet = [CENTER / 2 + a * EX + b * EY for a, b in ((0, -0.7), (4, -0.7), (4, 4), (0, 4))]

    def open_hit(w):
        x, y, ahead = on_plane(w)
        return hit(w) & ~(ahead & (x > 0) & (y > -1.4))

    for corners in ([[0, 1, 2], [0, 2, 3]], [[0, 2, 1], [0, 3, 2]]):
        film, table = shoot(light, "round", emitter(lamp, size), Mesh("/sheet", sheet, corners))
        wanted, _ = expected(table, open_hit)
        whole, _ = expected(table, hit)
        assert (wanted < 0.95 * whole).all() and wanted.min() > 0.01
        agree(film, wanted)


@pytest.mark.parametrize("shape", ["vGroove", "round"])
@pytest.mark.parametrize("kind", ["parallel", "point"])
def test_lights_without_extent(kind, shape):
    """They are spread by f = (1 - (psi / Psi)^2)^2, Psi half a degree, into the radiance 3 E / (pi Psi^2) f, whose
    integral over solid angle is the irradiance E; crossed by the cone off its middle, too."""
    psi = np.radians(0.5)
    for off in (0.0, 0.6):
        # the cone passes the light at this share of Psi
        theta = -THETA + off * psi
        toward = np.array([np.sin(theta), np.cos(theta) * np.sin(0.3), np.cos(theta) * np.cos(0.3)])
        if kind == "parallel":
            light = DistantLight(path="/l", radiance=RADIANCE, direction=-toward)
        else:
            light = SphereLight(path="/l", radiance=9 * RADIANCE, center=3 * toward, radius=0.0, point=True)
        film, table = shoot(light, shape)

        def spread(w, toward=toward):
            x = np.arccos(np.minimum(w @ toward, 1.0)) / psi
            return 3 / (np.pi * psi**2) * np.maximum(1 - x * x, 0) ** 2

        wanted, _ = expected(table, spread)
        found = film["color"].mean((0, 1), dtype=float)
        noise = np.sqrt(film["variance"].sum()) / film["variance"].size / (found @ [0.2126, 0.7152, 0.0722])
        assert wanted.min() > 1.0 and noise < 1e-2
        np.testing.assert_allclose(found, wanted, rtol=2e-3 + 4 * noise)
    # the closed form of the spread's integral over solid angle
    r = (np.arange(1000) + 0.5) / 1000 * psi
    over = (3 / (np.pi * psi**2) * (1 - (r / psi) ** 2) ** 2 * 2 * np.pi * np.sin(r)).sum() * psi / 1000
    assert over == pytest.approx(1.0, abs=1e-4)
