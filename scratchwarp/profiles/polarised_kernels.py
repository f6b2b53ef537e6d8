"""Polarisation along stored paths: the product of Jones matrices instead of the product of unpolarised reflectances.

The field across a ray d = sin(theta) u + cos(theta) d2 (d2 in the plane of the cross-section) is written in the basis
e1 = d2 turned by +90 degrees in that plane, e2 = sin(theta) d2 - cos(theta) u. At a facet with normal n the plane of
incidence meets it along (a, -sin(theta) c) before and (a, sin(theta) c) after the reflection, with c the cosine in
the plane and a = n . e1 = -+ sqrt(1 - c^2). An unpolarised beam keeps half the squared Frobenius norm of the product
(Born and Wolf, ch. 1; Jones calculus).
"""

import warp as wp

from scratchwarp.profiles.path_device import Cosines
from scratchwarp.profiles.trace_kernels import Lines

wp.set_module_options({"enable_backward": False})


@wp.struct
class Amplitudes:
    """Complex amplitude coefficients over the cosine in the plane, and the sine of theta, for each slice and
    channel."""

    table: wp.array(dtype=wp.vec4, ndim=2)  # [layers, nodes]: re r_s, im r_s, re r_p, im r_p
    sine: wp.array(dtype=float)  # [layers]


@wp.func
def rotate_into(h: wp.vec2, v: wp.vec2, x: float, y: float) -> wp.vec2:
    """h x + v y: the component of a field along (x, y), complex numbers as (re, im)."""
    return h * x + v * y


@wp.func
def complex_product(a: wp.vec2, b: wp.vec2) -> wp.vec2:
    """Product of complex numbers (re, im)."""
    return wp.vec2(a[0] * b[0] - a[1] * b[1], a[0] * b[1] + a[1] * b[0])


@wp.kernel
def reflect_polarised(
    start: int, lines: Lines, cosines: Cosines, amplitudes: Amplitudes, product: wp.array(dtype=float, ndim=3)
):
    """Reflectance of every path of a line for unpolarised light, one thread a line."""
    line = start + wp.tid()
    layers = amplitudes.table.shape[0]
    nodes = amplitudes.table.shape[1]
    for ray in range(lines.counts[line, 0]):
        base = line * cosines.capacity + lines.first[line, ray]
        for layer in range(layers):
            sine = amplitudes.sine[layer]
            # the two columns of the Jones matrix so far: fields along e1 and e2 for an input along e1, then along e2
            h1 = wp.vec2(1.0, 0.0)
            v1 = wp.vec2(0.0, 0.0)
            h2 = wp.vec2(0.0, 0.0)
            v2 = wp.vec2(1.0, 0.0)
            for bounce in range(lines.bounces[line, ray]):
                signed = cosines.value[base + bounce]
                cosine = wp.abs(signed)
                place = cosine * float(nodes - 1)
                node = wp.min(int(place), nodes - 2)
                between = place - float(node)
                lower = amplitudes.table[layer, node]
                r = lower + between * (amplitudes.table[layer, node + 1] - lower)
                r_s = wp.vec2(r[0], r[1])
                r_p = wp.vec2(r[2], r[3])
                a = wp.sqrt(wp.max(1.0 - cosine * cosine, 0.0))
                if signed > 0.0:
                    a = -a
                b = sine * cosine
                size = wp.sqrt(a * a + b * b)
                if size > 1.0e-6:
                    a = a / size
                    b = b / size
                else:
                    a = 1.0
                    b = 0.0
                # along s (b, a) and p (-a, b) before; s (-b, a) and p (-a, -b) after
                s1 = complex_product(r_s, rotate_into(h1, v1, b, a))
                p1 = complex_product(r_p, rotate_into(h1, v1, -a, b))
                s2 = complex_product(r_s, rotate_into(h2, v2, b, a))
                p2 = complex_product(r_p, rotate_into(h2, v2, -a, b))
                h1 = rotate_into(s1, p1, -b, -a)
                v1 = rotate_into(s1, p1, a, -b)
                h2 = rotate_into(s2, p2, -b, -a)
                v2 = rotate_into(s2, p2, a, -b)
            product[line, ray, layer] = 0.5 * (wp.dot(h1, h1) + wp.dot(v1, v1) + wp.dot(h2, h2) + wp.dot(v2, v2))
