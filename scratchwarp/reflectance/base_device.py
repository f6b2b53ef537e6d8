"""The base reflectance under the scratches: Lambert, GGX over Schlick or measured Fresnel, clearcoat.

Directions are unit, in the frame n = +z, x along ``alpha_x``. ``base_eval`` is f_r cos(theta_i) [1/sr]; ``base_pdf``
and the density of ``base_sample`` are per solid angle. ``w_diffuse`` and ``w_specular`` scale the diffuse lobe and the
specular and clearcoat lobes, in the value and in the choice of lobe (1, 1 is the base itself).

Energy. Each specular lobe has an upper bound T(cos) of its directional albedo (``base_energy_device``), exact where the
lobe is smooth. The diffuse lobe is albedo / pi (1 - T(o)) (1 - T(i)) / (1 - mean T): reciprocal, at most 1 with the
specular lobe, exactly 1 for a white albedo under a smooth interface. A coat leaves 1 - max(T(o), T(i)) of what is below
it: reciprocal, at most 1 in all, exactly 1 for a smooth coat over a mirror.

Lobes narrower than ``DELTA_ALPHA`` are perfect mirrors: ``base_eval`` and ``base_pdf`` leave them out, ``base_sample``
says so by ``delta``. A lobe is chosen in proportion to its weight times the share of light, mean over channels, that T
lets it reflect; all densities include that probability.

Sources: UsdPreviewSurface specification 2.6 (parameters, F0 and F90); Shirley et al. 1997 and Kelemen and Szirmay-Kalos
2001 (coupled diffuse lobe); Walter et al. 2007; Heitz 2014, 2018.
"""

import warp as wp

from ..optics.fresnel_device import (
    fresnel_conductor_rgb,
    fresnel_dielectric,
    fresnel_schlick_f90,
    fresnel_schlick_scalar,
)
from ..optics.microfacets_device import (
    ggx_reflection,
    ggx_reflection_pdf,
    ggx_reflection_weight,
    ggx_sample_visible,
    half_vector,
    mirrored,
)
from ..optics.sampling_device import sample_cosine_hemisphere
from .base_energy_device import bound_at, bound_mean, bound_shape

wp.set_module_options({"enable_backward": False})

SCHLICK = wp.constant(0)
CONDUCTOR = wp.constant(1)
DIELECTRIC = wp.constant(2)
DELTA_ALPHA = wp.constant(1.0e-3)
_LEAST_ALPHA = wp.constant(1.0e-4)
_INV_PI = wp.constant(0.3183098861837907)


@wp.struct
class Base:
    """Parameters at a shading point. ``fresnel``: SCHLICK (f0, f90), CONDUCTOR (eta, k; no diffuse), DIELECTRIC (ior).

    ``specular`` scales the specular lobe, 0 leaves Lambert alone; ``clearcoat`` is the amount of a white coat of
    roughness
    ``clearcoat_alpha`` and normal reflectance ``clearcoat_f0``.
    """

    diffuse: wp.vec3
    f0: wp.vec3
    f90: wp.vec3
    eta: wp.vec3
    k: wp.vec3
    fresnel: int
    ior: float
    alpha_x: float
    alpha_y: float
    specular: float
    clearcoat: float
    clearcoat_alpha: float
    clearcoat_f0: float


@wp.struct
class BaseTerms:
    """Value (f_r cos(theta_i)) and density of the lobes that are not delta, for one pair of directions."""

    value: wp.vec3
    pdf: float


@wp.struct
class BaseSample:
    """A direction; ``weight`` = f_r cos(theta_i) / pdf; ``delta`` 1: mirror of probability ``pdf``; pdf 0: nothing."""

    wi: wp.vec3
    weight: wp.vec3
    pdf: float
    delta: int


@wp.struct
class BaseLobes:
    """What depends on the view alone: probabilities of the lobes and the view's side of the energy balance."""

    p_diffuse: float
    p_specular: float
    p_clearcoat: float
    delta_specular: int
    delta_clearcoat: int
    alpha_x: float
    alpha_y: float
    clearcoat_alpha: float
    shape: wp.vec3  # of the bound of the specular lobe
    f0: wp.vec3  # normal and grazing reflectance in the bound
    f90: wp.vec3
    left: wp.vec3  # 1 - T(o)
    albedo: wp.vec3  # diffuse (1 - T(o)) / (1 - mean T)
    clearcoat_shape: wp.vec3
    clearcoat_bound: float  # T(o) of the coat, its amount included


