"""Stretched cellular noise (Raymond 2016 Eq. 7), filtered along the longer axis of the footprint.

A scratch is a disk of radius d about one jittered point in each cell of the stretched plane, so an ellipse on the
surface. A sample's footprint is a parallelogram; the renderer jitters samples over the pixel, so filtering along its
longer axis (many cells, because scratches are thin) removes nearly all noise and leaves the mean exact. That axis is
cut at 64 points with one random phase; each disk covers an interval of them, found in closed form and kept as bits of
one integer, so overlapping disks are counted once.
"""

import warp as wp

from ..optics.hash_device import pcg_hash, unit_float
from .layer_device import LayerData, LayerHit, longer, random_bits
from .variation_device import WIDTH, drawn_stretch, stretch

wp.set_module_options({"enable_backward": False})

# Footprints longer than FAR_BEGIN cells fade to the mean, which they equal in expectation, until FAR_END.
FAR_BEGIN = wp.constant(12.0)
FAR_END = wp.constant(24.0)

# One hash a cell: odd multipliers part its neighbours, its halves are the point's coordinates.
ALONG = wp.constant(wp.uint32(0x9E3779B1))
ACROSS = wp.constant(wp.uint32(0x85EBCA77))
SIXTEENTH_BIT = wp.constant(1.0 / 65536.0)


@wp.func
def count_bits(mask: wp.uint64) -> int:
    """Number of ones."""
    x = mask - ((mask >> wp.uint64(1)) & wp.uint64(0x5555555555555555))
    x = (x & wp.uint64(0x3333333333333333)) + ((x >> wp.uint64(2)) & wp.uint64(0x3333333333333333))
    x = (x + (x >> wp.uint64(4))) & wp.uint64(0x0F0F0F0F0F0F0F0F)
    return int((x * wp.uint64(0x0101010101010101)) >> wp.uint64(56))


@wp.func
def interval_bits(t0: float, t1: float, phase: float) -> wp.uint64:
    """Ones at k with t0 <= (k + phase) / 64 <= t1, k = 0..63."""
    # ceil and floor by conversions, as in ``whole``
    first = wp.clamp(t0 * 64.0 - phase, 0.0, 64.0)
    k0 = int(first)
    if float(k0) < first:
        k0 += 1
    k1 = int(wp.clamp(t1 * 64.0 - phase + 1.0, 0.0, 64.0)) - 1
    bits = wp.uint64(0)
    if k1 >= k0:
        n = k1 - k0 + 1
        bits = ~wp.uint64(0)
        if n < 64:
            bits = (wp.uint64(1) << wp.uint64(n)) - wp.uint64(1)
        bits = bits << wp.uint64(k0)
    return bits


@wp.func
def whole(x: wp.float64) -> wp.int64:
    """The whole number at or below ``x``, by a conversion (processors of the oldest kind call a library for floor)."""
    k = wp.int64(x)
    if wp.float64(k) > x:
        k -= wp.int64(1)
    return k


@wp.func
def point_in(cx: int, cy: int, seed: wp.uint32) -> wp.vec2:
    """The jittered point of a cell, each coordinate in [0, 1)."""
    h = pcg_hash(wp.uint32(cx) * ALONG + wp.uint32(cy) * ACROSS + seed)
    return wp.vec2(float(h >> wp.uint32(16)) * SIXTEENTH_BIT, float(h & wp.uint32(0xFFFF)) * SIXTEENTH_BIT)


@wp.func
def few_cells(
    p: wp.vec2, a: wp.vec2, ix: int, iy: int, radius: float, variation: float, seed: wp.uint32, phase: float
) -> float:
    """Covered fraction of a segment that touches two by two cells at most, as ``chord`` has it; -1 for longer ones.

    Most layers of a sparse pattern are passed over after the first loop, without a branch that depends on the disks.
    """
    reach = radius * (1.0 + variation)
    half_x = 0.5 * wp.abs(a[0]) + reach
    half_y = 0.5 * wp.abs(a[1]) + reach
    fraction = float(-1.0)
    if half_x <= 0.5 and half_y <= 0.5:
        # p lies in [0, 1)
        x0 = wp.where(p[0] < half_x, -1.0, 0.0)
        y0 = wp.where(p[1] < half_y, -1.0, 0.0)
        length2 = wp.dot(a, a)
        scale = 1.0 / wp.max(length2, 1.0e-20)
        touched = int(0)
        for k in range(4):
            x = x0 + float(k & 1)
            y = y0 + float(k >> 1)
            jitter = point_in(ix + int(x), iy + int(y), seed)
            to = wp.vec2(x + jitter[0] - p[0], y + jitter[1] - p[1])
            t = wp.clamp(wp.dot(to, a) * scale, -0.5, 0.5)
            off = to - t * a
            touched = touched | wp.where(wp.dot(off, off) <= reach * reach, 1 << k, 0)
        fraction = 0.0
        if touched != 0:
            if length2 < 1.0e-10:
                # a point; the varied radii of its disks are left to ``chord``
                fraction = wp.where(variation > 0.0, -1.0, 1.0)
            else:
                mask = wp.uint64(0)
                for k in range(4):
                    if (touched & (1 << k)) == 0:
                        continue
                    x = x0 + float(k & 1)
                    y = y0 + float(k >> 1)
                    cx = ix + int(x)
                    cy = iy + int(y)
                    jitter = point_in(cx, cy, seed)
                    to = wp.vec2(x + jitter[0] - p[0], y + jitter[1] - p[1])
                    r = radius
                    if variation > 0.0:
                        h = pcg_hash(wp.uint32(cx) * ALONG + wp.uint32(cy) * ACROSS + seed)
                        r *= 1.0 + variation * (1.0 - 2.0 * wp.abs(2.0 * unit_float(pcg_hash(h ^ WIDTH)) - 1.0))
                    b = wp.dot(to, a) * scale
                    # across is exact where both are large: a cross product, not a difference of squares
                    across = to[0] * a[1] - to[1] * a[0]
                    rest = r * r - across * across * scale
                    if rest > 0.0:
                        half = wp.sqrt(rest * scale)
                        mask = mask | interval_bits(b - half + 0.5, b + half + 0.5, phase)
                fraction = float(count_bits(mask)) / 64.0
    return fraction


