"""The kettle: a brushed surface of revolution, its scratches running around it, with lid, knob, spout and handle.

Lengths in centimetres, +Y up, micro-structure in micrometres.
"""

from pathlib import Path

import numpy as np
from pxr import Usd

from . import demo_shapes as shapes
from . import demo_usd as usd
from .demo_ball import metal


def kettle(path: Path | str, detail: float = 1.0) -> Path:
    """Write the stage; ``detail`` scales the number of faces."""
    stage = usd.new_stage()
    n, around = max(5, int(40 * detail)), max(12, int(160 * detail))
    steel = metal(stage, "steel", "aluminium", 0.12)
    brushed = usd.profile(steel, "bristle", shape="round")
    usd.layer(
        steel, "brushed", brushed, order=1, distribution="worley", width=28.0, depth=5.0, length=15000.0, coverage=0.75,
        patterns=4, angleSpread=3.0, seed=1,
    )
    usd.layer(
        steel, "bands", usd.profile(steel, "tool", shape="vGroove", rim=0.1), order=2, distribution="linear",
        width=90.0, depth=16.0, pitch=2600.0,
    )
    usd.layer(
        steel, "use", usd.profile(steel, "accident", shape="vGroove", rim=0.3), order=3, distribution="random",
        width=60.0, depth=14.0, length=22000.0, coverage=0.006, angle=35.0, angleSpread=150.0, curvature=10.0,
        widthVariation=0.5, seed=5,
    )
    side = [(7.6, 0.0), (8.6, 0.9), (9.4, 3.6), (9.0, 7.0), (7.2, 10.2), (5.4, 11.9), (4.9, 12.5)]
    belly = shapes.smooth(side, 3 * n)
    rim = shapes.smooth([(4.9, 12.5), (4.95, 12.72), (4.75, 12.8)], max(3, n // 4))
    usd.mesh(stage, "body", shapes.lathe([[(7.2, 0.0), (7.6, 0.0)], belly, rim], around), steel)
    cover = shapes.smooth([(4.72, 12.74), (4.3, 13.25), (2.6, 13.9), (0.9, 14.15), (0.0, 14.17)], n)
    usd.mesh(stage, "lid", shapes.lathe([cover], around), steel)
    brass = metal(stage, "brass", "brass", 0.1)
    usd.layer(
        brass, "turned", usd.profile(brass, "tool", shape="round", periodic=True), distribution="linear", width=140.0,
        depth=14.0, pitch=140.0,
    )
    knob = shapes.smooth([(0.45, 14.1), (0.42, 14.5), (0.9, 14.95), (1.15, 15.4), (0.85, 15.85), (0.0, 16.0)], n)
    usd.mesh(stage, "knob", shapes.lathe([knob], max(12, int(64 * detail))), brass)
    bend = [(7.3, 4.2, 0.0), (10.2, 5.6, 0.0), (12.2, 8.6, 0.0), (13.4, 11.2, 0.0), (14.9, 12.4, 0.0)]
    spout = shapes.smooth(bend, n)
    radii = np.interp(np.linspace(0, 1, n), [0, 0.4, 1], [2.3, 1.5, 0.85])
    usd.mesh(stage, "spout", shapes.tube(spout, radii, max(12, int(64 * detail))), steel)
    bakelite = usd.material(stage, "bakelite", diffuseColor=(0.02, 0.014, 0.012), roughness=0.25, ior=1.6)
    usd.layer(
        bakelite, "worn", usd.profile(bakelite, "scuff", shape="round"), distribution="worley", width=18.0, depth=2.0,
        length=5000.0, coverage=0.15, angle=90.0, angleSpread=120.0, patterns=6, seed=2,
    )
    half = [(5.6, 11.2, 0.0), (7.2, 14.6, 0.0), (4.6, 18.6, 0.0)]
    arch = shapes.smooth([(-x, y, z) for x, y, z in half] + [(0.0, 19.8, 0.0)] + half[::-1], 2 * n)
    usd.mesh(stage, "handle", shapes.tube(arch, 0.62, max(10, int(40 * detail))), bakelite)
    studio(stage, detail)
    usd.camera(stage, (12.0, 30.0, 70.0), (3.0, 9.2, 0.0))
    usd.settings(stage)
    return usd.save(stage, path, "A brushed kettle: circular scratches.")


def studio(stage: Usd.Stage, detail: float) -> None:
    """A backdrop, four soft panels, two small bulbs, a weak sun and a dim dome."""
    paper = usd.material(stage, "paper", diffuseColor=(0.22, 0.2, 0.19), roughness=0.9)
    n = max(6, int(24 * detail))
    bend = np.linspace(0, np.pi / 2, n)
    curve = np.stack([-35 - 30 * np.sin(bend), 30 - 30 * np.cos(bend)], axis=-1)
    backdrop = np.concatenate([[(80.0, 0.0), (20.0, 0.0), (-30.0, 0.0)], curve, [(-65.0, 60.0), (-65.0, 90.0)]])
    usd.mesh(stage, "backdrop", shapes.extruded(backdrop, 260.0), paper)
    usd.rect_light(stage, "key", (-45.0, 50.0, 40.0), (0.0, 8.0, 0.0), (36.0, 36.0), 8.0, (1.0, 0.96, 0.9))
    usd.rect_light(stage, "side", (58.0, 22.0, 16.0), (0.0, 8.0, 0.0), (10.0, 50.0), 7.0, (0.86, 0.93, 1.0))
    usd.rect_light(stage, "rimLeft", (-46.0, 22.0, -26.0), (0.0, 8.0, 0.0), (14.0, 44.0), 3.0, (0.86, 0.93, 1.0))
    usd.rect_light(stage, "rimRight", (46.0, 22.0, -26.0), (0.0, 8.0, 0.0), (14.0, 44.0), 3.0, (1.0, 0.96, 0.9))
    usd.sphere_light(stage, "bulb", (22.0, 48.0, 46.0), 0.8, 2400.0)
    usd.sphere_light(stage, "spark", (-30.0, 30.0, 50.0), 0.5, 2400.0, (1.0, 0.85, 0.7))
    usd.distant_light(stage, "sun", (-0.4, -1.0, -0.5), 2.0, 0.4)
    usd.dome_light(stage, "ambient", 0.22, (0.8, 0.88, 1.0))
