"""Objects that grooves make: three records, a tiled roof and an engraved column.

After Bosch, Pueyo, Merillou and Ghazanfarpour 2008, figures 1, 12 and 13: cross-sections that dig in, that stand out
and that overhang, in patterns that cross and end. Lengths in centimetres, +Y up, micro-structure in micrometres.
"""

from pathlib import Path

import numpy as np
from pxr import Sdf, Usd, UsdShade

from . import demo_shapes as shapes
from . import demo_usd as usd
from .demo_disc import ring

RECORD = (0.36, 4.6, 5.3, 14.4, 15.0)  # radii of the hole, the label, the grooves' end and beginning, and the rim
TRACK = 900.0  # from groove to groove

EAVES, SLOPE, PITCH = 300.0, 160.0, np.radians(33.0)  # a side of the roof: along the eaves, up the slope; its angle
COURSE, TILE, RISE, JOINT = 20.0, 16.0, 26_000.0, 7_000.0  # rows, columns; an edge's height, a joint's width

COLUMN, TALL = 12.0, 66.0
AROUND = 2.0 * np.pi * COLUMN
FLUTES = 20
BAND = (0.34, 0.62)  # of the writing, in v; a unit of v is as long as the way around


def vinyls(path: Path | str, detail: float = 1.0) -> Path:
    """Three records that differ in the cross-sections of their grooves alone; ``detail`` scales the number of faces."""
    stage = usd.new_stage()
    around = max(24, int(120 * detail))
    paper = [(0.55, 0.07, 0.04), (0.05, 0.2, 0.45), (0.62, 0.42, 0.05)]
    saw = [(0.0, 0.0), (0.1, -1.0), (1.0, 0.0)]
    step = [(0.0, 0.0), (0.0, -0.7), (0.3, -0.7), (0.45, -1.0), (0.6, -0.7), (1.0, 0.0)]
    for i, (name, at) in enumerate((("first", -33.0), ("second", 0.0), ("third", 33.0))):
        pressed = lacquer(stage, f"{name}Pressed")
        if name == "first":
            track(pressed, "track", usd.profile(pressed, "cut", shape="vGroove"), 1, 0, 300.0)
        elif name == "second":
            track(pressed, "track", usd.profile(pressed, "cut", shape="points", points=saw), 1, 0, 260.0)
        else:
            track(pressed, "round", usd.round_in_facets(pressed, "roundCut"), 3, 0, 300.0)
            track(pressed, "saw", usd.profile(pressed, "sawCut", shape="points", points=saw), 3, 1, 220.0)
            track(pressed, "step", usd.profile(pressed, "stepCut", shape="points", points=step), 3, 2, 320.0)
        usd.mesh(stage, f"{name}Track", ring(*RECORD[2:4], around, 3, RECORD[-1]), pressed, (at, 0.0, 0.0))
        flat = lacquer(stage, f"{name}Flat")
        for part, inner, outer in (("Dead", RECORD[1], RECORD[2]), ("Rim", RECORD[3], RECORD[4])):
            usd.mesh(stage, f"{name}{part}", ring(inner, outer, around, 1, RECORD[-1]), flat, (at, 0.0, 0.0))
        label = usd.material(stage, f"{name}Paper", diffuseColor=paper[i], roughness=0.8)
        usd.mesh(stage, f"{name}Label", ring(RECORD[0], RECORD[1], around, 1, RECORD[-1]), label, (at, 0.0, 0.0))
    cloth = usd.material(stage, "cloth", diffuseColor=(0.32, 0.3, 0.27), roughness=0.9)
    usd.mesh(stage, "table", shapes.lathe([[(160.0, 0.0), (0.0, 0.0)]], 48), cloth, (0.0, -0.2, 0.0))
    usd.distant_light(stage, "lamp", (-0.25, -0.8, 0.6), 0.0, 4.0, (1.0, 0.9, 0.76))
    usd.distant_light(stage, "spot", (0.75, -0.6, -0.2), 0.0, 3.0, (0.8, 0.9, 1.0))
    usd.dome_light(stage, "room", 0.2, (0.9, 0.95, 1.0))
    usd.camera(stage, (0.0, 88.0, 82.0), (0.0, 0.0, 1.0), lens=29.0)
    # Grooves are about a pixel wide: footprints of whole pixels leave less to the samples' places.
    usd.settings(stage, 960, 360, knobs=["scratches.coverageFilter=pixel"])
    camera = stage.GetPrimAtPath("/World/camera")
    camera.GetAttribute("verticalAperture").Set(camera.GetAttribute("horizontalAperture").Get() * 0.375)
    return usd.save(stage, path, "Three records with grooves of unlike cross-sections.")


def lacquer(stage: Usd.Stage, name: str) -> UsdShade.Material:
    """Black and glossy."""
    return usd.material(stage, name, diffuseColor=(0.006, 0.006, 0.007), roughness=0.3, ior=1.55)


