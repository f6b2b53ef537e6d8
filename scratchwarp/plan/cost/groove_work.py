"""What grooves make the renderer do, counted: pieces under a footprint, facets, and lines, from how densely they lie.

Lights without extent are averaged over the footprint: along a line across it where all grooves under it are parallel,
along many where they cross or end. A line is cut into parts of some pieces each; in a part the work has terms that
grow with its facets and with their square. All other light takes rays, each of which looks at the facets near it.
"""

import math
from collections.abc import Sequence

import numpy as np

from ...scene import DistantLight, Scene, SphereLight
from ..choice import EffectPlan
from ..grooves import FAR, NEAR, GrooveLayerPlan
from ..nearby import number_of
from .footprints import Print, footprints, parts_of_pixel

Units = dict[tuple[str, str], float]
SWEEP = 1.5
"""Depths of a groove by which view and light together shift what is seen of it."""
PARTS = 8
"""Pieces of a part of a line."""
HELD = 16.0
"""Pieces under the part of a footprint that is looked at: wider ones are looked at by parts."""
GOES_ON = 0.7
"""How often a path in grooves meets another facet."""
CHORD = 0.02
"""Widths of a groove by which its chords leave a circle."""


def groove_units(scene: Scene, plan: EffectPlan, shares: Sequence[float]) -> Units:
    """Units a sample; ``shares``: of the image, of each material."""
    found: Units = {}
    if not plan.on("grooves"):
        return found
    prints = footprints(scene, plan.size, parts_of_pixel(plan.settings))
    points = sum(_point(light) for light in scene.lights)
    wide = len(scene.lights) - points
    asked = int(plan.settings.knobs.get("grooves.lines", 48))
    lines = max(min(4, asked), -(-asked // (plan.settings.spp or 1)))
    bounces = 0.0
    if plan.on("grooves.interreflection"):
        most = int(plan.settings.knobs.get("grooves.bounces", 8))
        bounces = GOES_ON * (1.0 - GOES_ON**most) / (1.0 - GOES_ON)
    crossings = plan.on("grooves.crossings")

    def add(unit: str, count: float) -> None:
        effect = "grooves.crossings" if unit.startswith("grooves.line") and crossings else "grooves"
        if count > 0.0:
            found[effect, unit] = found.get((effect, unit), 0.0) + count

    for share, own, size in zip(shares, plan.grooves, prints, strict=False):
        if own is None or share <= 0.0:
            continue
        laid = [_Laid(scene, layer, size) for layer in own.layers]
        pieces = sum(one.near for one in laid)
        near = 1.0 - math.exp(-pieces) if any(one.stray for one in laid) else min(pieces, 1.0)
        if own.handover:
            wide_as = size.across / max(sum(one.width for one in laid) / len(laid), 1e-12)
            t = min(max((FAR - wide_as) / (FAR - NEAR), 0.0), 1.0)
            near *= t * t * (3.0 - 2.0 * t)
        if any(layer.section[:, 1].max() > 0.0 for layer in own.layers):
            near = 1.0  # what stands out darkens the ground
        count = min(max(pieces / max(near, 1e-9), 1.0), HELD)
        facets = sum(one.near * one.facets for one in laid) / max(pieces, 1e-12)
        by_ray = sum(one.at * one.facets for one in laid) / max(near, 1e-9)
        each = float(share) * near
        add("grooves.found", each * (1.0 + points))
        follows = 2.0 + bounces + (1.0 + bounces) * wide + bounces * points
        exact = each * points
        add("grooves.rays", each * follows)
        add("grooves.rayFacets", each * follows * by_ray)
        alone = 1.0
        if crossings:
            alone = 0.0 if count > 4.0 else math.exp(1.0 - count) * min(one.straight for one in laid)
        walked = exact * (lines * (1.0 - alone) + alone)
        parts = 1.0 + math.floor(count / PARTS)
        some = facets * max(count / parts, 1.0)
        add("grooves.lines", walked * parts)
        add("grooves.lineFacets", walked * parts * some)
        add("grooves.linePairs", walked * parts * some**2)
    return found


def laid_pieces(scene: Scene, plan: EffectPlan) -> float:
    """About how many pieces are laid out before anything is traced."""
    if not plan.on("grooves"):
        return 0.0
    prints = footprints(scene, plan.size, 1)
    return sum(
        number_of(layer.layer, scene, 1e-12 * size.area)
        for own, size in zip(plan.grooves, prints, strict=False) if own is not None
        for layer in own.layers
    )  # fmt: skip


class _Laid:
    """How a layer lies under footprints: ``near``: pieces that one touches; ``at``: pieces that a ray passes by;
    ``straight``: how often a groove that is touched goes on to both sides; ``stray``: grooves lie at random."""

    def __init__(self, scene: Scene, plan: GrooveLayerPlan, size: Print) -> None:
        layer = plan.layer
        unit = 1.0 if layer.space == "surface" else math.sqrt(max(size.area, 1e-300))
        self.facets = float(max(len(plan.section) - 1, 1))
        self.width, deep = layer.width * unit, layer.depth * unit
        self.stray = layer.distribution in ("curves", "worley", "random")
        long, dense = math.inf, 0.0  # micrometres from bend to bend; length over area
        if layer.distribution == "curves":
            strokes, corners, whole, broad = _curves(scene, plan, math.sqrt(max(size.area, 1e-300)))
            long, dense = whole / max(corners - strokes, 1.0), whole / max(size.area, 1e-300)
            deep *= broad / max(self.width, 1e-300)
            self.width = broad
        elif self.stray:
            long = max(layer.length * unit, self.width)
            each = layer.density / unit**2 if layer.density > 0.0 else layer.coverage / max(long * self.width, 1e-300)
            dense = each * long
        else:
            dense = (2.0 if layer.distribution == "crosshatch" else 1.0) / max(layer.pitch * unit, 1e-300)
            if layer.distribution in ("concentric", "spiral"):
                long = math.sqrt(8.0 * CHORD * self.width * math.sqrt(size.area) / 3.0)
        sweep = SWEEP * deep * size.stretch
        reach = self.width + sweep
        self.near = dense * (size.across + reach) * (1.0 + (size.across + reach) / max(long, 1e-12))
        self.at = dense * reach * (1.0 + reach / max(long, 1e-12))
        self.straight = math.exp(-(size.across + reach) / max(long, 1e-12))


def _curves(scene: Scene, plan: GrooveLayerPlan, side: float) -> tuple[float, float, float, float]:
    """(strokes, points, length [um], mean width [um]) of explicit curves; ``side``: of the uv square [um]."""
    strokes = corners = 0
    whole, broad = 0.0, 0.0
    for record in (scene.curves[c] for c in plan.layer.curves):
        steps = np.linalg.norm(np.diff(record.points, axis=0), axis=1)
        ends = np.cumsum(record.counts)[:-1] - 1
        steps[ends[ends < len(steps)]] = 0.0
        strokes += len(record.counts)
        corners += len(record.points)
        length = float(steps.sum()) * (side if record.space == "uv" else 1e6)
        unit = 1.0 if record.width_unit == "um" else side
        whole += length
        broad += length * float(np.mean(record.widths)) * unit
    return strokes, corners, whole, broad / max(whole, 1e-300)


def _point(light: object) -> bool:
    """Whether a light has no extent."""
    if isinstance(light, DistantLight):
        return light.angle == 0.0
    return isinstance(light, SphereLight) and (light.point or light.radius == 0.0)
