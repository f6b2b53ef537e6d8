"""Kernels that send rays into a cross-section, one thread a line: a line is one direction of incidence and many entry
points.

What a path did is stored (where it left, how often it was reflected, at which cosines); energies come later, see
``energy_kernels``.
"""

from functools import lru_cache
from typing import Any

import warp as wp

from scratchwarp.profiles.path_device import Cosines, path_function
from scratchwarp.profiles.tracer_device import Outline

wp.set_module_options({"enable_backward": False})

# A strip is cut further when the exit angle bends by more than this share of a bin between its two rays ...
_BEND = wp.constant(0.25)
# ... and as long as it is wider than this share of a strip of the first pass.
_FINEST = wp.constant(0.008)


@wp.struct
class Lines:
    """The rays of all lines, and the strips between neighbouring rays; arrays are [lines, capacity] unless said
    otherwise."""

    phi: wp.array(dtype=float)  # [lines] incidence
    x: wp.array(dtype=float, ndim=2)
    phi_o: wp.array(dtype=float, ndim=2)
    rate_x: wp.array(dtype=float, ndim=2)
    rate_phi: wp.array(dtype=float, ndim=2)
    bounces: wp.array(dtype=int, ndim=2)
    first: wp.array(dtype=int, ndim=2)  # offset of the path's cosines in the line's share of the pool
    left: wp.array(dtype=int, ndim=2)  # strip: its two rays and its share of the base line
    right: wp.array(dtype=int, ndim=2)
    width: wp.array(dtype=float, ndim=2)
    queue: wp.array(dtype=int, ndim=2)  # [lines, 3 capacity] strips that may have to be cut
    counts: wp.array(dtype=int, ndim=2)  # [lines, 3]: rays, strips, cosines
    base: int  # strips of the first pass
    bin: float  # width of an exit bin [rad]
    max_bounces: int


@wp.func
def broken(lines: Lines, line: int, left: int, right: int, width: float) -> bool:
    """Whether the exit angle does something between two neighbouring rays that a straight line between them does not
    show."""
    answer = bool(True)
    if lines.bounces[line, left] == lines.bounces[line, right]:
        change = lines.phi_o[line, right] - lines.phi_o[line, left]
        rate_left = lines.rate_x[line, left] * width
        rate_right = lines.rate_x[line, right] * width
        bend = wp.abs(change - 0.5 * (rate_left + rate_right)) + 0.125 * wp.abs(rate_right - rate_left)
        answer = bend > _BEND * lines.bin + 0.05 * wp.abs(change)
    return answer


@lru_cache(maxsize=4)
def beam_kernel(height_field: bool) -> Any:
    """Regular rays on each line, then more in the middle of strips whose two rays disagree, widest strips first."""
    follow = path_function(height_field)

    @wp.func
    def shoot(outline: Outline, lines: Lines, cosines: Cosines, line: int, ray: int, x: float, used: int) -> int:
        # rays at the very ends of the base line would graze the corner there
        inside = wp.clamp(x, 1.0e-6, 0.999999)
        phi_o, rate_x, rate_phi, bounces = follow(
            outline, inside, lines.phi[line], lines.max_bounces, cosines, line * cosines.capacity, used
        )
        lines.x[line, ray] = x
        lines.phi_o[line, ray] = phi_o
        lines.rate_x[line, ray] = rate_x
        lines.rate_phi[line, ray] = rate_phi
        lines.bounces[line, ray] = bounces
        lines.first[line, ray] = used
        return used + wp.max(bounces, 0)

    @wp.kernel(module="unique", module_options={"enable_backward": False})
    def trace_beams(start: int, outline: Outline, lines: Lines, cosines: Cosines):
        line = start + wp.tid()
        capacity = lines.x.shape[1]
        step = 1.0 / float(lines.base)
        used = int(0)
        for ray in range(lines.base + 1):
            used = shoot(outline, lines, cosines, line, ray, float(ray) * step, used)
        rays = lines.base + 1
        strips = lines.base
        tail = int(0)
        for strip in range(lines.base):
            lines.left[line, strip] = strip
            lines.right[line, strip] = strip + 1
            lines.width[line, strip] = step
            if broken(lines, line, strip, strip + 1, step):
                lines.queue[line, tail] = strip
                tail += 1
        head = int(0)
        while head < tail and rays < capacity:
            strip = lines.queue[line, head]
            head += 1
            left = lines.left[line, strip]
            right = lines.right[line, strip]
            half = 0.5 * lines.width[line, strip]
            used = shoot(outline, lines, cosines, line, rays, lines.x[line, left] + half, used)
            lines.right[line, strip] = rays
            lines.width[line, strip] = half
            lines.left[line, strips] = rays
            lines.right[line, strips] = right
            lines.width[line, strips] = half
            if half > _FINEST * step:
                if broken(lines, line, left, rays, half):
                    lines.queue[line, tail] = strip
                    tail += 1
                if broken(lines, line, rays, right, half):
                    lines.queue[line, tail] = strips
                    tail += 1
            rays += 1
            strips += 1
        lines.counts[line, 0] = rays
        lines.counts[line, 1] = strips
        lines.counts[line, 2] = used

    return trace_beams