@wp.func
def mean3(v: wp.vec3) -> float:
    """Mean of three channels."""
    return (v[0] + v[1] + v[2]) / 3.0


@wp.func
def base_fresnel(b: Base, cos_theta: float) -> wp.vec3:
    """Reflectance of a facet of the specular lobe."""
    result = wp.vec3(0.0, 0.0, 0.0)
    if b.fresnel == CONDUCTOR:
        result = fresnel_conductor_rgb(cos_theta, b.eta, b.k)
    elif b.fresnel == DIELECTRIC:
        f = fresnel_dielectric(cos_theta, b.ior)
        result = wp.vec3(f, f, f)
    else:
        result = fresnel_schlick_f90(cos_theta, b.f0, b.f90)
    return b.specular * result


@wp.func
def specular_left(lobes: BaseLobes, specular: float, g: float) -> wp.vec3:
    """1 - T, what the specular lobe leaves to the diffuse one, where the share of grazing reflectance is ``g``."""
    return wp.vec3(1.0, 1.0, 1.0) - specular * (lobes.f0 + g * (lobes.f90 - lobes.f0))


@wp.func
def clearcoat_bound(b: Base, shape: wp.vec3, cos_theta: float) -> float:
    """Upper bound of the directional albedo of the coat, its amount included."""
    return b.clearcoat * (b.clearcoat_f0 + bound_at(shape, cos_theta) * (1.0 - b.clearcoat_f0))


@wp.func
def base_lobes(b: Base, wo: wp.vec3, w_diffuse: float, w_specular: float) -> BaseLobes:
    """Prepare the lobes for a view ``wo`` above the horizon."""
    lobes = BaseLobes()
    lobes.alpha_x = wp.max(b.alpha_x, _LEAST_ALPHA)
    lobes.alpha_y = wp.max(b.alpha_y, _LEAST_ALPHA)
    lobes.clearcoat_alpha = wp.max(b.clearcoat_alpha, _LEAST_ALPHA)
    lobes.delta_specular = wp.where(wp.max(b.alpha_x, b.alpha_y) < DELTA_ALPHA, 1, 0)
    lobes.delta_clearcoat = wp.where(b.clearcoat_alpha < DELTA_ALPHA, 1, 0)
    c = wp.clamp(wo[2], 0.0, 1.0)
    if b.clearcoat > 0.0:
        lobes.clearcoat_shape = bound_shape(wp.where(lobes.delta_clearcoat == 1, 0.0, b.clearcoat_alpha), False)
        lobes.clearcoat_bound = clearcoat_bound(b, lobes.clearcoat_shape, c)
    below = 1.0 - lobes.clearcoat_bound
    lobes.left = wp.vec3(1.0, 1.0, 1.0)
    lobes.albedo = b.diffuse
    specular = float(0.0)
    if b.specular > 0.0:
        if b.fresnel == CONDUCTOR:
            lobes.left = wp.vec3(0.0, 0.0, 0.0)
            lobes.albedo = lobes.left
            specular = mean3(base_fresnel(b, c))
        else:
            lobes.f0 = b.f0
            lobes.f90 = b.f90
            if b.fresnel == DIELECTRIC:
                r = (b.ior - 1.0) / (b.ior + 1.0)
                # below 1 there is total reflection: leave nothing to the diffuse lobe
                r2 = wp.where(b.ior < 1.0, 1.0, r * r)
                lobes.f0 = wp.vec3(r2, r2, r2)
                lobes.f90 = wp.vec3(1.0, 1.0, 1.0)
            alpha = wp.where(lobes.delta_specular == 1, 0.0, wp.min(b.alpha_x, b.alpha_y))
            lobes.shape = bound_shape(alpha, b.fresnel == DIELECTRIC)
            lobes.left = specular_left(lobes, b.specular, bound_at(lobes.shape, c))
            mean = specular_left(lobes, b.specular, bound_mean(lobes.shape))
            mean = wp.vec3(wp.max(mean[0], 1.0e-4), wp.max(mean[1], 1.0e-4), wp.max(mean[2], 1.0e-4))
            lobes.albedo = wp.cw_mul(b.diffuse, wp.cw_div(lobes.left, mean))
            specular = 1.0 - mean3(lobes.left)
            if lobes.delta_specular == 0:
                # a floor: turned facets reflect a little where the bound at the normal is 0
                specular += 0.01 * b.specular * mean3(lobes.f90)
    diffuse = w_diffuse * below * mean3(wp.cw_mul(b.diffuse, lobes.left))
    specular = w_specular * below * specular
    clearcoat = w_specular * lobes.clearcoat_bound
    total = diffuse + specular + clearcoat
    if total > 0.0:
        # quotients, not a common factor: a lobe that is alone has probability 1 exactly
        lobes.p_diffuse = diffuse / total
        lobes.p_specular = specular / total
        lobes.p_clearcoat = clearcoat / total
    return lobes


