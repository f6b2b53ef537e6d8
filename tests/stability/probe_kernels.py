"""Device functions over rows of numbers: each kernel reads ``x[i, ...]`` and writes ``out[i, ...]``, float32 unless the
functions are of float64."""

import warp as wp

from scratchwarp.lights.cap_device import span_cap
from scratchwarp.lights.sphere_device import near_distance, sphere_one_minus_cos
from scratchwarp.lights.spherical_rect_device import edge_angle, rect_solid_angle, rect_view
from scratchwarp.optics.frames_device import frame_around, frame_with_tangent, scratch_angles
from scratchwarp.optics.fresnel_device import fresnel_conductor, fresnel_dielectric
from scratchwarp.optics.microfacets_device import ggx_d, ggx_reflection, half_vector
from scratchwarp.optics.sampling_device import cone_one_minus_cos, sample_concentric_disk, sample_cone
from scratchwarp.reflectance.cone_sums_device import sine_step
from scratchwarp.reflectance.diffraction.ellipse_device import chord, make_ellipse
from scratchwarp.reflectance.diffraction.energy_device import balanced_weights
from scratchwarp.reflectance.diffraction.faddeeva_device import damped_erf_between
from scratchwarp.reflectance.diffraction.lobe_device import lobe_integral, sinc
from scratchwarp.reflectance.diffraction.response_device import across_integral, depth_response, sinc2
from scratchwarp.reflectance.mdf.deform_device import rim_ratio
from scratchwarp.reflectance.profile_table_device import cone_direction
from scratchwarp.scratches.curves_device import overlap
from scratchwarp.scratches.lines_device import band_coverage

wp.set_module_options({"enable_backward": False})

Rows = wp.array2d(dtype=float)
Rows64 = wp.array2d(dtype=wp.float64)


@wp.func
def vector(x: wp.array2d(dtype=float), i: int, j: int) -> wp.vec3:
    """Three numbers from column j on."""
    return wp.vec3(x[i, j], x[i, j + 1], x[i, j + 2])


@wp.func
def put(out: wp.array2d(dtype=float), i: int, v: wp.vec3):
    """Three numbers into a row."""
    out[i, 0] = v[0]
    out[i, 1] = v[1]
    out[i, 2] = v[2]


@wp.kernel
def angles(x: Rows, out: Rows):
    """1 - cos, its form for a sphere, sin b - sin a, the angle of edges."""
    i = wp.tid()
    out[i, 0] = cone_one_minus_cos(x[i, 0])
    out[i, 1] = sphere_one_minus_cos(1.0, x[i, 0])
    out[i, 2] = sine_step(x[i, 1], x[i, 2])
    z = wp.cos(x[i, 0])
    m = wp.sin(x[i, 0]) * wp.sin(x[i, 0])
    out[i, 3] = edge_angle(m, -z, 0.0, 1.0)


@wp.kernel
def reach(x: Rows, out: Rows):
    """Distance to the near side of a sphere along a ray that misses its centre by x[2]."""
    i = wp.tid()
    along = wp.sqrt(x[i, 0] * x[i, 0] - x[i, 2] * x[i, 2])
    out[i, 0] = near_distance(x[i, 0], x[i, 1], along, x[i, 1] * x[i, 1] - x[i, 2] * x[i, 2])


@wp.kernel
def cap(x: Rows, out: Rows):
    """Ends of the interval in which a slice lies within a cap."""
    i = wp.tid()
    r = span_cap(
        wp.normalize(vector(x, i, 0)), x[i, 3], wp.vec3(1.0, 0.0, 0.0), wp.vec3(0.0, 1.0, 0.0), wp.vec3(0.0, 0.0, 1.0),
        x[i, 4],
    )  # fmt: skip
    out[i, 0] = r.hi - r.lo
    out[i, 1] = float(r.ok)


@wp.kernel
def rectangle(x: Rows, out: Rows):
    """Solid angle of a small rectangle, x[0] wide and high, straight above at 1."""
    i = wp.tid()
    p = wp.vec3(0.0, 0.0, 1.0)
    ex = wp.vec3(0.5 * x[i, 0], 0.0, 0.0)
    ey = wp.vec3(0.0, 0.5 * x[i, 0], 0.0)
    view = rect_view(p, ex, ey, 1.0)
    out[i, 0] = rect_solid_angle(view, p, ex, ey, 1.0, x[i, 0] * x[i, 0])


@wp.kernel
def fresnel(x: Rows, out: Rows):
    """Dielectric, conductor."""
    i = wp.tid()
    out[i, 0] = fresnel_dielectric(x[i, 0], x[i, 1])
    out[i, 1] = fresnel_conductor(x[i, 0], x[i, 1], x[i, 2])