def track(owner: UsdShade.Material, name: str, cut: Sdf.Path, every: int, which: int, depth: float) -> None:
    """Circles ``TRACK`` apart, or every so many of them, beginning with number ``which``."""
    usd.layer(
        owner, name, cut, model="groove", distribution="concentric", width=0.94 * TRACK, depth=depth,
        pitch=every * TRACK, offset=(0.0, -which / every),
    )  # fmt: skip


def roof(path: Path | str, detail: float = 1.0) -> Path:
    """A gable roof: every row of tiles is a ridge that overhangs the next, every joint a groove; ``detail`` scales
    nothing but the number of rows."""
    stage = usd.new_stage()
    clay = usd.material(stage, "clay", diffuseColor=(0.47, 0.17, 0.08), roughness=0.75)
    rows = max(3, int(SLOPE / COURSE * min(detail, 1.0)))
    course = usd.profile(clay, "edge", shape="points", points=EDGE)
    usd.layer(
        clay, "courses", course, _courses(stage, rows), order=1, model="groove", distribution="curves",
        width=COURSE * 1e4, depth=RISE,
    )  # fmt: skip
    joint = usd.profile(clay, "joint", shape="trapezoid", floorWidth=0.7)
    usd.layer(
        clay, "joints", joint, _joints(stage, rows), order=2, model="groove", distribution="curves", width=JOINT,
        depth=JOINT,
    )  # fmt: skip
    along, up = (1.0, 0.0, 0.0), np.array([0.0, np.sin(PITCH), -np.cos(PITCH)])
    side = shapes.sheet(lambda u, v: EAVES * (u - 0.5)[..., None] * along + SLOPE * v[..., None] * up, 1, 1)
    square = shapes.Shape(side.points, side.normals, side.uv * (1.0, SLOPE / EAVES), side.counts, side.indices)
    usd.mesh(stage, "front", square, clay, (0.0, 110.0, 0.0))
    plaster = usd.material(stage, "plaster", diffuseColor=(0.62, 0.56, 0.46), roughness=0.9)
    wall = shapes.extruded([(-14.0, 0.0), (-14.0, 110.0 + 14.0 * np.tan(PITCH))], EAVES - 24.0)
    usd.mesh(stage, "wall", wall, plaster)
    usd.distant_light(stage, "sun", (0.75, -0.62, -0.5), 0.0, 3.4, (1.0, 0.93, 0.8))
    usd.dome_light(stage, "sky", 0.55, (0.55, 0.75, 1.0))
    usd.camera(stage, (-190.0, 270.0, 250.0), (-8.0, 153.0, -66.0), lens=44.0)
    usd.settings(stage)
    return usd.save(stage, path, "A tiled roof.")


# Across a row, up the slope: a thick lower edge that overhangs, then down to the next row.
EDGE = [(0.0, 0.0), (0.1, 0.0), (0.06, 0.55), (0.06, 1.0), (0.12, 1.04), (1.0, 0.12), (1.0, 0.0)]


def _courses(stage: Usd.Stage, rows: int) -> Sdf.Path:
    v = (np.arange(rows) + 0.5) * COURSE / EAVES
    lines = [np.array([(-0.1, at, 0.0), (1.1, at, 0.0)]) for at in v]
    return usd.curves(stage, "courses", lines, width=COURSE * 1e4, depth=RISE, space="uv")


def _joints(stage: Usd.Stage, rows: int) -> Sdf.Path:
    """Between the tiles of each row, half a tile aside from row to row."""
    lines = []
    for row in range(rows):
        for u in (np.arange(-1, EAVES / TILE + 1) + 0.5 * (row % 2)) * TILE / EAVES:
            low, high = (row + 0.06) * COURSE / EAVES, (row + 1.06) * COURSE / EAVES
            lines.append(np.array([(u, low, 0.0), (u, high, 0.0)]))
    return usd.curves(stage, "joints", lines, width=JOINT, depth=JOINT, space="uv")