@wp.func
def base_terms(b: Base, lobes: BaseLobes, wo: wp.vec3, wi: wp.vec3, w_diffuse: float, w_specular: float) -> BaseTerms:
    """Value and density of all lobes that are not delta; both directions above the horizon, else 0."""
    t = BaseTerms()
    if wo[2] <= 0.0 or wi[2] <= 0.0:
        return t
    ci = wp.min(wi[2], 1.0)
    below = float(1.0)
    h = half_vector(wo, wi)
    if b.clearcoat > 0.0:
        below = 1.0 - wp.max(lobes.clearcoat_bound, clearcoat_bound(b, lobes.clearcoat_shape, ci))
        if lobes.delta_clearcoat == 0:
            a = lobes.clearcoat_alpha
            coat = b.clearcoat * fresnel_schlick_scalar(wp.dot(wo, h), b.clearcoat_f0)
            coat = w_specular * coat * ggx_reflection(wo, wi, h, a, a) * ci
            t.value += wp.vec3(coat, coat, coat)
            t.pdf += lobes.p_clearcoat * ggx_reflection_pdf(wo, h, a, a)
    if b.specular > 0.0 and lobes.delta_specular == 0:
        lobe = w_specular * below * ggx_reflection(wo, wi, h, lobes.alpha_x, lobes.alpha_y) * ci
        t.value += lobe * base_fresnel(b, wp.dot(wo, h))
        t.pdf += lobes.p_specular * ggx_reflection_pdf(wo, h, lobes.alpha_x, lobes.alpha_y)
    if lobes.p_diffuse > 0.0:
        albedo = lobes.albedo
        if b.specular > 0.0:
            albedo = wp.cw_mul(albedo, specular_left(lobes, b.specular, bound_at(lobes.shape, ci)))
        t.value += (w_diffuse * below * (_INV_PI * ci)) * albedo
        t.pdf += lobes.p_diffuse * (_INV_PI * ci)
    return t


@wp.func
def base_eval_pdf(b: Base, wo: wp.vec3, wi: wp.vec3, w_diffuse: float, w_specular: float) -> BaseTerms:
    """``base_eval`` and ``base_pdf`` for the price of one."""
    return base_terms(b, base_lobes(b, wo, w_diffuse, w_specular), wo, wi, w_diffuse, w_specular)


@wp.func
def base_eval(b: Base, wo: wp.vec3, wi: wp.vec3, w_diffuse: float, w_specular: float) -> wp.vec3:
    """f_r cos(theta_i) [1/sr] of the lobes that are not delta."""
    return base_eval_pdf(b, wo, wi, w_diffuse, w_specular).value


@wp.func
def base_pdf(b: Base, wo: wp.vec3, wi: wp.vec3, w_diffuse: float, w_specular: float) -> float:
    """Density [1/sr] with which ``base_sample`` finds ``wi`` by a lobe that is not delta."""
    return base_eval_pdf(b, wo, wi, w_diffuse, w_specular).pdf