@wp.kernel
def facets(x: Rows, out: Rows):
    """GGX's D at (x, 0, z) and its BRDF where both directions graze."""
    i = wp.tid()
    h = wp.vec3(x[i, 0], 0.0, x[i, 1])
    out[i, 0] = ggx_d(h, x[i, 2], x[i, 2])
    out[i, 1] = ggx_reflection(wp.vec3(-1.0, 0.0, x[i, 0]), wp.vec3(1.0, 0.0, x[i, 0]), h, x[i, 2], x[i, 2])


@wp.kernel
def halves(x: Rows, out: Rows):
    """Half vector."""
    i = wp.tid()
    put(out, i, half_vector(vector(x, i, 0), vector(x, i, 3)))


@wp.kernel
def frames(x: Rows, out: Rows):
    """(x axis . y axis, length of x axis, x axis . n) of a frame around a normal, and with a tangent close to it."""
    i = wp.tid()
    n = wp.normalize(vector(x, i, 0))
    f = frame_around(n)
    t = frame_with_tangent(n, vector(x, i, 3))
    out[i, 0] = wp.abs(wp.dot(f.x, f.y)) + wp.abs(wp.dot(f.x, f.n))
    out[i, 1] = wp.length(f.x)
    out[i, 2] = wp.abs(wp.dot(t.x, t.n)) + wp.abs(wp.dot(t.x, t.y))
    out[i, 3] = wp.length(t.x)


@wp.kernel
def along(x: Rows, out: Rows):
    """Scratch angles."""
    i = wp.tid()
    a = scratch_angles(vector(x, i, 0), 0.0)
    out[i, 0] = a[0]
    out[i, 1] = a[1]


@wp.kernel
def warps(x: Rows, out: Rows):
    """The square's point on the disk; radius of a point of a cone."""
    i = wp.tid()
    d = sample_concentric_disk(wp.vec2(x[i, 0], x[i, 1]))
    c = sample_cone(wp.vec2(0.5, 0.0), x[i, 2])
    out[i, 0] = d[0]
    out[i, 1] = d[1]
    out[i, 2] = c[0]


@wp.kernel
def cone(x: Rows, out: Rows):
    """A direction on a scratch's cone."""
    i = wp.tid()
    axes = wp.identity(3, dtype=float)
    put(out, i, cone_direction(axes[0], axes[1], axes[2], x[i, 0], x[i, 1]))


@wp.kernel
def narrow(x: Rows, out: Rows):
    """sinc^2, its integral, |D|^2, in the renderer's float32."""
    i = wp.tid()
    out[i, 0] = sinc2(x[i, 0])
    out[i, 1] = across_integral(x[i, 1], x[i, 2], x[i, 3])
    out[i, 2] = depth_response(x[i, 1], x[i, 2], 2.0, 0.0, 0.0)


@wp.kernel
def cover(x: Rows, out: Rows):
    """Share of a footprint in a curve's strip."""
    i = wp.tid()
    out[i, 0] = overlap(x[i, 0], x[i, 1], x[i, 2], x[i, 3])


@wp.kernel
def deform(x: Rows, out: Rows):
    """The ratio of distances to the rim."""
    i = wp.tid()
    out[i, 0] = rim_ratio(wp.vec2(x[i, 0], x[i, 1]), wp.vec2(x[i, 2], x[i, 3]))


@wp.kernel
def bands(x: Rows64, out: Rows64):
    """Share of a footprint in regular bands."""
    i = wp.tid()
    out[i, 0] = wp.float64(band_coverage(x[i, 0], x[i, 1], x[i, 2], x[i, 3]))


@wp.kernel
def waves(x: Rows64, out: Rows64):
    """sinc; M of one place less M of another; weights of dense scratches; chord of an ellipse; ends."""
    i = wp.tid()
    out[i, 0] = sinc(x[i, 0])
    a = lobe_integral(x[i, 0])
    b = lobe_integral(x[i, 1])
    half = wp.float64(1.5707963267948966)
    out[i, 1] = wp.float64(b.half - a.half) * half + (b.rest - a.rest)
    w = balanced_weights(x[i, 0], 1)
    out[i, 2] = w[1]
    out[i, 3] = chord(make_ellipse(x[i, 0], x[i, 1], x[i, 2]), x[i, 3])
    e = damped_erf_between(x[i, 0], x[i, 1], x[i, 2])
    out[i, 4] = wp.sqrt(e[0] * e[0] + e[1] * e[1])