def column(path: Path | str, detail: float = 1.0) -> Path:
    """A stone column with flutes, rings that stand out, and a band of writing; ``detail`` scales the number of faces
    and of signs."""
    stage = usd.new_stage()
    around = max(16, int(128 * detail))
    stone = usd.material(stage, "stone", diffuseColor=(0.56, 0.47, 0.35), roughness=0.9)
    low, high = BAND
    top = TALL / AROUND
    u = (np.arange(FLUTES) + 0.5) / FLUTES
    ends = [(0.05, low - 0.05), (high + 0.05, top - 0.05)]
    flutes = [np.array([(x, a, 0.0), (x, b, 0.0)]) for a, b in ends for x in u]
    hollow = usd.round_in_facets(stone, "hollow")
    wide = 0.72 * AROUND / FLUTES * 1e4
    _cut(stage, stone, "flutes", hollow, flutes, wide, 0.26 * wide)
    bead = usd.profile(stone, "bead", shape="points", points=BEAD)
    rings = [np.array([(-0.1, v, 0.0), (1.1, v, 0.0)]) for v in (low - 0.02, high + 0.02)]
    _cut(stage, stone, "beads", bead, rings, 16_000.0, 7_000.0)
    chisel = usd.profile(stone, "chisel", shape="trapezoid", floorWidth=0.25)
    _cut(stage, stone, "writing", chisel, writing(max(4, int(12 * detail))), 3_000.0, 2_400.0)
    usd.mesh(stage, "shaft", shapes.lathe([[(COLUMN, 0.0), (COLUMN, TALL)]], around), stone)
    plain = usd.material(stage, "plain", diffuseColor=(0.56, 0.47, 0.35), roughness=0.9)
    n = max(6, int(24 * detail))
    base = shapes.smooth([(16.0, -5.0), (16.8, -3.4), (15.8, -1.9), (13.2, -1.4), (13.6, -0.6), (12.6, 0.0)], n)
    usd.mesh(stage, "base", shapes.lathe([base, [(12.6, 0.0), (10.0, 0.0)]], around), plain)
    floor = usd.material(stage, "floor", diffuseColor=(0.3, 0.27, 0.23), roughness=0.9)
    bend = np.linspace(0, np.pi / 2, max(6, int(24 * detail)))
    curve = np.stack([-60 - 30 * np.sin(bend), 30 - 30 * np.cos(bend)], axis=-1)
    outline = np.concatenate([[(120.0, 0.0), (-50.0, 0.0)], curve, [(-90.0, 180.0)]])
    usd.mesh(stage, "backdrop", shapes.extruded(outline, 400.0), floor, (0.0, -5.0, 0.0))
    usd.distant_light(stage, "sun", (0.8, -0.5, -0.35), 0.0, 4.4, (1.0, 0.9, 0.74))
    usd.dome_light(stage, "sky", 0.4, (0.7, 0.82, 1.0))
    usd.camera(stage, (0.0, 46.0, 120.0), (3.0, 31.5, 0.0), lens=33.0)
    usd.settings(stage, 480, 480)
    camera = stage.GetPrimAtPath("/World/camera")
    camera.GetAttribute("verticalAperture").Set(camera.GetAttribute("horizontalAperture").Get())
    return usd.save(stage, path, "An engraved column.")


# Half a circle that stands out.
BEAD = [(float(0.5 - 0.5 * np.cos(t)), float(np.sin(t))) for t in np.linspace(0.0, np.pi, 9)]
BEAD = [(round(x, 6), round(z, 6)) for x, z in BEAD]

# Strokes in a square: a looped cross, water, a reed, the sun, an eye, stairs.
SIGNS: list[list[list[tuple[float, float]]]] = [
    [[(0.5, 0.0), (0.5, 0.55), (0.36, 0.75), (0.4, 0.95), (0.5, 1.0), (0.6, 0.95), (0.64, 0.75), (0.5, 0.55)],
     [(0.25, 0.5), (0.75, 0.5)]],
    [[(0.1 + 0.1 * i, h + 0.14 * (i % 2)) for i in range(9)] for h in (0.15, 0.45, 0.75)],
    [[(0.5, 0.0), (0.5, 1.0), (0.68, 0.8), (0.64, 0.3), (0.5, 0.22)], [(0.3, 0.0), (0.7, 0.0)]],
    [[(0.5 + 0.34 * float(np.cos(t)), 0.5 + 0.34 * float(np.sin(t))) for t in np.linspace(0.0, 2.0 * np.pi, 17)],
     [(0.5, 0.44), (0.5, 0.56)]],
    [[(0.05, 0.5), (0.3, 0.72), (0.65, 0.72), (0.95, 0.5), (0.6, 0.36), (0.3, 0.36), (0.05, 0.5)],
     [(0.35, 0.3), (0.3, 0.02)], [(0.6, 0.3), (0.85, 0.05)], [(0.1, 0.85), (0.5, 1.0), (0.95, 0.82)]],
    [[(0.1, 0.0), (0.1, 0.33), (0.4, 0.33), (0.4, 0.66), (0.7, 0.66), (0.7, 1.0), (0.92, 1.0), (0.92, 0.0),
      (0.1, 0.0)]],
]  # fmt: skip


def writing(columns: int) -> list[np.ndarray]:
    """Signs in three lines around the shaft, as polylines [k, 3] in uv; the last point of a loop is its first."""
    low, high = BAND
    height = (high - low) / 3
    size = min(0.72 * height, 0.72 / columns)
    lines = []
    for row in range(3):
        for i in range(columns):
            corner = np.array([(i + 0.5) / columns - 0.5 * size, low + (row + 0.5) * height - 0.5 * size])
            for stroke in SIGNS[(5 * row + 7 * i) % len(SIGNS)]:
                flat = np.round(corner + size * np.array(stroke), 5)
                lines.append(np.concatenate([flat, np.zeros((len(flat), 1))], axis=1))
    return lines


def _cut(
    stage: Usd.Stage, owner: UsdShade.Material, name: str, profile: Sdf.Path, lines: list[np.ndarray], width: float,
    depth: float,
) -> None:  # fmt: skip
    """A layer of grooves along ``lines``."""
    paths = usd.curves(stage, name, lines, width=width, depth=depth, space="uv")
    usd.layer(owner, name, profile, paths, model="groove", distribution="curves", width=width, depth=depth)