@lru_cache(maxsize=4)
def sample_kernel(height_field: bool) -> Any:
    """Independent rays: at random entry points, or one in each of equal strips; the incidence spread over its bin.

    ``low`` and ``high`` [lines] are the sines of the edges that the incidence is drawn between, uniform in the sine
    (cosine-weighted).
    """
    follow = path_function(height_field)

    @wp.kernel(module="unique", module_options={"enable_backward": False})
    def trace_samples(
        start: int,
        outline: Outline,
        lines: Lines,
        cosines: Cosines,
        low: wp.array(dtype=float),
        high: wp.array(dtype=float),
        seed: int,
        first: int,
        stratified: int,
    ):
        line = start + wp.tid()
        count = lines.x.shape[1]
        state = wp.rand_init(seed, first + line)
        offset = wp.randf(state)
        used = int(0)
        for ray in range(count):
            u = wp.randf(state)
            v = wp.randf(state)
            x = u
            if stratified != 0:
                x = (float(ray) + u) / float(count)
                # the golden sequence, stepped so that float32 stays fine: every part of the bin meets every strip
                offset += 0.6180339887
                offset -= wp.floor(offset)
                v = offset + (v - 0.5) / float(count)
                v -= wp.floor(v)
            phi = lines.phi[line]
            if high[line] > low[line]:
                phi = wp.asin(wp.clamp(low[line] + (high[line] - low[line]) * v, -1.0, 1.0))
            phi_o, rate_x, rate_phi, bounces = follow(
                outline, wp.clamp(x, 1.0e-6, 0.999999), phi, lines.max_bounces, cosines, line * cosines.capacity, used
            )
            lines.phi_o[line, ray] = phi_o
            lines.bounces[line, ray] = bounces
            lines.first[line, ray] = used
            used += wp.max(bounces, 0)
        lines.counts[line, 0] = count
        lines.counts[line, 1] = 0
        lines.counts[line, 2] = used

    return trace_samples


@lru_cache(maxsize=4)
def ray_kernel(height_field: bool) -> Any:
    """Single rays at given entry points and incidences, one thread a ray (``trace``): line = ray, capacity 1."""
    follow = path_function(height_field)

    @wp.kernel(module="unique", module_options={"enable_backward": False})
    def trace_rays(start: int, outline: Outline, lines: Lines, cosines: Cosines):
        line = start + wp.tid()
        phi_o, rate_x, rate_phi, bounces = follow(
            outline, lines.x[line, 0], lines.phi[line], lines.max_bounces, cosines, line * cosines.capacity, 0
        )
        lines.phi_o[line, 0] = phi_o
        lines.rate_x[line, 0] = rate_x
        lines.rate_phi[line, 0] = rate_phi
        lines.bounces[line, 0] = bounces

    return trace_rays
