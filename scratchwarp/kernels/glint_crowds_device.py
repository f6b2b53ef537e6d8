"""Footprints over very many scratches: some are lit for all, by chance and without bias.

The pieces of a material are dealt at random into groups, each with a hierarchy of its own. One group, always the same,
says about how many scratches lie under a footprint and how much they cover. Where they are too many, as many groups
are looked at as hold a few thousand, from one on that the sample's number draws; all of these tell what is left of the
base. Of them those are lit at which the covered area, summed up, passes the next of even steps: a scratch in
proportion to what it covers, weighed by one over that. How many groups and how long a step depends on the first group
alone, not on what is drawn, so that the mean over samples is the sum over all scratches.
"""

from typing import Any

import warp as wp

from ..optics.hash_device import hash_combine, pcg_hash, unit_float
from ..plan.crowds import SEEN
from .geometry_device import Geometry, Surface
from .glint_arrays_device import GlintArrays, Strand
from .glint_energy_device import BINS, COLUMNS, take_share
from .glint_pairs_device import MOST_MATES
from .glint_paths_device import random_after
from .key import KernelKey
from .material_device import MaterialArrays
from .world_device import LightSet

_SEEN = wp.constant(int(SEEN))
_GOLDEN = wp.constant(wp.uint32(2654435769))


@wp.struct
class Crowd:
    """What the scratches under a footprint add: radiance, rays that took; ``met``: how many there are for pairs, the
    widest of them [um]; ``drawn``: one strand, and what it and all of them cover."""

    radiance: wp.vec3
    rays: float
    met: int
    widest: float
    drawn: Strand
    drawn_area: float
    area_sum: float


def make_crowds(key: KernelKey, strand_of: Any, strand_light: Any) -> Any:
    """Device function: what the scratches under a footprint add, compiled for ``key``."""

    @wp.func
    def crowd_light(
        a: GlintArrays,
        lights: LightSet,
        g: Geometry,
        arrays: MaterialArrays,
        s: Surface,
        n: wp.vec3,
        p: wp.vec3,
        wo: wp.vec3,
        step_x: wp.vec3,
        step_y: wp.vec3,
        reach: wp.vec3,
        closeness: float,
        known: wp.array(dtype=wp.vec4),
        covered: wp.array(dtype=float),
        taken: wp.array(dtype=float),
        mates: wp.array(dtype=Strand),
        index: wp.uint32,
        dimension: int,
        seed: wp.uint32,
    ) -> Crowd:
        """``covered``, ``taken``: sums of ``take_share``; ``mates``: becomes those for pairs."""
        r = Crowd()
        number = a.material[s.material]
        wave = a.waves[number]
        sigma = 1.0e-6 * wave.sigma
        low = s.p - reach
        high = s.p + reach
        looked_at = int(wave.groups)
        step = float(0.0)  # area from one that is lit to the next; 0: all are
        if wave.strands > 0 and wave.groups > 0:
            count = int(0)
            area = float(0.0)
            query = wp.bvh_query_aabb(a.bvh, low, high, wp.bvh_get_group_root(a.bvh, wave.first_group))
            other = int(0)
            while wp.bvh_query_next(query, other):
                strand = strand_of(g, a, other, s, n, step_x, step_y, sigma)
                if strand.length > 0.0:
                    count += 1
                    area += strand.length * strand.width
            whole = float(count) * float(wave.groups)
            if whole > 2.0 * float(wave.strands):
                looked_at = wp.clamp(wave.strands * _SEEN / count, 1, wave.groups)
                step = area * float(looked_at) / float(wave.strands)
        random = hash_combine(seed, wp.uint32(dimension))
        # one sample after another starts at groups that are spread evenly
        turn = random + index * _GOLDEN
        start = int(((turn >> wp.uint32(16)) * wp.uint32(wave.groups)) >> wp.uint32(16))
        random = pcg_hash(random ^ index)
        level = unit_float(random)
        for k in range(looked_at):
            group = wave.first_group + (start + k) % wave.groups
            query = wp.bvh_query_aabb(a.bvh, low, high, wp.bvh_get_group_root(a.bvh, group))
            other = int(0)
            while wp.bvh_query_next(query, other):
                strand = strand_of(g, a, other, s, n, step_x, step_y, sigma)
                if strand.length > 0.0:
                    layer = a.layers[strand.layer]
                    area = strand.length * strand.width
                    take_share(a, layer, strand, area, covered, taken)
                    if wp.static(key.glint_paths):
                        r.area_sum += area
                        random = random_after(random)
                        if unit_float(random) * r.area_sum < area:
                            r.drawn = strand
                            r.drawn_area = area
                    times = float(1.0)
                    if step > 0.0:
                        level += area / step
                        passed = wp.floor(level)
                        level -= passed
                        times = passed * step / wp.max(area, 1.0e-30)
                    alone = bool(times > 0.0)
                    if wp.static(key.glint_pairs):
                        if step == 0.0 and wave.coherent == 1 and r.met < wp.static(MOST_MATES):
                            mates[r.met] = strand
                            r.met += 1
                            r.widest = wp.max(r.widest, strand.width)
                            alone = bool(False)
                    if alone:
                        lit = strand_light(
                            a, strand, lights, g, arrays, p, s.ng, s.instance, wo, closeness, known, index, dimension,
                            seed,
                        )  # fmt: skip
                        r.radiance += times * wp.vec3(lit[0], lit[1], lit[2])
                        r.rays += lit[3]
        # those looked at stand for all groups
        more = float(wave.groups) / float(wp.max(looked_at, 1))
        r.radiance = more * r.radiance
        r.area_sum = more * r.area_sum
        for j in range(wp.static(COLUMNS)):
            covered[j] = more * covered[j]
        for j in range(wp.static(BINS)):
            taken[j] = more * taken[j]
        return r

    return crowd_light
