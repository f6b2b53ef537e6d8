"""Diffraction at a point of the surface: the scratches that a footprint sees, each under every light.

The footprint is a Gaussian of twice the second moments of the sample's parallelogram, C, so that neighbouring samples
overlap and no scratch is missed between them. A scratch adds as much as the line
that it is holds of a Gaussian of covariance C + sigma^2 / 2: across it that is the mean of |eta_s|^2 over the footprint
in closed form, along it pieces of one scratch add up exactly.
"""

import warp as wp

from ..optics.frames_device import Frame, frame_with_tangent
from ..optics.hash_device import hash_combine, unit_float
from ..reflectance.base_device import CONDUCTOR, DIELECTRIC, SCHLICK, Base
from ..reflectance.diffraction.ellipse_device import EXACT, PAPER, ellipse_footprint, make_ellipse
from ..scratches.segments_device import Plane, plane_of
from .geometry_device import Geometry, Surface
from .glint_arrays_device import GlintArrays, Glints, Strand
from .glint_bands_device import band_strand
from .glint_crowds_device import make_crowds
from .glint_energy_device import BINS, COLUMNS, balance_of, take_all, take_share
from .glint_lights_device import KNOWN, make_strand_light
from .glint_maps_device import mask_at, turned_band
from .glint_pairs_device import MOST_MATES, paired
from .glint_paths_device import diffracted_way, random_after
from .glint_stretch_device import between
from .key import KernelKey
from .lobe_device import luminance
from .material_device import MaterialArrays
from .world_device import LightSet

_REACH = wp.constant(3.2)  # standard deviations of the footprint
_SQRT_TWO_PI = wp.constant(2.5066282746)


@wp.func
def normal_change(g: Geometry, face: int, plane: Plane, x: float, y: float) -> wp.vec3:
    """Change of the outward shading normal a metre along (x, y) in a triangle's plane."""
    c = y / plane.cy
    b = (x - plane.cx * c) / plane.bx
    n = g.normals[3 * face]
    return b * (g.normals[3 * face + 1] - n) + c * (g.normals[3 * face + 2] - n)


@wp.func
def less_specular(base: Base, left: wp.vec3) -> Base:
    """A base of which diffraction leaves the specular part ``left``; that of a conductor is scaled outside."""
    b = base
    if base.fresnel == SCHLICK:
        b.f0 = wp.cw_mul(base.f0, left)
        b.f90 = wp.cw_mul(base.f90, left)
    elif base.fresnel == DIELECTRIC:
        b.specular = base.specular * luminance(left)
    return b


@wp.func
def left_of_base(base: Base, left: wp.vec3) -> wp.vec3:
    """The factor that ``less_specular`` could not put into the base."""
    return wp.where(base.fresnel == CONDUCTOR, left, wp.vec3(1.0, 1.0, 1.0))


@wp.func
def ellipse_density(
    a: GlintArrays, xt: float, xv: float, yt: float, yv: float, across: float, sigma: float, method: int
) -> float:
    """What a Gaussian has across the scratch, of an ellipse with the moments of the footprint's edges (xt, xv) and
    (yt, yv), along and across: its mean of e^{-y^2 / sigma^2} over sqrt(pi) sigma [1/m]; ``sigma`` [m]."""
    c_tt = (xt * xt + yt * yt) / 6.0
    c_tv = (xt * xv + yt * yv) / 6.0
    c_vv = (xv * xv + yv * yv) / 6.0
    middle = 0.5 * (c_tt + c_vv)
    spread = wp.sqrt(0.25 * (c_tt - c_vv) * (c_tt - c_vv) + c_tv * c_tv)
    # half axes in micrometres, and the angle from the scratch to the long one
    long = wp.float64(2.0e6 * wp.sqrt(middle + spread))
    short = wp.float64(2.0e6 * wp.sqrt(wp.max(middle - spread, 1.0e-6 * middle)))
    e = make_ellipse(long, short, wp.float64(0.5 * wp.atan2(2.0 * c_tv, c_tt - c_vv)))
    radius = wp.float64(1.0e6 * sigma)
    mean = ellipse_footprint(e, wp.float64(1.0e6 * across), radius, method, a.rules)
    return float(mean / (wp.float64(2.0 * wp.pi) * radius * radius)) / (1.7724538509 * sigma)


