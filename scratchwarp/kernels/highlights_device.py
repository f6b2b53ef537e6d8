"""Highlights smaller than a pixel: each sample of a pixel that has some brings another one, drawn near one of them.

A small light in a polished surface that bends is seen in a spot of which few samples of a pixel would meet anything.
Where the half vector's slope from the shading normal is zero, a lobe of GGX alpha s, widened by the light, falls off as
1 / (1 + slope^2 / s^2)^2. So are positions drawn here, the slope taken as linear in them:
q = share / (pi |a x b| (1 + x^2 + y^2)^2) with the position center + x a + y b, summed over a pixel's
highlights. Both samples of a pair have weight f / (f + q), f the density of the pixel filter: the balance heuristic of
Veach and Guibas 1995, right in the mean whatever q is.
"""

import warp as wp

from ..optics.filters_device import (
    filter_density_blackman_harris,
    filter_density_box,
    filter_density_gaussian,
    filter_offset_blackman_harris,
    filter_offset_box,
    filter_offset_gaussian,
)
from ..optics.frames_device import frame_with_tangent
from ..optics.hash_device import pcg_hash
from ..optics.sobol_device import sobol_1d, sobol_2d
from .camera_device import CameraData

wp.set_module_options({"enable_backward": False})

FILTERS = {
    "box": (filter_offset_box, filter_density_box),
    "gaussian": (filter_offset_gaussian, filter_density_gaussian),
    "blackmanHarris": (filter_offset_blackman_harris, filter_density_blackman_harris),
}
NEAR_THEM = 0x5D4E9A27  # of the seed of the samples near highlights
ROW = 1 << 24
"""A pixel's number is ROW times its line plus its column."""


@wp.struct
class Highlight:
    """``center`` from that of the pixel, ``a`` and ``b``: where units of either slope lead [pixels]; ``share`` of the
    pixel's additional samples; ``top``: their density at the center [1 / pixel^2]."""

    center: wp.vec2
    a: wp.vec2
    b: wp.vec2
    share: float
    top: float


@wp.struct
class HighlightArrays:
    """``pixels``: numbers of those that have any, ascending; the k-th has those from ``starts[k]`` to
    ``starts[k + 1]``."""

    pixels: wp.array(dtype=wp.int64)
    starts: wp.array(dtype=int)
    highlights: wp.array(dtype=Highlight)


@wp.func
def highlights_of(h: HighlightArrays, px: int, py: int) -> wp.vec2i:
    """First and past the last highlight of a pixel of the image."""
    number = wp.int64(py) * wp.int64(wp.static(ROW)) + wp.int64(px)
    low = int(0)
    high = h.pixels.shape[0]
    while low < high:
        middle = (low + high) / 2
        if h.pixels[middle] < number:
            low = middle + 1
        else:
            high = middle
    found = wp.vec2i(0, 0)
    if low < h.pixels.shape[0]:
        if h.pixels[low] == number:
            found = wp.vec2i(h.starts[low], h.starts[low + 1])
    return found


@wp.func
def highlight_offset(h: HighlightArrays, which: wp.vec2i, u: wp.vec2, pick: float) -> wp.vec2:
    """Position from the pixel's center, by ``u`` and ``pick`` in [0, 1)."""
    k = which[0]
    left = pick - h.highlights[k].share
    while left >= 0.0 and k + 1 < which[1]:
        k += 1
        left -= h.highlights[k].share
    one = h.highlights[k]
    r = wp.sqrt(u[0] / wp.max(1.0 - u[0], 1.0e-6))
    angle = 2.0 * wp.pi * u[1]
    return one.center + (r * wp.cos(angle)) * one.a + (r * wp.sin(angle)) * one.b


@wp.func
def highlight_density(h: HighlightArrays, which: wp.vec2i, at: wp.vec2) -> float:
    """Density of ``highlight_offset`` [1 / pixel^2]."""
    total = float(0.0)
    for k in range(which[0], which[1]):
        one = h.highlights[k]
        d = at - one.center
        area = one.a[0] * one.b[1] - one.a[1] * one.b[0]
        y = (one.a[0] * d[1] - one.a[1] * d[0]) / area
        x = (d[0] * one.b[1] - d[1] * one.b[0]) / area
        fall = 1.0 + x * x + y * y
        total += one.top / (fall * fall)
    return total


@wp.struct
class Place:
    """Where a sample lies: ``at`` from the pixel's center, its ``weight``, number and seed. ``extra`` 1: it is the
    second of a pair, near a highlight."""

    at: wp.vec2
    weight: float
    index: wp.uint32
    seed: wp.uint32
    extra: int


def make_place(filter_name: str, highlights: bool):
    """Device function: the place of sample ``turn`` after ``first`` of a pixel, pairs counted twice."""
    filter_offset, filter_density = FILTERS[filter_name]

    @wp.func
    def place_of(h: HighlightArrays, near: wp.vec2i, first: int, turn: int, seed: wp.uint32, width: float) -> Place:
        r = Place()
        r.index = wp.uint32(first + turn)
        r.seed = seed
        r.weight = 1.0
        if wp.static(highlights):
            if near[1] > near[0]:
                r.extra = turn % 2
                r.index = wp.uint32(first + turn / 2)
                r.seed = wp.where(r.extra == 1, pcg_hash(seed ^ wp.uint32(wp.static(NEAR_THEM))), seed)
        u = sobol_2d(r.index, 0, r.seed)
        r.at = filter_offset(u, width)
        if wp.static(highlights):
            if near[1] > near[0]:
                if r.extra == 1:
                    r.at = highlight_offset(h, near, u, sobol_1d(r.index, 0, r.seed))
                f = filter_density(r.at, width)
                r.weight = f / wp.max(f + highlight_density(h, near, r.at), 1.0e-30)
        return r

    return place_of


