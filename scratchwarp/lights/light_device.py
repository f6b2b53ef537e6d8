"""What every light's device functions take and return.

A light kind ``k`` gives three functions::

    sample_k(arrays, light, x, u) -> LightSample             a direction towards the light from x, by u in [0, 1)^2
    hit_k(arrays, light, x, w) -> LightHit                   the light along the unit direction w
    span_k(arrays, light, x, u, v, n, sin_theta) -> Span     where a scratch cone may meet it

``x`` is in metres relative to the scene's origin. Radiance is linear Rec.709 and already holds texture and shaping;
the multipliers ``diffuse`` and ``specular``, links and shadows are the integrator's.
"""

import warp as wp

from scratchwarp.reflectance.texture_device import TextureAtlas

FAR = wp.constant(1.0e10)  # distance of lights at infinity [m]
MOST_PDF = wp.constant(1.0e18)  # [1/sr]; squared it still fits float32, and what it cuts off is 1e-18 of a radiance


@wp.struct
class Light:
    """One light of any kind; the kinds' files say what they use.

    Attributes:
        center: position [m]; distant: unit direction towards the light.
        ex, ey: half-edge or half-axis vectors [m]; dome: axes, unit.
        ez: unit emission axis (the normal of rect and disk).
        rx, ry: reciprocal to ex, ey within their plane [1/m]: rx.ex = 1, rx.ey = 0.
        radius [m]; half_length [m]; half_angle [rad].
        size: area [m^2]; distant: solid angle [sr]. 0 for lights without extent.
        delta: 1 for lights without extent (``radiance`` is irradiance or intensity).
        radiance: linear Rec.709.
        texture: image in the atlas, -1 none. rows, columns: cells of a dome's distribution.
        first_level, levels: a dome's smaller copies of its image in the atlas, each half the size of the one before.
        shaped: 1 when focus, focus_tint, cone_angle, cone_start [rad] apply.
        first, count: triangles of a mesh light; first: start of its or the dome's distribution is ``cdf``.
        diffuse, specular, shadow, shadow_color, shadow_distance: as in the record.
        link, shadow_link: -1 all instances, else ``index``. index: position in ``Scene.lights``.
        camera_visible: 1 when camera rays see it.
    """

    center: wp.vec3
    ex: wp.vec3
    ey: wp.vec3
    ez: wp.vec3
    rx: wp.vec3
    ry: wp.vec3
    radiance: wp.vec3
    radius: float
    half_length: float
    half_angle: float
    size: float
    delta: int
    texture: int
    rows: int
    columns: int
    first_level: int
    levels: int
    shaped: int
    focus: float
    focus_tint: wp.vec3
    cone_angle: float
    cone_start: float
    first: int
    count: int
    cdf: int
    diffuse: float
    specular: float
    shadow: int
    shadow_color: wp.vec3
    shadow_distance: float
    link: int
    shadow_link: int
    index: int
    camera_visible: int


@wp.struct
class LightArrays:
    """Data that lights share: ``cdf`` cumulative distributions of domes and meshes, ``triangles`` corners of mesh
    lights (three each) [m], ``atlas`` their textures."""

    cdf: wp.array[float]
    triangles: wp.array[wp.vec3]
    atlas: TextureAtlas


@wp.struct
class LightSample:
    """``wi`` unit, towards the light; ``distance`` [m]; ``pdf`` [1/sr], 0: nothing was sampled. A light without extent
    has pdf -1 and ``radiance`` holds its irradiance on a plane across ``wi``, so that it adds f cos ``radiance``."""

    wi: wp.vec3
    distance: float
    radiance: wp.vec3
    pdf: float


@wp.struct
class LightHit:
    """``distance`` [m], negative: missed; ``radiance``; ``pdf`` [1/sr] with which ``sample`` picks this direction."""

    distance: float
    radiance: wp.vec3
    pdf: float


@wp.struct
class Span:
    """Interval of phi in [-pi/2, pi/2] outside of which the light does not meet the scratch cone; ok 0: nowhere."""

    lo: float
    hi: float
    ok: int


@wp.func
def no_sample() -> LightSample:
    """Nothing sampled: pdf 0, a finite direction."""
    s = LightSample()
    s.wi = wp.vec3(0.0, 0.0, 1.0)
    return s


@wp.func
def no_hit() -> LightHit:
    """Missed."""
    h = LightHit()
    h.distance = -1.0
    return h


@wp.func
def shaped_radiance(light: Light, w: wp.vec3) -> wp.vec3:
    """Radiance that leaves the light towards x, seen from x along ``w``: UsdLux ShapingAPI's focus and cone."""
    result = light.radiance
    if light.shaped != 0:
        cosine = -wp.dot(w, light.ez)
        if light.focus > 0.0:
            weight = wp.pow(wp.max(wp.abs(cosine), 1.0e-12), light.focus)
            tint = light.focus_tint + weight * (wp.vec3(1.0, 1.0, 1.0) - light.focus_tint)
            result = wp.cw_mul(result, tint)
        off_axis = wp.atan2(wp.length(wp.cross(w, light.ez)), cosine)
        if off_axis > light.cone_angle:
            result = wp.vec3(0.0, 0.0, 0.0)
        elif off_axis > light.cone_start:
            t = (off_axis - light.cone_start) / wp.max(light.cone_angle - light.cone_start, 1.0e-7)
            t = wp.min(t, 1.0)
            result = (1.0 - t * t * (3.0 - 2.0 * t)) * result
    return result
