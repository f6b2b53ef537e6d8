"""An isotropic BRDF in the half and difference angles of MERL (Matusik et al. 2003), interpolated on the device.

Entry (h, d, p) of the table lies at theta_half = (h / 90)^2 90 degrees, theta_diff = d degrees, phi_diff = p degrees;
phi_diff is periodic by 180 degrees (reciprocity). Linear between entries, held after the last.
"""

import warp as wp

from ...optics.microfacets_device import half_vector

wp.set_module_options({"enable_backward": False})

_HALVES = wp.constant(90)
_DIFFERENCES = wp.constant(90)
_PHIS = wp.constant(180)


@wp.struct
class MerlBrdf:
    """``values [theta_half, theta_diff, phi_diff]``, scaled, not negative, linear Rec.709 [1/sr]."""

    values: wp.array3d(dtype=wp.vec3)


@wp.func
def merl_line(brdf: MerlBrdf, h: int, d: int, p: float) -> wp.vec3:
    """Interpolated in phi_diff, given in entries."""
    low = int(p) % _PHIS
    f = wp.clamp(p - wp.floor(p), 0.0, 1.0)
    return (1.0 - f) * brdf.values[h, d, low] + f * brdf.values[h, d, (low + 1) % _PHIS]


@wp.func
def merl_eval(brdf: MerlBrdf, wi: wp.vec3, wo: wp.vec3) -> wp.vec3:
    """f_r [1/sr] for directions above the horizon."""
    h = half_vector(wo, wi)
    sine = wp.sqrt(h[0] * h[0] + h[1] * h[1])
    c = wp.where(sine > 0.0, h[0] / wp.max(sine, 1.0e-30), 1.0)
    s = wp.where(sine > 0.0, h[1] / wp.max(sine, 1.0e-30), 0.0)
    # the light seen from the half vector: turned by -phi_half about z, then by -theta_half about y
    along = c * wi[0] + s * wi[1]
    dx = h[2] * along - sine * wi[2]
    dy = c * wi[1] - s * wi[0]
    dz = sine * along + h[2] * wi[2]
    half = wp.sqrt(wp.atan2(sine, h[2]) / (0.5 * wp.pi)) * float(_HALVES)
    difference = wp.atan2(wp.sqrt(dx * dx + dy * dy), dz) / (0.5 * wp.pi) * float(_DIFFERENCES)
    p = wp.atan2(dy, dx) / wp.pi
    p = (p - wp.floor(p)) * float(_PHIS)
    half = wp.min(half, float(_HALVES - 1))
    difference = wp.min(difference, float(_DIFFERENCES - 1))
    ih = wp.clamp(int(half), 0, _HALVES - 2)
    it = wp.clamp(int(difference), 0, _DIFFERENCES - 2)
    fh = half - float(ih)
    ft = difference - float(it)
    near = (1.0 - ft) * merl_line(brdf, ih, it, p) + ft * merl_line(brdf, ih, it + 1, p)
    far = (1.0 - ft) * merl_line(brdf, ih + 1, it, p) + ft * merl_line(brdf, ih + 1, it + 1, p)
    return (1.0 - fh) * near + fh * far
