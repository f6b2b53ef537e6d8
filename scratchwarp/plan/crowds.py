"""Footprints over more scratches that diffract than it makes sense to sum: how many there are, and which to draw.

Some stand for all, drawn with probabilities that are known, so that the mean over samples is that of all of them and
what is left out shows as noise. See ``kernels.glint_crowds_device``.
"""

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from ..scene import Layer, Scene, Settings
from ..scene.knob import Value

KNOB = "diffraction.strands"
MOST = 1024
"""Scratches of a footprint that are lit by default."""
SEEN = 8
"""For each that is lit, scratches that are looked at, of which it is drawn: they say how much of the base is left."""
WIDE = 2.6
"""Widths of a footprint over which its Gaussian is looked at."""
ACROSS = 1.128
"""Width of a circle of the area of a square of edge 1."""
AROUND = 13.0
"""Triangles around one, itself counted."""
STRAY = ("random", "worley", "curves")
"""Distributions whose scratches lie one by one."""


def laid(scene: Scene, number: int, layer: Layer) -> tuple[float, float]:
    """(scratches a square micrometre, their length [um]) of a layer of a material."""
    if layer.distribution != "curves":
        length = max(layer.length, layer.width)
        covering = -math.log(max(1.0 - layer.coverage, 1e-4)) / max(length * layer.width, 1e-12)
        return (layer.density * 1e-6 if layer.density > 0.0 else covering), length
    area = 0.0
    for instance in scene.instances:
        mesh = scene.meshes[instance.mesh]
        if number in instance.materials and len(mesh.triangles):
            corners = mesh.points[mesh.triangles] @ instance.transform[:3, :3].T
            area += 0.5 * float(np.linalg.norm(np.cross(*np.moveaxis(np.diff(corners, axis=1), 1, 0)), axis=-1).sum())
    side, strokes, whole = 1e6 * math.sqrt(max(area, 1e-20)), 0, 0.0
    for record in (scene.curves[c] for c in layer.curves):
        steps = np.linalg.norm(np.diff(record.points, axis=0), axis=1)
        ends = np.cumsum(record.counts)[:-1] - 1
        steps[ends[ends < len(steps)]] = 0.0
        strokes += len(record.counts)
        whole += float(steps.sum()) * (side if record.space == "uv" else 1e6)
    return strokes / side**2, whole / max(strokes, 1)


def under(dense: float, length: float, across: float, side: float) -> float:
    """Pieces under a footprint ``across`` wide, of scratches of a ``length`` that triangles of ``side`` cut; ``dense``
    a square micrometre; all in micrometres."""
    reach = WIDE * across
    return dense * length * reach * (1.0 + 0.6 * reach / max(min(length, 0.6 * side), 1e-12))


def around(scene: Scene, waves: Sequence[Any], triangle: float) -> list[float]:
    """About how many pieces a triangle and its neighbours hold of each material; edge of a triangle [m]."""
    side = 0.6e6 * triangle
    found = []
    for number, own in enumerate(waves):
        stray = [p.layer for p in own.layers if p.layer.distribution in STRAY] if own is not None else []
        lengths = [laid(scene, number, x) for x in stray]
        counts = [AROUND * dense * run * side * (1.0 + side / max(min(run, side), 1e-12)) for dense, run in lengths]
        found.append(float(sum(counts)))
    return found


def crowds(scene: Scene, waves: Sequence[Any], footprint: float, triangle: float) -> list[float]:
    """About how many scratches that lie one by one a footprint holds, of each material; edges of a footprint and of a
    triangle [m]."""
    found = []
    for number, own in enumerate(waves):
        stray = [p.layer for p in own.layers if p.layer.distribution in STRAY] if own is not None else []
        counts = [under(*laid(scene, number, x), 1e6 * ACROSS * footprint, 1e6 * triangle) for x in stray]
        found.append(float(sum(counts)))
    return found


def lit(knobs: Mapping[str, Value]) -> int:
    """Scratches of a footprint that are lit at most; 0: all."""
    asked = knobs.get(KNOB, MOST)
    return 0 if asked == "all" else int(asked)


def crowded(count: float, settings: Settings) -> bool:
    """Whether so many scratches under a footprint are drawn from."""
    return count > 2.0 * (lit(settings.knobs) or MOST)


def groups(count: float, settings: Settings, pieces: int) -> int:
    """Into how many groups a material's pieces are dealt, a power of two, 1 where it is not crowded: so many that one
    of them says how many there are, and that few are looked at where there are many."""
    if not crowded(count, settings) or not pieces:
        return 1
    wanted = 4.0 * count / (lit(settings.knobs) or MOST)
    return 1 << max(0, min(math.ceil(math.log2(wanted)), 12, int(math.log2(max(pieces / 8, 1)))))
