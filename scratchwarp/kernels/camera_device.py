"""Camera rays and the footprint of a sample."""

import warp as wp

from ..optics.sampling_device import sample_concentric_disk

wp.set_module_options({"enable_backward": False})


@wp.struct
class CameraData:
    """Camera at the local origin; ``left``.. ``top`` as ``scene.Camera.window`` gives them for the whole image."""

    position: wp.vec3
    right: wp.vec3  # unit axes in the world
    up: wp.vec3
    back: wp.vec3
    left: float
    top: float
    pixel_x: float  # window units a pixel, going right
    pixel_y: float  # going down
    near: float
    far: float
    lens_radius: float
    focus_distance: float
    exposure: float
    footprint: float  # edge of a sample's footprint in pixels


@wp.struct
class CameraRay:
    """Origin, unit direction, the window point's direction before normalising, and the reach along the ray."""

    origin: wp.vec3
    direction: wp.vec3
    raw: wp.vec3
    start: float
    reach: float


@wp.func
def perspective_ray(c: CameraData, x: float, y: float, lens: wp.vec2) -> CameraRay:
    """Ray through image position (x, y) in pixels from the top left; ``lens``: point of the aperture, unit disk."""
    wx = c.left + x * c.pixel_x
    wy = c.top - y * c.pixel_y
    ray = CameraRay()
    ray.raw = wx * c.right + wy * c.up - c.back
    ray.origin = c.position
    length = wp.length(ray.raw)
    ray.direction = ray.raw / length
    if c.lens_radius > 0.0:
        shift = c.lens_radius * (lens[0] * c.right + lens[1] * c.up)
        ray.origin = c.position + shift
        bent = ray.raw * c.focus_distance - shift
        ray.direction = wp.normalize(bent)
        # depth along -back grows as before; reach is measured along the bent ray
        length = 1.0 / wp.max(-wp.dot(ray.direction, c.back), 1.0e-6)
    ray.start = c.near * length
    ray.reach = c.far * length
    return ray


@wp.func
def orthographic_ray(c: CameraData, x: float, y: float, lens: wp.vec2) -> CameraRay:
    """Parallel ray through image position (x, y)."""
    ray = CameraRay()
    ray.direction = -c.back
    ray.raw = ray.direction
    ray.origin = c.position + (c.left + x * c.pixel_x) * c.right + (c.top - y * c.pixel_y) * c.up
    ray.start = c.near
    ray.reach = c.far
    return ray


@wp.func
def footprint_step(w: wp.vec3, direction: wp.vec3, n: wp.vec3) -> wp.vec3:
    """Where a ray shifted by ``w`` meets the plane of normal ``n``: w less its part along the ray to the plane."""
    facing = wp.dot(direction, n)
    facing = wp.where(wp.abs(facing) < 1.0e-3, wp.where(facing < 0.0, -1.0e-3, 1.0e-3), facing)
    return w - direction * (wp.dot(w, n) / facing)


@wp.func
def lens_point(u: wp.vec2) -> wp.vec2:
    """Uniform point of the unit disk."""
    return sample_concentric_disk(u)