@wp.struct
class Chord:
    """Covered fraction of a segment, and one of the scratches there, drawn by what it covers.

    ``scratch``: its hash; ``along``: where on it, from its middle, in wavelengths of its variation.
    """

    fraction: float
    scratch: wp.uint32
    along: float


def make_chord(varied: bool):
    """Device function of a chord's coverage; ``varied``: it says of which scratch, too."""

    @wp.func
    def chord(
        p: wp.vec2,
        a: wp.vec2,
        ix: int,
        iy: int,
        radius: float,
        variation: float,
        seed: wp.uint32,
        phase: float,
        wave: float,
    ) -> Chord:
        """The segment p - a/2 .. p + a/2 (cells, relative to cell (ix, iy)) and the disks of width ``radius`` times
        1 -+ ``variation``, which change along x by ``wave`` wavelengths a cell (0: not at all)."""
        swap = wp.abs(a[0]) > wp.abs(a[1])
        q = p
        d = a
        if swap:
            q = wp.vec2(p[1], p[0])
            d = wp.vec2(a[1], a[0])
        reach = radius * (1.0 + variation)
        start = q - 0.5 * d
        low = wp.min(start[1], start[1] + d[1])
        high = wp.max(start[1], start[1] + d[1])
        length2 = wp.dot(d, d)
        mask = wp.uint64(0)
        found = Chord()
        seen = float(0.0)
        bits = random_bits(phase)
        row0 = int(wp.floor(low - reach))
        row1 = int(wp.floor(high + reach))
        for row in range(row0, row1 + 1):
            # part of the segment that a disk of this row can touch
            s0 = float(0.0)
            s1 = float(1.0)
            if wp.abs(d[1]) > 1.0e-6:
                e0 = (float(row) - reach - start[1]) / d[1]
                e1 = (float(row) + 1.0 + reach - start[1]) / d[1]
                s0 = wp.clamp(wp.min(e0, e1), 0.0, 1.0)
                s1 = wp.clamp(wp.max(e0, e1), 0.0, 1.0)
            x0 = start[0] + s0 * d[0]
            x1 = start[0] + s1 * d[0]
            column0 = int(wp.floor(wp.min(x0, x1) - reach))
            column1 = int(wp.floor(wp.max(x0, x1) + reach))
            for column in range(column0, column1 + 1):
                cx = ix + column
                cy = iy + row
                if swap:
                    cx = ix + row
                    cy = iy + column
                jitter = point_in(cx, cy, seed)
                h2 = pcg_hash(wp.uint32(cx) * ALONG + wp.uint32(cy) * ACROSS + seed)
                fx = float(column) + wp.where(swap, jitter[1], jitter[0])
                fy = float(row) + wp.where(swap, jitter[0], jitter[1])
                to = wp.vec2(start[0] - fx, start[1] - fy)
                b = wp.dot(to, d)
                r = radius
                along = float(0.0)
                if wp.static(varied):
                    # where the segment comes nearest, along the scratch
                    near = wp.clamp(-b / wp.max(length2, 1.0e-10), 0.0, 1.0)
                    along = (to[0] + near * d[0]) * wave
                    if swap:
                        along = (to[1] + near * d[1]) * wave
                    r = radius * stretch(h2, along, variation)
                else:
                    if variation > 0.0:
                        r = radius * (
                            1.0 + variation * (1.0 - 2.0 * wp.abs(2.0 * unit_float(pcg_hash(h2 ^ WIDTH)) - 1.0))
                        )
                c = wp.dot(to, to) - r * r
                added = wp.uint64(0)
                if length2 < 1.0e-10:
                    if c <= 0.0:
                        added = ~wp.uint64(0)
                else:
                    discriminant = b * b - length2 * c
                    if discriminant > 0.0:
                        root = wp.sqrt(discriminant)
                        added = interval_bits((-b - root) / length2, (-b + root) / length2, phase)
                if wp.static(varied):
                    more = float(count_bits(added & ~mask))
                    if more > 0.0:
                        seen += more
                        bits = pcg_hash(bits)
                        if unit_float(bits) * seen < more:
                            found.scratch = h2
                            found.along = along
                mask = mask | added
        found.fraction = float(count_bits(mask)) / 64.0
        return found

    return chord