@wp.func
def slope_off(h: wp.vec3, normal: wp.vec3, n: wp.vec3, x: wp.vec3, y: wp.vec3) -> wp.vec3:
    """Slope of ``h`` less that of ``normal`` in the frame (x, y, n); z 0 where either lies too low."""
    up = wp.dot(normal, n)
    across = wp.dot(h, n)
    r = wp.vec3(0.0, 0.0, 0.0)
    if up > 0.05 and across > 0.05:
        r = wp.vec3(wp.dot(h, x) / across - wp.dot(normal, x) / up, wp.dot(h, y) / across - wp.dot(normal, y) / up, 1.0)
    return r


@wp.kernel
def promising(
    points: wp.array(dtype=wp.vec3),
    normals: wp.array(dtype=wp.vec3),
    alpha: wp.array(dtype=float),
    lamp: wp.vec3,
    radius: float,
    distant: int,
    camera: CameraData,
    orthographic: int,
    size: wp.vec2,
    widest: float,
    largest: float,
    kept: wp.array(dtype=int),
):
    """Which triangles may have highlights smaller than ``largest`` pixels, of lights of sines up to ``widest``; as
    ``highlight_search`` has it, in haste."""
    i = wp.tid()
    a = alpha[i]
    if a > 1.0e3:
        return
    middle = (points[3 * i] + points[3 * i + 1] + points[3 * i + 2]) / 3.0
    n = wp.normalize(normals[3 * i] + normals[3 * i + 1] + normals[3 * i + 2])
    viewer = camera.back
    if orthographic == 0:
        viewer = wp.normalize(camera.position - middle)
    side = wp.where(wp.dot(n, viewer) < 0.0, -1.0, 1.0)
    n = side * n
    sine = wp.sin(radius)
    if distant == 0:
        sine = radius / wp.max(wp.length(lamp - middle), 1.0e-20)
    frame = frame_with_tangent(n, wp.where(wp.abs(n[0]) < 0.7, wp.vec3(1.0, 0.0, 0.0), wp.vec3(0.0, 1.0, 0.0)))
    slopes = wp.mat33(0.0)  # columns: corners
    places = wp.mat33(0.0)
    clear = float(1.0)
    for k in range(3):
        p = points[3 * i + k]
        away = p - camera.position
        deep = -wp.dot(away, camera.back)
        scale = float(1.0)
        if orthographic == 0:
            viewer = -wp.normalize(away)
            scale = 1.0 / wp.max(deep, 1.0e-20)
        toward = lamp
        if distant == 0:
            toward = wp.normalize(lamp - p)
        off = slope_off(wp.normalize(toward + viewer), side * normals[3 * i + k], n, frame.x, frame.y)
        clear = clear * off[2] * wp.where(deep > camera.near, 1.0, 0.0)
        slopes[0, k] = off[0]
        slopes[1, k] = off[1]
        places[0, k] = (wp.dot(away, camera.right) * scale - camera.left) / camera.pixel_x
        places[1, k] = (camera.top - wp.dot(away, camera.up) * scale) / camera.pixel_y
    if clear == 0.0 or sine > widest:
        return
    for c in range(2):
        low = wp.min(places[c, 0], wp.min(places[c, 1], places[c, 2]))
        high = wp.max(places[c, 0], wp.max(places[c, 1], places[c, 2]))
        if high < -2.0 or low > size[c] + 2.0:
            return
    width = wp.sqrt(a * a + 0.25 * sine * sine)
    center = wp.vec2(slopes[0, 0] + slopes[0, 1] + slopes[0, 2], slopes[1, 0] + slopes[1, 1] + slopes[1, 2]) / 3.0
    apart = float(0.0)
    for k in range(3):
        apart = wp.max(apart, wp.length(wp.vec2(slopes[0, k], slopes[1, k]) - center))
    dim = width * wp.sqrt(wp.max(wp.sqrt(2.5) / width - 1.0, 0.0))
    if wp.length(center) - 1.5 * apart > dim:
        return
    # how slopes change a pixel, all directions together
    p1 = wp.vec2(places[0, 1] - places[0, 0], places[1, 1] - places[1, 0])
    p2 = wp.vec2(places[0, 2] - places[0, 0], places[1, 2] - places[1, 0])
    s1 = wp.vec2(slopes[0, 1] - slopes[0, 0], slopes[1, 1] - slopes[1, 0])
    s2 = wp.vec2(slopes[0, 2] - slopes[0, 0], slopes[1, 2] - slopes[1, 0])
    det = wp.abs(p1[0] * p2[1] - p1[1] * p2[0])
    mx = s1 * p2[1] - s2 * p1[1]
    my = s2 * p1[0] - s1 * p2[0]
    if wp.pi * width * width * det * det < 2.0 * largest * (wp.length_sq(mx) + wp.length_sq(my)):
        kept[i] = 1


@wp.kernel
def unhidden(
    mesh: wp.uint64,
    points: wp.array(dtype=wp.vec3),
    eyes: wp.array(dtype=wp.vec3),
    lamps: wp.array(dtype=wp.vec3),
    seen: wp.array(dtype=int),
):
    """Whether nothing stands between ``points``, moved off their surface, and both ends."""
    i = wp.tid()
    clear = int(1)
    for end in range(2):
        way = wp.where(end == 0, eyes[i], lamps[i]) - points[i]
        length = wp.length(way)
        if wp.mesh_query_ray_anyhit(mesh, points[i], way / length, 0.999 * length):
            clear = 0
    seen[i] = clear
