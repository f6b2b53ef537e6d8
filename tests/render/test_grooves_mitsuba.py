"""A plane covered by grooves against real extruded groove geometry, path traced by Mitsuba 3.

Both see the plane from afar through an orthographic camera. The real grooves are 100 wide (Mitsuba's float32 offsets
cost light in small ones) and the image covers whole periods. Ours has no geometry, but a table of 256 x 256 directions.

Tolerance 1 % in every channel. Measured: 0.7 % for the quartic under the narrow sun (0.2 % at 512 x 512: the blur of
a bin), 0.2 % elsewhere; both images' noise is some 0.1 % of the luminance. Views keep off the angles at which many rays
of a rectangle or a 90 degree V change facets at once, where a bin averages over the kink.
"""

import numpy as np
import pytest

from scratchwarp.scene import Camera, DomeLight, Profile, RectLight, ScratchSurface, Texture

from . import scenes
from .mitsuba_reference import T, area, film, matrix, mi, rgb, shoot

IRON = {"eta": (2.9, 2.9, 2.6), "k": (3.1, 2.9, 2.8)}
ROWS = 256
PERIOD = 100.0


def sky(polar, longitude):
    """Radiance at angles from +Y and from +Z towards +X: a broad sun, a gradient, a constant in one channel each."""
    y, x, z = np.cos(polar), np.sin(polar) * np.sin(longitude), np.sin(polar) * np.cos(longitude)
    sun = np.exp(12 * (0.48 * x + 0.36 * y + 0.8 * z - 1))
    return np.stack([3 * sun + 0.02, 0.6 + 0.3 * x - 0.2 * y, np.ones_like(x)], -1)


def image(on_poles):
    step = np.arange(ROWS) / (ROWS - 1) if on_poles else (np.arange(ROWS) + 0.5) / ROWS
    longitude = np.pi * (1 - (2 * np.arange(2 * ROWS) + 1) / (2 * ROWS))
    return sky(*np.meshgrid(np.pi * step, longitude, indexing="ij"))


def outline(shape, depth):
    """(x, z) of one period, the left end to the right."""
    if shape in ("vGroove", "skewed"):
        return np.array([[0, 0], [0.5 if shape == "vGroove" else 0.2, -depth], [1, 0]])
    if shape == "rectangle":
        return np.array([[0, 0], [0, -depth], [1, -depth], [1, 0]])
    x = np.linspace(0, 1, 4097)
    if shape == "round":
        x = 0.5 - 0.5 * np.cos(np.pi * x)
        return np.stack([x, -2 * depth * np.sqrt(np.maximum(x * (1 - x), 0))], 1)
    return np.stack([x, -depth * (1 - (2 * x - 1) ** 2) ** 2], 1)


