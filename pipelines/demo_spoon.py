"""The spoon: fine random scratches that diffract, under a small sphere, a star, a window or an even dome.

The scene of Velinov, Werner and Hullin 2018, figures 1, 2, 4, 10 and 11: ten thousand scratches on the upper side of a
polished spoon, each a straight line in uv, 0.8 to 6 um wide and as deep, all on one BasisCurves prim. The mesh is fine
enough that its triangles cut them into about 400,000 segments. Lengths in centimetres, +Y up, micro-structure in
micrometres.
"""

from pathlib import Path

import numpy as np
from pxr import Sdf, Usd

from . import demo_shapes as shapes
from . import demo_usd as usd
from .demo_ball import metal

SCRATCHES = 10_000
LEAST, MOST = 0.8, 6.0  # widths and depths [um]

LENGTH = 19.0
# (distance from the end of the handle, half the width)
OUTLINE = [(0.0, 0.05), (0.08, 0.5), (0.5, 0.9), (1.6, 1.0), (4.5, 0.8), (8.0, 0.5), (11.2, 0.42), (12.2, 0.75)]
OUTLINE += [(13.4, 1.6), (15.2, 2.15), (17.0, 1.95), (18.2, 1.35), (18.85, 0.6), (LENGTH, 0.05)]
# (distance, height of the edge, how much lower the middle is)
RISE = [(0.0, 1.25, -0.02), (3.0, 1.75, -0.1), (7.0, 1.6, -0.09), (10.0, 1.22, -0.06), (11.4, 1.05, 0.02)]
RISE += [(12.6, 1.0, 0.3), (14.0, 1.02, 0.75), (16.0, 1.05, 0.87), (17.6, 1.07, 0.55), (18.5, 1.1, 0.2)]
RISE += [(LENGTH, 1.12, 0.0)]
THICKNESS = 0.13
TOP_V, BOTTOM_V, RIM_V = 0.7, 0.3, 0.05  # where the three charts lie in the uv square


def spoon(path: Path | str, detail: float = 1.0) -> Path:
    """Under one sphere of 5 mm at 1 m; ``detail`` scales the number of faces and scratches."""
    stage = _table(detail)
    usd.sphere_light(stage, "bulb", _away((0.06, 0.84, -0.54), 100.0), 0.5, 150000.0)
    return usd.save(stage, path, "A spoon with ten thousand scratches that diffract, under a small sphere.")


def spoon_star(path: Path | str, detail: float = 1.0) -> Path:
    """Under a star of eight triangles."""
    stage = _table(detail)
    usd.mesh_light(stage, "star", star(8, 2.0, 9.0), usd.looking(_away((0.06, 0.84, -0.54), 100.0), MIDDLE), 1500.0)
    return usd.save(stage, path, "A spoon with ten thousand scratches that diffract, under a star of eight triangles.")


def spoon_window(path: Path | str, detail: float = 1.0) -> Path:
    """Beside a window of 1 m by 1.4 m."""
    stage = _table(detail)
    usd.rect_light(stage, "window", _away((0.15, 0.7, -0.7), 220.0), MIDDLE, (100.0, 140.0), 6.0, (0.86, 0.93, 1.0))
    return usd.save(stage, path, "A spoon with ten thousand scratches that diffract, beside a window.")


def spoon_dome(path: Path | str, detail: float = 1.0) -> Path:
    """In even light from all around."""
    stage = _table(detail)
    usd.dome_light(stage, "sky", 1.0)
    return usd.save(stage, path, "A spoon with ten thousand scratches that diffract, under an even dome.")


MIDDLE = (0.0, 1.0, 0.0)


def _away(direction: tuple[float, float, float], distance: float) -> tuple[float, ...]:
    """The point so far from the middle of the spoon."""
    unit = np.asarray(direction) / np.linalg.norm(direction)
    return tuple(np.round(np.add(MIDDLE, distance * unit), 4).tolist())


def _table(detail: float) -> Usd.Stage:
    """The scratched spoon on a dark table, with its camera."""
    stage = usd.new_stage()
    steel = metal(stage, "steel", "iron", 0.004)
    usd.wave(steel)
    groove = usd.profile(steel, "groove", shape="rectangle")
    count = max(20, int(SCRATCHES * detail))
    usd.layer(
        steel, "wear", groove, scratches(stage, count), model="diffraction", distribution="curves", width=3.4, depth=3.4
    )
    turn = np.radians(28.0)
    c, s = float(np.cos(turn)), float(np.sin(turn))
    placed = [c, 0, -s, 0, 0, 1, 0, 0, s, 0, c, 0, -0.5 * LENGTH * c, 0.02, 0.5 * LENGTH * s, 1]
    usd.mesh(stage, "spoon", shape(detail), steel, [round(x, 7) for x in placed])
    slate = usd.material(stage, "slate", diffuseColor=(0.006, 0.0065, 0.008), roughness=1.0, ior=1.45)
    floor = shapes.lathe([[(80.0, 0.0), (0.0, 0.0)]], max(12, int(48 * detail)))
    usd.mesh(stage, "table", floor, slate)
    usd.camera(stage, (0.0, 33.0, 24.0), (0.0, 0.7, 0.0))
    usd.settings(stage)
    return stage