def make_glints(key: KernelKey, transmittance):
    """Device function: what diffraction adds at a point, compiled for ``key``."""
    strand_light = make_strand_light(key, transmittance)
    method = int(PAPER if key.glint_footprint == "paper" else EXACT)

    @wp.func
    def strand_of(
        g: Geometry, a: GlintArrays, number: int, s: Surface, n: wp.vec3, step_x: wp.vec3, step_y: wp.vec3, sigma: float
    ) -> Strand:
        """Piece ``number`` under the footprint; ``sigma`` [m]; length 0 where it has none of it."""
        r = Strand()
        piece = a.segments[number]
        face = piece.triangle
        half = wp.length(piece.half)
        plane = plane_of(g.points[3 * face], g.points[3 * face + 1], g.points[3 * face + 2])
        if half > 0.0 and plane.cy > 0.0:
            d = s.p - plane.origin
            rel = wp.vec2(
                float(wp.float64(wp.dot(d, plane.x)) - piece.middle[0]),
                float(wp.float64(wp.dot(d, plane.y)) - piece.middle[1]),
            )
            tx = piece.half[0] / half
            ty = piece.half[1] / half
            t = tx * plane.x + ty * plane.y
            v = tx * plane.y - ty * plane.x
            xt = wp.dot(step_x, t)
            xv = wp.dot(step_x, v)
            yt = wp.dot(step_y, t)
            yv = wp.dot(step_y, v)
            soft = 0.5 * sigma * sigma
            c_tt = (xt * xt + yt * yt) / 6.0 + soft
            c_tv = (xt * xv + yt * yv) / 6.0
            c_vv = (xv * xv + yv * yv) / 6.0 + soft
            along = tx * rel[0] + ty * rel[1]
            across = tx * rel[1] - ty * rel[0]
            if across * across < _REACH * _REACH * (c_vv + wp.static(float(key.glint_pairs)) * soft):
                mean = -c_tv * across / c_vv
                deviation = wp.sqrt(wp.max(c_tt - c_tv * c_tv / c_vv, soft))
                held = between((-half - along - mean) / deviation, (half - along - mean) / deviation)
                if held.part > 1.0e-5:
                    density = wp.exp(-0.5 * across * across / c_vv) / (_SQRT_TWO_PI * wp.sqrt(c_vv))
                    if wp.static(key.glint_footprint in ("exact", "paper")):
                        density = ellipse_density(a, xt, xv, yt, yv, across, sigma, wp.static(method))
                    r.length = 1.0e-6 * density * held.part
                    r.part = held.part
                    r.mean = mean + deviation * held.mean
                    r.variance = deviation * deviation * held.variance
                    # direction where the footprint sees it; the normal is that of the shading point
                    at = wp.clamp((along + r.mean) / half, -1.0, 1.0)
                    turn = 0.5 * ((1.0 - at) * piece.turn_a + (1.0 + at) * piece.turn_b)
                    cosine = wp.cos(turn)
                    sine = wp.sin(turn)
                    tangent = cosine * t + sine * v
                    aside = cosine * v - sine * t
                    r.frame = frame_with_tangent(n, tangent)
                    side = wp.where(wp.dot(aside, r.frame.y) < 0.0, -1.0, 1.0)
                    r.bend_y = side * (piece.turn_b - piece.turn_a) / (2.0 * half)
                    dn = normal_change(g, face, plane, cosine * tx - sine * ty, cosine * ty + sine * tx)
                    outward = wp.where(wp.dot(plane.n, n) < 0.0, -1.0, 1.0)
                    r.bend_n = -outward * wp.dot(dn, tangent)
                    r.width = piece.width
                    r.depth = piece.depth
                    r.layer = piece.layer
                    if wp.static(key.glint_masks):
                        r.length *= mask_at(a, a.layers[piece.layer].maps, g, s, step_x, step_y)
                    if wp.static(key.glint_pairs):
                        r.at = -side * across
                        r.low = -half - along
                        r.high = half - along
        return r

    crowd_light = make_crowds(key, strand_of, strand_light) if key.glint_crowds else None

    @wp.func
    def glints(
        a: GlintArrays,
        lights: LightSet,
        g: Geometry,
        arrays: MaterialArrays,
        s: Surface,
        frame: Frame,
        p: wp.vec3,
        wo: wp.vec3,
        edge_x: wp.vec3,
        edge_y: wp.vec3,
        closeness: float,
        index: wp.uint32,
        dimension: int,
        seed: wp.uint32,
    ) -> Glints:
        """At ``s`` of a material that diffracts; ``p``: the point moved off the surface; ``edge_x``, ``edge_y``: of
        the sample's footprint."""
        r = Glints()
        step_x = edge_x
        step_y = edge_y
        if wp.static(key.glint_footprint == "point"):
            step_x = wp.vec3(0.0, 0.0, 0.0)
            step_y = wp.vec3(0.0, 0.0, 0.0)
        total = wp.vec3(0.0, 0.0, 0.0)
        covered = wp.zeros(shape=wp.static(COLUMNS), dtype=float)
        taken = wp.zeros(shape=wp.static(BINS), dtype=float)
        number = a.material[s.material]
        wave = a.waves[number]
        known = wp.zeros(shape=wp.static(KNOWN), dtype=wp.vec4)
        if wp.static(key.glint_paths):
            # one of the strands, in proportion to what it covers
            drawn = Strand()
            drawn_area = float(0.0)
            area_sum = float(0.0)
            random = hash_combine(hash_combine(seed, index), wp.uint32(dimension))
        if wp.static(key.glint_segments):
            sigma = 1.0e-6 * wave.sigma
            reach = wp.vec3(0.0, 0.0, 0.0)
            for c in range(3):
                # fields reach further than their squares
                square = (step_x[c] * step_x[c] + step_y[c] * step_y[c]) / 6.0
                square += wp.static(1.0 if key.glint_pairs else 0.5) * sigma * sigma
                reach[c] = _REACH * wp.sqrt(square)
            if wp.static(key.glint_pairs):
                mates = wp.zeros(shape=wp.static(MOST_MATES), dtype=Strand)
                met = int(0)
                widest = float(0.0)
            listed = wp.static(key.glint_lists) and not wp.static(key.glint_hierarchy)
            if wp.static(key.glint_lists and key.glint_hierarchy):
                listed = True
                if a.around_reach.shape[0] > 0:
                    listed = wp.length(reach) <= a.around_reach[s.face]
            if wp.static(key.glint_crowds):
                if wp.static(not key.glint_pairs):
                    mates = wp.zeros(shape=1, dtype=Strand)
                crowd = crowd_light(
                    a, lights, g, arrays, s, frame.n, p, wo, step_x, step_y, reach, closeness, known, covered, taken,
                    mates, index, dimension, seed,
                )  # fmt: skip
                total += crowd.radiance
                r.rays += crowd.rays
                if wp.static(key.glint_paths):
                    drawn = crowd.drawn
                    drawn_area = crowd.drawn_area
                    area_sum = crowd.area_sum
                if wp.static(key.glint_pairs):
                    met = crowd.met
                    widest = crowd.widest
            else:
                # pieces around the face by lists, or those near by of all
                face_at = int(0)
                faces_end = int(0)
                next_piece = int(0)
                pieces_end = int(0)
                if wp.static(key.glint_lists):
                    if listed and a.around_starts.shape[0] > 0:
                        face_at = a.around_starts[s.face]
                        faces_end = a.around_starts[s.face + 1]
                if wp.static(key.glint_hierarchy):
                    searched = bool(False)
                    other = int(0)
                    if not listed and a.bvh != wp.uint64(0):
                        query = wp.bvh_query_aabb(a.bvh, s.p - reach, s.p + reach)
                        searched = True
                going = bool(True)
                while going:
                    piece = int(-1)
                    if wp.static(key.glint_lists):
                        while next_piece >= pieces_end and face_at < faces_end:
                            face = a.around[face_at]
                            next_piece = a.starts[face]
                            pieces_end = a.starts[face + 1]
                            face_at += 1
                        if next_piece < pieces_end:
                            piece = next_piece
                            next_piece += 1
                    if wp.static(key.glint_hierarchy):
                        if searched:
                            if wp.bvh_query_next(query, other):
                                piece = other
                    going = piece >= 0
                    if going:
                        if a.layers[a.segments[piece].layer].wave == number:
                            strand = strand_of(g, a, piece, s, frame.n, step_x, step_y, sigma)
                            if strand.length > 0.0:
                                layer = a.layers[strand.layer]
                                take_share(a, layer, strand, strand.length * strand.width, covered, taken)
                                if wp.static(key.glint_paths):
                                    area_sum += strand.length * strand.width
                                    random = random_after(random)
                                    if unit_float(random) * area_sum < strand.length * strand.width:
                                        drawn = strand
                                        drawn_area = strand.length * strand.width
                                alone = int(1)
                                if wp.static(key.glint_pairs):
                                    if wave.coherent == 1 and met < wp.static(MOST_MATES):
                                        mates[met] = strand
                                        met += 1
                                        widest = wp.max(widest, strand.width)
                                        alone = 0
                                if wp.static(not key.glint_pairs) or alone == 1:
                                    lit = strand_light(
                                        a, strand, lights, g, arrays, p, s.ng, s.instance, wo, closeness, known, index,
                                        dimension, seed,
                                    )  # fmt: skip
                                    total += wp.vec3(lit[0], lit[1], lit[2])
                                    r.rays += lit[3]
            if wp.static(key.glint_pairs):
                if wave.coherent == 1:
                    take_all(covered, taken)
                for i in range(met):
                    for j in range(i + 1):
                        both = paired(mates[i], mates[j], int(i == j), step_x, step_y, sigma, widest)
                        if both.length > 0.0:
                            lit = strand_light(
                                a,
                                both,
                                lights,
                                g,
                                arrays,
                                p,
                                s.ng,
                                s.instance,
                                wo,
                                closeness,
                                known,
                                index,
                                dimension,
                                seed,
                            )
                            total += wp.vec3(lit[0], lit[1], lit[2])
                            r.rays += lit[3]
        if wp.static(key.glint_bands):
            for n in range(wave.first_band, wave.first_band + wave.bands):
                band = a.bands[n]
                if wp.static(key.glint_orientations):
                    band = turned_band(a, band, g, s, frame, step_x, step_y, index)
                strand = band_strand(band, g, s, frame.n, step_x, step_y, 1.0e-6 * wave.sigma)
                if strand.length > 0.0:
                    layer = a.layers[strand.layer]
                    area = wp.min(strand.length * strand.width, 1.0)
                    if strand.pitch > 0.0:
                        # order 0 is the base's
                        area *= wp.max(1.0 - area / band.share, 0.0)
                    if wp.static(key.glint_masks):
                        there = mask_at(a, band.maps, g, s, step_x, step_y)
                        strand.length *= there
                        area *= there
                    take_share(a, layer, strand, area, covered, taken)
                    if wp.static(key.glint_paths):
                        area_sum += area
                        random = random_after(random)
                        if unit_float(random) * area_sum < area:
                            drawn = strand
                            drawn_area = area
                    lit = strand_light(
                        a,
                        strand,
                        lights,
                        g,
                        arrays,
                        p,
                        s.ng,
                        s.instance,
                        wo,
                        closeness,
                        known,
                        index,
                        dimension,
                        seed,
                    )
                    total += wp.vec3(lit[0], lit[1], lit[2])
                    r.rays += lit[3]
        balance = balance_of(a, covered, taken)
        r.left = balance.left
        r.radiance = wp.cw_mul(total, balance.shared)
        if wp.static(key.glint_paths):
            if drawn_area > 0.0:
                # of a grating what its orders hold, spread as by single lines
                drawn.length = drawn_area / wp.max(drawn.width, 1.0e-6)
                way = diffracted_way(a, drawn, wo, random)
                if wp.dot(way.direction, s.ng) > 0.0:
                    r.way = way.direction
                    carried = wp.cw_mul(way.weight, balance.shared) * (area_sum / drawn_area)
                    r.carried = carried
        return r

    return glints
