"""Parallel grooves and crossing scratches, each twice: as grooves of a flat plate, and as true geometry.

The comparison of Bosch, Pueyo, Merillou and Ghazanfarpour 2008, figure 10. The plates fill the picture; a stage and its
twin show the same surface under the same lights, so their pictures may be laid over one another. Lengths in
centimetres, +Y up, micro-structure in micrometres.
"""

from pathlib import Path

import numpy as np
from pxr import Sdf, Usd, UsdShade

from . import demo_relief as relief
from . import demo_shapes as shapes
from . import demo_usd as usd

SIDE = 80.0  # of the plates
UNIT = 1e4  # micrometres in a centimetre

# Parallel: a V with a step in one wall, and a ridge beside it.
RULED = [(0.0, 0.0), (0.12, 0.35), (0.24, 0.0), (0.46, -1.0), (0.62, -0.9), (0.74, -0.35), (0.86, -0.35), (1.0, 0.0)]
RULED_WIDTH, RULED_DEPTH, RULED_PITCH = 2400.0, 900.0, 2900.0

# Crossing: narrow floors, walls of unlike slopes.
SCRATCH = [(0.0, 0.0), (0.35, -1.0), (0.5, -1.0), (1.0, 0.0)]
SCRATCHES = 48
NARROW, WIDE = 700.0, 4200.0
ASPECT = 0.3  # depth over width
VIEW = 11.0  # half the part of the plate that has scratches


def grooves_parallel(path: Path | str, detail: float = 1.0) -> Path:
    """Parallel grooves from near to far; ``detail`` does nothing to a plate of two triangles."""
    stage, clay = _parallel()
    cut = usd.profile(clay, "cut", shape="points", points=RULED)
    usd.layer(
        clay, "ruled", cut, model="groove", distribution="linear", width=RULED_WIDTH, depth=RULED_DEPTH,
        pitch=RULED_PITCH,
    )  # fmt: skip
    usd.mesh(stage, "plate", flat(), clay)
    return usd.save(stage, path, "Parallel grooves.")


def grooves_parallel_true(path: Path | str, detail: float = 1.0) -> Path:
    """The same surface as triangles: 7 quads and the ground for each of some 400 grooves."""
    stage, clay = _parallel()
    usd.mesh(stage, "plate", ruled(), clay)
    return usd.save(stage, path, "Parallel grooves as true geometry.")


def grooves_crossing(path: Path | str, detail: float = 1.0) -> Path:
    """Scratches of all widths that cross and end; ``detail`` scales how many."""
    stage, steel = _crossing()
    cut = usd.profile(steel, "cut", shape="points", points=SCRATCH)
    lines = _scratches(stage, detail)
    usd.layer(
        steel, "scratches", cut, lines, model="groove", distribution="curves", width=WIDE, depth=ASPECT * WIDE
    )
    usd.mesh(stage, "plate", flat(), steel)
    return usd.save(stage, path, "Crossing scratches.")


def grooves_crossing_true(path: Path | str, detail: float = 1.0) -> Path:
    """The same surface as polygons, cut along every crease; ``detail`` scales the number of scratches."""
    stage, steel = _crossing()
    usd.mesh(stage, "plate", relief.crossed(SIDE, cuts(detail)), steel)
    return usd.save(stage, path, "Crossing scratches as true geometry.")


def flat() -> shapes.Shape:
    """The plate without its grooves."""
    return shapes.sheet(lambda u, v: np.stack([SIDE * (u - 0.5), 0 * u, SIDE * (0.5 - v)], axis=-1), 1, 1)


def ruled() -> shapes.Shape:
    """The parallel grooves as geometry; the first of a layer starts at the corner of the uv square."""
    section = np.subtract(RULED, (0.5, 0.0)) * (RULED_WIDTH / UNIT, RULED_DEPTH / UNIT)
    return relief.ruled(SIDE, section, RULED_PITCH / UNIT, 0.5 * (RULED_WIDTH / UNIT - SIDE))


def cuts(detail: float = 1.0) -> list[relief.Cut]:
    """The crossing scratches, in centimetres on the plate."""
    start, end, width = _layout(detail)
    section = np.subtract(SCRATCH, (0.5, 0.0)) * (1.0, ASPECT)
    return [relief.Cut(a, b, w * section) for a, b, w in zip(start, end, width / UNIT, strict=True)]


def _layout(detail: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Starts, ends [n, 2] in centimetres and widths [n] in micrometres; many are narrow, few wide."""
    count = max(4, int(SCRATCHES * min(detail, 1.0)))
    rng = np.random.default_rng(2008)
    middle = rng.uniform(-VIEW, VIEW, (SCRATCHES, 2))
    turn = rng.uniform(0.0, np.pi, SCRATCHES)
    half = 0.5 * rng.uniform(4.0, 34.0, SCRATCHES)[:, None] * np.stack([np.cos(turn), np.sin(turn)], axis=-1)
    width = np.round(NARROW * (WIDE / NARROW) ** (rng.uniform(0.0, 1.0, SCRATCHES) ** 1.5))
    return np.round(middle - half, 3)[:count], np.round(middle + half, 3)[:count], width[:count]


def _scratches(stage: Usd.Stage, detail: float) -> Sdf.Path:
    start, end, width = _layout(detail)
    ends = 0.5 + np.stack([start, end], axis=1) / SIDE
    lines = np.concatenate([ends, np.zeros((len(ends), 2, 1))], axis=2)
    return usd.curves(stage, "scratches", list(lines), width=width, depth=ASPECT * width, space="uv")


def _parallel() -> tuple[Usd.Stage, UsdShade.Material]:
    stage = usd.new_stage()
    clay = usd.material(stage, "clay", diffuseColor=(0.5, 0.27, 0.13), roughness=0.65)
    usd.distant_light(stage, "sun", (-0.45, -0.6, 0.6), 0.0, 4.2, (1.0, 0.95, 0.86))
    usd.dome_light(stage, "sky", 0.2, (0.75, 0.86, 1.0))
    usd.camera(stage, (-12.0, 9.0, 19.0), (-1.5, 0.0, 2.2))
    usd.settings(stage, integrator="path")
    return stage, clay


def _crossing() -> tuple[Usd.Stage, UsdShade.Material]:
    stage = usd.new_stage()
    steel = usd.material(stage, "steel", diffuseColor=(0.36, 0.4, 0.45), roughness=0.65)
    usd.distant_light(stage, "sun", (0.65, -0.6, 0.45), 0.0, 4.6, (1.0, 0.95, 0.88))
    usd.dome_light(stage, "sky", 0.2, (0.75, 0.86, 1.0))
    usd.camera(stage, (0.0, 26.0, 24.0), (0.0, 0.0, 0.8))
    usd.settings(stage, integrator="path")
    return stage, steel