def shape(detail: float = 1.0) -> shapes.Shape:
    """The spoon: an upper side, an under side, and a round rim between them.

    On the upper side u runs from the handle to the tip and v across, both as fractions of the spoon's length, so that
    uv are true to scale where the surface is level.
    """
    columns, rows = max(24, int(170 * detail)), max(6, int(36 * detail))
    across = np.linspace(-1.0, 1.0, rows + 1)
    x, half, edge, sag = _stations(columns + 1)
    upper = _sheet(x, half, edge, sag, across)
    along = np.stack(np.gradient(upper, axis=(0, 1)), axis=0)
    normals = np.cross(along[1], along[0])
    normals /= np.linalg.norm(normals, axis=-1, keepdims=True)
    uv = np.stack([x / LENGTH + 0.0 * across[:, None], TOP_V + across[:, None] * half / LENGTH], axis=-1)
    under = (upper - (0.0, THICKNESS, 0.0))[::-1]
    under_uv = np.stack([uv[..., 0], 2 * BOTTOM_V - (uv[::-1, :, 1] - TOP_V + BOTTOM_V)], axis=-1)
    top = shapes.grid(upper, normals, uv)
    bottom = shapes.grid(under, -normals[::-1], under_uv)
    return shapes.joined([top, bottom, _rim(upper, max(3, int(8 * detail)))])


def _stations(count: int) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Distances [count] along the spoon, closer where its outline turns; half widths, heights of the edge and sags."""
    line = shapes.smooth(OUTLINE, 4000)
    steps = np.diff(line, axis=0) * (1.0, 0.5)
    way = np.concatenate([[0.0], np.cumsum(np.linalg.norm(steps, axis=1))])
    at = np.linspace(0.0, way[-1], count)
    x, half = (np.interp(at, way, line[:, i]) for i in range(2))
    rise = shapes.smooth(RISE, 4000)
    edge, sag = (np.interp(x, rise[:, 0], rise[:, i]) for i in (1, 2))
    return x, half, edge, sag


def _sheet(x: np.ndarray, half: np.ndarray, edge: np.ndarray, sag: np.ndarray, across: np.ndarray) -> np.ndarray:
    """Points [across, along, 3] of the upper side; a parabola across it."""
    t = across[:, None]
    return np.stack(np.broadcast_arrays(x, edge + sag * (t * t - 1.0), -t * half), axis=-1)


def _rim(upper: np.ndarray, rows: int) -> shapes.Shape:
    """Half a tube around the edge of the upper side, ``THICKNESS`` high."""

    edge, up = np.concatenate([upper[0], upper[1:, -1], upper[-1, -2::-1], upper[-2::-1, 0]]), np.array([0.0, 1.0, 0.0])
    ahead = np.roll(edge[:-1], -1, axis=0) - np.roll(edge[:-1], 1, axis=0)
    ahead = np.concatenate([ahead, ahead[:1]])
    out = np.cross(ahead, up)
    out /= np.linalg.norm(out, axis=1, keepdims=True)
    turn = np.linspace(-0.5 * np.pi, 0.5 * np.pi, rows + 1)[:, None, None]
    rims = np.cos(turn) * out + np.sin(turn) * up
    length = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(edge, axis=0), axis=1))])
    u, v = np.broadcast_arrays(length / LENGTH, RIM_V + 0.5 * THICKNESS * turn[..., 0] / LENGTH)
    return shapes.grid(edge - 0.5 * THICKNESS * up + 0.5 * THICKNESS * rims, rims, np.stack([u, v], axis=-1))


def scratches(stage: Usd.Stage, count: int) -> Sdf.Path:
    """``count`` straight scratches of all directions, evenly over the upper side in uv."""
    rng = np.random.default_rng(2018)
    x, half, _, _ = _stations(400)
    middle = np.zeros((0, 2))
    while len(middle) < count:
        found = rng.uniform((0.0, -half.max()), (LENGTH, half.max()), (count, 2))
        middle = np.concatenate([middle, found[np.abs(found[:, 1]) < np.interp(found[:, 0], x, half)]])
    turn = rng.uniform(0.0, np.pi, count)
    reach = 0.5 * rng.uniform(0.3, 3.4, count)[:, None] * np.stack([np.cos(turn), np.sin(turn)], axis=-1)
    ends = np.stack([middle[:count] - reach, middle[:count] + reach], axis=1) / LENGTH + (0.0, TOP_V)
    lines = np.concatenate([ends, np.zeros((count, 2, 1))], axis=2)
    width, depth = np.round(rng.uniform(LEAST, MOST, (2, count)), 3)
    return usd.curves(stage, "wear", list(lines), width=width, depth=depth, space="uv")


def star(points: int, inner: float, outer: float) -> shapes.Shape:
    """So many separate triangles around the origin in the plane z = 0, seen from -z."""
    at = 2.0 * np.pi * np.arange(points) / points
    corners = [inner * _ray(at - np.pi / points), outer * _ray(at), inner * _ray(at + np.pi / points)]
    flat = np.stack(corners[::-1], axis=1).reshape(-1, 2)
    flat = np.concatenate([flat, np.zeros((len(flat), 1))], axis=1)
    normals = np.broadcast_to((0.0, 0.0, -1.0), flat.shape)
    return shapes.Shape(flat, normals, 0.5 + flat[:, :2] / (2 * outer), np.full(points, 3), np.arange(3 * points))


def _ray(turn: np.ndarray) -> np.ndarray:
    return np.stack([np.cos(turn), np.sin(turn)], axis=-1)