def grooves(shape, depth, bsdf, folder):
    """Grooves along +x, profile x along +y, the surface at z = 0: a mesh of ``PERIODS`` periods about the origin."""
    section = outline(shape, depth)
    count = 101 if len(section) < 10 else 9
    ys = (section[:, 0] + (np.arange(count) - count // 2 - 0.5)[:, None]).ravel()
    zs = np.tile(section[:, 1], count)
    points = np.concatenate([np.stack([np.full_like(ys, x), ys, zs], 1) for x in (-100.0, 100.0)]) * PERIOD
    a = np.arange(len(ys) - 1)
    a = a[np.abs(np.diff(ys)) + np.abs(np.diff(zs)) > 0]
    b = a + len(ys)
    faces = np.concatenate([np.stack([a, b, b + 1], 1), np.stack([a, b + 1, a + 1], 1)])
    mesh = mi.Mesh("grooves", len(points), len(faces))
    params = mi.traverse(mesh)
    params["vertex_positions"] = points.astype(np.float32).ravel()
    params["faces"] = faces.astype(np.uint32).ravel()
    params.update()
    file = str(folder / "grooves.ply")
    mesh.write_ply(file)
    return {
        "type": "ply",
        "filename": file,
        "face_normals": True,
        "bsdf": {"type": "twosided", "nested": bsdf},
        "periods": 5 if count > 50 else 1,
    }


def direction(theta, phi):
    """The scratch frame's direction in degrees, u = x, v = y, n = z."""
    t, p = np.radians(theta), np.radians(phi)
    return np.array([np.sin(t), np.cos(t) * np.sin(p), np.cos(t) * np.cos(p)])


def looking(omega, distance):
    """Camera at ``distance`` along ``omega``; +X of the image lies in the plane z = 0."""
    right = np.cross((0, 0, 1), omega)
    right = right / np.linalg.norm(right) if np.linalg.norm(right) > 1e-6 else np.array([0.0, 1.0, 0.0])
    m = np.eye(4)
    m[:3] = np.stack([right, np.cross(omega, right), omega, distance * omega], 1)
    return m


def ours(lights, shape, depth, omega, surface, textures=(), spp=1024, **layer):
    cam = Camera(
        path="/cam", transform=looking(omega, 1.0), projection="orthographic",
        horizontal_aperture=1e-3, vertical_aperture=1e-3,
    )  # fmt: skip
    parameters = (("apex", 0.2),) if shape == "skewed" else ()
    profile = Profile(path="/mat/profile", shape="vGroove" if shape == "skewed" else shape, parameters=parameters)
    fields = {"distribution": "linear", "width": 20.0, "pitch": 20.0, "depth": 20.0 * depth, "profile": profile}
    material = scenes.scratched(surface, **fields | layer)
    world = scenes.scene([scenes.plane(0.1)], [material], lights, [scenes.place()], cam, textures=textures)
    made = scenes.shoot(world, width=8, height=8, spp=spp)
    assert made.stats["invalid_samples"] == 0 and (made["alpha"] == 1).all()
    return made["color"].mean((0, 1), dtype=float)


def theirs(emitter, mesh, omega, turn=0.0, spp=1024):
    """``turn``: of the grooves about +z [rad]; they are kept and the camera is turned back under its light."""
    m = looking(omega, 30 * PERIOD)
    # the image covers whole periods: a step along its +X or one up moves this far across the grooves
    v = np.array([-np.sin(turn), np.cos(turn), 0])
    across = max(abs(v @ m[:3, 0]), abs(np.cross(v[:2], m[:2, 0]) / omega[2]))
    width = PERIOD * mesh["periods"] / across
    place = matrix(m @ np.diag([-1.0, 1, -1, 1])) @ T().scale([width / 2, width / 2, 1])
    view = {"type": "orthographic", "to_world": place, "near_clip": PERIOD, "film": film(8, 8)}
    parts = {"grooves": {k: v for k, v in mesh.items() if k != "periods"}, "light": emitter}
    parts["grooves"]["to_world"] = T().rotate([0, 0, 1], np.degrees(turn))
    bounces = {"type": "path", "max_depth": 64, "rr_depth": 1000, "hide_emitters": True}
    return shoot(parts, view, spp, bounces)[0].mean((0, 1))


VIEWS = [(0, 5), (0, 35), (25, -20), (40, 10), (-50, 43)]
SHAPES = [("vGroove", 0.2), ("vGroove", 0.5), ("skewed", 0.3), ("round", 0.25), ("rectangle", 0.5), ("quartic", 0.3)]
MIRROR = {"type": "conductor", "material": "none"}
CONDUCTOR = {"type": "conductor", "eta": rgb(IRON["eta"]), "k": rgb(IRON["k"])}
SURFACE = ScratchSurface(metal="custom", **IRON, roughness=0.0)


def under_a_sky():
    texture = Texture("sky", np.concatenate([image(False), np.ones((ROWS, 2 * ROWS, 1))], -1))
    env = {"type": "envmap", "bitmap": mi.Bitmap(image(True).astype(np.float32))}
    return DomeLight(path="/sky", radiance=(1, 1, 1), texture=0), (texture,), env


@pytest.mark.parametrize("metal", [False, True], ids=["mirror", "iron"])
@pytest.mark.parametrize(("shape", "depth"), SHAPES)
def test_under_a_sky(tmp_path, shape, depth, metal):
    dome, textures, env = under_a_sky()
    mesh = grooves(shape, depth, CONDUCTOR if metal else MIRROR, tmp_path)
    for view in VIEWS:
        omega = direction(*view)
        found = ours([dome], shape, depth, omega, SURFACE, textures, fresnel="exact" if metal else "mirror")
        np.testing.assert_allclose(found, theirs(env, mesh, omega), rtol=0.01, err_msg=f"seen from {view}")


@pytest.mark.parametrize("turn", [0.6, -1.1, 2.5])
def test_angles_turn_counter_clockwise(tmp_path, turn):
    dome, textures, env = under_a_sky()
    mesh = grooves("skewed", 0.3, MIRROR, tmp_path)
    omega = direction(20, 15)
    found = ours([dome], "skewed", 0.3, omega, SURFACE, textures, fresnel="mirror", angle=turn)
    np.testing.assert_allclose(found, theirs(env, mesh, omega, turn), rtol=0.01)


@pytest.mark.parametrize(("shape", "depth"), [("vGroove", 0.3), ("round", 0.25), ("skewed", 0.3)])
def test_under_a_lamp(tmp_path, shape, depth):
    """A rectangle 0.8 x 0.6 at a distance of 2, in periods of 20 um and of 100 of Mitsuba's units a million away."""
    toward = np.array([0.48, 0.36, 0.8])
    x = np.cross((0, 0, 1), toward) / np.hypot(0.48, 0.36)
    y = np.cross(toward, x)
    lamp = RectLight(path="/lamp", radiance=(5, 4, 3), center=2 * toward, ex=0.4 * x, ey=0.3 * y, normal=-toward)
    far = 1e6
    place = np.eye(4)
    place[:3] = np.stack([-0.4 * far * x, 0.3 * far * y, -toward, 2 * far * toward], 1)
    emitter = {"type": "rectangle", "to_world": matrix(place), "emitter": area([5, 4, 3])}
    mesh = grooves(shape, depth, CONDUCTOR, tmp_path)
    lit = 0
    views = [(-29, -20), (-33, 30), (-22, 40)] if shape != "skewed" else [(-25, 10), (-29, -8), (-30, 45)]
    for view in views:
        omega = direction(*view)
        found = ours([lamp], shape, depth, omega, SURFACE, spp=4096, fresnel="exact")
        wanted = theirs(emitter, mesh, omega, spp=8192)
        lit += wanted[0] > 0.05
        np.testing.assert_allclose(found, wanted, rtol=0.01, atol=1e-3, err_msg=f"seen from {view}")
    assert lit >= 2