def make_worley(varied: bool):
    """Device function of the pattern; ``varied``: it also draws one of the scratches under the footprint."""
    chord = make_chord(varied)

    @wp.func
    def worley(layer: LayerData, q: wp.vec2d, scale: wp.vec2d, ax: wp.vec2, ay: wp.vec2, phase: float) -> LayerHit:
        """Coverage of a footprint with axes ``ax``, ``ay`` about ``q``, all in pattern space; ``phase`` in [0, 1)."""
        c = wp.float64(layer.cos_a)
        s = wp.float64(layer.sin_a)
        x = c * q[0] + s * q[1]
        y = c * q[1] - s * q[0]
        # y -> y - f(x, y) turns straight scratches into waves; the scratch follows dy/dx = f_x / (1 - f_y)
        fx = float(0.0)
        fy = float(0.0)
        if layer.bend > wp.float64(0.0):
            angle = layer.bend_number * (x + y / wp.float64(3.0))
            y -= layer.bend * wp.sin(angle)
            fx = float(layer.bend * layer.bend_number * wp.cos(angle))
            fy = fx / 3.0
        px = x * layer.inv_length + layer.offset[0]
        py = y * layer.inv_width + layer.offset[1]
        ix = whole(px)
        iy = whole(py)

        il = float(layer.inv_length)
        iw = float(layer.inv_width)
        ax_x = layer.cos_a * ax[0] + layer.sin_a * ax[1]
        ax_y = layer.cos_a * ax[1] - layer.sin_a * ax[0]
        ay_x = layer.cos_a * ay[0] + layer.sin_a * ay[1]
        ay_y = layer.cos_a * ay[1] - layer.sin_a * ay[0]
        a = longer(
            wp.vec2(ax_x * il, (ax_y * (1.0 - fy) - ax_x * fx) * iw),
            wp.vec2(ay_x * il, (ay_y * (1.0 - fy) - ay_x * fx) * iw),
        )
        far = float(0.0)
        length2 = wp.dot(a, a)
        if length2 > FAR_BEGIN * FAR_BEGIN:
            far = wp.min((wp.sqrt(length2) - FAR_BEGIN) / (FAR_END - FAR_BEGIN), 1.0)
        alpha = layer.mean
        near = Chord()
        if far < 1.0:
            at = wp.vec2(float(px - wp.float64(ix)), float(py - wp.float64(iy)))
            fraction = few_cells(at, a, int(ix), int(iy), layer.radius, layer.width_variation, layer.seed, phase)
            near.fraction = fraction
            if fraction < 0.0 or (wp.static(varied) and fraction > 0.0):
                near = chord(
                    at,
                    a,
                    int(ix),
                    int(iy),
                    layer.radius,
                    layer.width_variation,
                    layer.seed,
                    phase,
                    layer.wave / il,
                )
            alpha = far * layer.mean + (1.0 - far) * near.fraction

        hit = LayerHit()
        hit.alpha = alpha
        if wp.static(varied):
            bits = pcg_hash(random_bits(phase) ^ layer.seed)
            hit.scratch = near.scratch
            hit.along = near.along
            hit.stretch = stretch(near.scratch, near.along, layer.width_variation)
            # from afar some scratch of the layer, by what it covers
            if unit_float(bits) * alpha < far * layer.mean or near.scratch == wp.uint32(0):
                hit.scratch = pcg_hash(bits)
                hit.along = 0.0
                hit.stretch = drawn_stretch(unit_float(pcg_hash(hit.scratch)), layer.width_variation, 2.0)
        if alpha > 0.0:
            tangent = wp.vec2(1.0, 0.0)
            if layer.bend > wp.float64(0.0):
                tangent = wp.normalize(wp.vec2(1.0 - fy, fx))
            hit.direction = wp.vec2(
                layer.cos_a * tangent[0] - layer.sin_a * tangent[1],
                layer.sin_a * tangent[0] + layer.cos_a * tangent[1],
            )
        return hit

    return worley


chord_coverage = make_chord(False)
chord_coverage_varied = make_chord(True)
worley = make_worley(False)
worley_varied = make_worley(True)