@wp.func
def base_sample(b: Base, wo: wp.vec3, u: wp.vec2, u_lobe: float, w_diffuse: float, w_specular: float) -> BaseSample:
    """Sample a direction in proportion to the lobes; ``u`` and ``u_lobe`` uniform in [0, 1)."""
    s = BaseSample()
    s.wi = wp.vec3(0.0, 0.0, 1.0)
    if wo[2] <= 0.0:
        return s
    lobes = base_lobes(b, wo, w_diffuse, w_specular)
    if lobes.p_diffuse + lobes.p_specular + lobes.p_clearcoat <= 0.0:
        return s
    c = wp.min(wo[2], 1.0)
    mirror = wp.vec3(-wo[0], -wo[1], wo[2])
    if u_lobe < lobes.p_diffuse:
        s.wi = sample_cosine_hemisphere(u)
    elif u_lobe < lobes.p_diffuse + lobes.p_specular:
        if lobes.delta_specular == 1:
            s.wi = mirror
            s.delta = 1
            s.pdf = lobes.p_specular
            s.weight = (w_specular * (1.0 - lobes.clearcoat_bound) / wp.max(s.pdf, 1.0e-30)) * base_fresnel(b, c)
        else:
            s.wi = mirrored(wo, ggx_sample_visible(wo, lobes.alpha_x, lobes.alpha_y, u))
    else:
        a = lobes.clearcoat_alpha
        if lobes.delta_clearcoat == 1:
            s.wi = mirror
            s.delta = 1
            s.pdf = lobes.p_clearcoat
            # a smooth coat reflects exactly its bound
            f = w_specular * lobes.clearcoat_bound / wp.max(s.pdf, 1.0e-30)
            s.weight = wp.vec3(f, f, f)
        else:
            s.wi = mirrored(wo, ggx_sample_visible(wo, a, a, u))
    if s.delta == 0 and s.wi[2] > 0.0:
        if lobes.p_specular == 1.0:
            # alone: the distribution cancels and only Fresnel, masking and shadowing are left
            h = half_vector(wo, s.wi)
            s.pdf = ggx_reflection_pdf(wo, h, lobes.alpha_x, lobes.alpha_y)
            ratio = ggx_reflection_weight(wo, s.wi, lobes.alpha_x, lobes.alpha_y)
            s.weight = (w_specular * ratio) * base_fresnel(b, wp.dot(wo, h))
        else:
            t = base_terms(b, lobes, wo, s.wi, w_diffuse, w_specular)
            s.pdf = t.pdf
            s.weight = t.value / wp.max(t.pdf, 1.0e-30)
    return s


@wp.func
def base_albedo(b: Base, wo: wp.vec3) -> wp.vec3:
    """Estimate of the directional albedo, for display and for weighing layers: the energy bounds taken as values."""
    lobes = base_lobes(b, wo, 1.0, 1.0)
    result = wp.vec3(1.0, 1.0, 1.0) - lobes.left
    if b.specular > 0.0 and b.fresnel == CONDUCTOR:
        result = base_fresnel(b, wp.clamp(wo[2], 0.0, 1.0))
    result += wp.cw_mul(b.diffuse, lobes.left)
    coat = lobes.clearcoat_bound
    return (1.0 - coat) * result + wp.vec3(coat, coat, coat)


@wp.func
def preview_surface(
    diffuse: wp.vec3,
    metallic: float,
    specular_workflow: int,
    specular_color: wp.vec3,
    roughness: float,
    ior: float,
    clearcoat: float,
    clearcoat_roughness: float,
) -> Base:
    """The lobes of a UsdPreviewSurface; colours in [0, 1], the others as the specification says; alpha = roughness^2.

    Metallic workflow: with R = (1 - ior) / (1 + ior) and tint = mix(white, diffuse, metallic), F90 is the tint and F0 =
    mix(R^2 tint, tint, metallic); the diffuse albedo is diffuse (1 - metallic). Specular workflow: F0 = specular_color,
    F90 white. The coat is white with F0 = R^2.
    """
    b = Base()
    one = wp.vec3(1.0, 1.0, 1.0)
    r = (1.0 - ior) / wp.max(1.0 + ior, 1.0e-6)
    r2 = wp.min(r * r, 1.0)
    if specular_workflow != 0:
        b.diffuse = diffuse
        b.f0 = specular_color
        b.f90 = one
    else:
        b.diffuse = (1.0 - metallic) * diffuse
        b.f90 = one + metallic * (diffuse - one)
        b.f0 = (r2 + metallic * (1.0 - r2)) * b.f90
    b.fresnel = SCHLICK
    b.ior = ior
    b.alpha_x = roughness * roughness
    b.alpha_y = b.alpha_x
    b.specular = 1.0
    b.clearcoat = clearcoat
    b.clearcoat_alpha = clearcoat_roughness * clearcoat_roughness
    b.clearcoat_f0 = r2
    return b
