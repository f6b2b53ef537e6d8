"""As ``probe_kernels``: pieces of scratches under a footprint, pairs of them, fringes under the sun, grooves that
change along themselves, glass."""

import warp as wp

from scratchwarp.kernels.glint_arrays_device import GlintArrays, WaveLayer
from scratchwarp.kernels.glint_fringes_device import fringes_of
from scratchwarp.kernels.glint_pairs_device import across_amplitude, sinc
from scratchwarp.kernels.glint_stretch_device import between
from scratchwarp.optics.refraction_device import refract
from scratchwarp.reflectance.grooves.solid_device import GrooveSet, Piece
from scratchwarp.reflectance.grooves.taper_device import meets_facet

wp.set_module_options({"enable_backward": False})

Rows = wp.array2d(dtype=float)
Rows64 = wp.array2d(dtype=wp.float64)


@wp.kernel
def pairs(x: Rows, out: Rows, arrays: GlintArrays):
    """What a Gaussian holds between two ends, its variance there; sinc; Re and Im of a rectangle's amplitude."""
    i = wp.tid()
    held = between(x[i, 0], x[i, 1])
    out[i, 0] = held.part
    out[i, 1] = held.variance
    out[i, 2] = sinc(x[i, 0])
    layer = WaveLayer()
    amplitude = across_amplitude(arrays, layer, 1.0, x[i, 0], x[i, 1], 0.0, 2.0)
    out[i, 3] = amplitude[0]


@wp.kernel
def fringes(x: Rows, out: Rows, table: wp.array3d(dtype=wp.vec3)):
    """Green of a scratch of width x[0], depth x[1] at xi_2 = x[2]."""
    i = wp.tid()
    out[i, 0] = fringes_of(table, 0, x[i, 0], x[i, 1], x[i, 2])[1]


@wp.kernel
def tapers(x: Rows64, out: Rows64, grooves: GrooveSet):
    """Where the ray (x[0], x[1], x[2]) + t (x[3], 0, x[4]), along the piece and across it swapped, meets a facet of a
    piece along x whose profile grows by the set's first taper."""
    i = wp.tid()
    piece = Piece()
    zero = wp.float64(0.0)
    one = wp.float64(1.0)
    piece.along = wp.vec2d(one, zero)
    piece.across = wp.vec2d(zero, one)
    piece.taper = 0
    out[i, 0] = meets_facet(
        grooves, piece, wp.vec2d(-one, zero), wp.vec2d(wp.float64(2.0), -one), wp.vec2d(x[i, 0], x[i, 1]),
        wp.vec2d(x[i, 3], x[i, 4]), x[i, 2], -one, one,
    )  # fmt: skip


@wp.kernel
def refraction(x: Rows, out: Rows):
    """Cosine of the direction refracted from (sqrt(1 - x[0]^2), 0, x[0]) into a medium of index x[1]."""
    i = wp.tid()
    c = x[i, 0]
    o = wp.vec3(wp.sqrt((1.0 - c) * (1.0 + c)), 0.0, c)
    out[i, 0] = -refract(o, wp.vec3(0.0, 0.0, 1.0), c, x[i, 1])[2]
