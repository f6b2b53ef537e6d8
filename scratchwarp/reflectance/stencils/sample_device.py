"""Importance sampling of the stencil model, which the paper leaves open.

Each highlight is a band of half vectors about the great circle across its axis U. With s = H . U and the angle t
around U, d omega_H = ds dt, so a half vector is drawn by s with density (alpha + 1) / 2 (1 - |s|)^alpha and by t such
that on the ridge the mirrored direction has a cosine-weighted angle phi_i across the axis: t = (phi_o + phi_i) / 2. The
specular highlight is drawn by H_z^alpha, the rest by the cosine. The density is that of the mixture.
"""

import warp as wp

from ...optics.sampling_device import sample_cosine_hemisphere
from .stencil_device import Stencil, StencilMode, axis_offset, stencil_eval, stencil_half

wp.set_module_options({"enable_backward": False})

_INV_PI = wp.constant(0.3183098861837907)


@wp.struct
class StencilSample:
    """A direction, f_r cos(theta_i) / pdf and the density [1/sr]; pdf 0: nothing."""

    wi: wp.vec3
    weight: wp.vec3
    pdf: float


@wp.func
def across(mode: StencilMode, w: wp.vec3) -> float:
    """Angle of ``w`` around the axis, 0 at the normal."""
    return wp.atan2(w[1] * mode.axis[0] - w[0] * mode.axis[1], w[2])


@wp.func
def ridge_half(mode: StencilMode, wo: wp.vec3, u: wp.vec2) -> wp.vec3:
    """A half vector near the ridge of the mode."""
    left = wp.max(1.0 - wp.abs(2.0 * u[0] - 1.0), 1.0e-7)
    s = 1.0 - wp.pow(left, 1.0 / (mode.alpha + 1.0))
    s = wp.where(u[0] < 0.5, -s, s)
    t = 0.5 * (across(mode, wo) + wp.asin(wp.clamp(2.0 * u[1] - 1.0, -1.0, 1.0)))
    r = wp.sqrt(wp.max((1.0 - s) * (1.0 + s), 0.0))
    v = r * wp.sin(t)
    return wp.vec3(s * mode.axis[0] - v * mode.axis[1], s * mode.axis[1] + v * mode.axis[0], r * wp.cos(t))


@wp.func
def ridge_pdf(mode: StencilMode, wo: wp.vec3, h: wp.vec3) -> float:
    """Density of ``ridge_half`` [1/sr]."""
    s = wp.clamp(wp.abs(axis_offset(mode, h)), 0.0, 1.0)
    phi = 2.0 * across(mode, h) - across(mode, wo)
    value = float(0.0)
    if wp.abs(phi) < 0.5 * wp.pi:
        value = 0.5 * (mode.alpha + 1.0) * wp.pow(1.0 - s, mode.alpha) * wp.cos(phi)
    return value


@wp.func
def stencil_pdf(stencil: Stencil, wo: wp.vec3, wi: wp.vec3) -> float:
    """Density with which ``stencil_sample`` finds ``wi`` [1/sr]."""
    pdf = float(0.0)
    if wo[2] > 0.0 and wi[2] > 0.0:
        h = stencil_half(stencil.retro, wo, wi)
        half = float(0.0)
        for n in range(stencil.modes.shape[0]):
            half += stencil.modes[n].probability * ridge_pdf(stencil.modes[n], wo, h)
        n_s = stencil.specular_alpha
        half += stencil.p_specular * (n_s + 1.0) * 0.5 * _INV_PI * wp.pow(wp.max(h[2], 0.0), n_s)
        pdf = 0.25 * half / wp.max(wp.dot(h, wo), 1.0e-6) + stencil.p_diffuse * _INV_PI * wi[2]
    return pdf


@wp.func
def stencil_sample(stencil: Stencil, wo: wp.vec3, u: wp.vec2, u_lobe: float) -> StencilSample:
    """Draw ``wi``; ``u`` and ``u_lobe`` uniform in [0, 1), ``u_lobe`` chooses the part of the mixture."""
    s = StencilSample()
    s.wi = wp.vec3(0.0, 0.0, 1.0)
    if wo[2] > 0.0:
        if u_lobe < stencil.p_diffuse:
            s.wi = sample_cosine_hemisphere(u)
        else:
            h = wp.vec3(0.0, 0.0, 1.0)
            reached = stencil.p_diffuse + stencil.p_specular
            if u_lobe < reached:
                z = wp.pow(wp.max(1.0 - u[0], 1.0e-7), 1.0 / (stencil.specular_alpha + 1.0))
                r = wp.sqrt(wp.max((1.0 - z) * (1.0 + z), 0.0))
                angle = 2.0 * wp.pi * u[1]
                h = wp.vec3(r * wp.cos(angle), r * wp.sin(angle), z)
            else:
                chosen = int(0)
                for n in range(stencil.modes.shape[0] - 1):
                    reached += stencil.modes[n].probability
                    if u_lobe >= reached:
                        chosen = n + 1
                h = ridge_half(stencil.modes[chosen], wo, u)
            facing = wp.dot(h, wo)
            s.wi = wp.vec3(0.0, 0.0, -1.0)
            if facing > 0.0:
                s.wi = wp.normalize(2.0 * facing * h - wo)
                if stencil.retro == 1:
                    s.wi = wp.vec3(-s.wi[0], -s.wi[1], s.wi[2])
        s.pdf = stencil_pdf(stencil, wo, s.wi)
        if s.pdf > 0.0:
            s.weight = (s.wi[2] / s.pdf) * stencil_eval(stencil, wo, s.wi)
    return s
