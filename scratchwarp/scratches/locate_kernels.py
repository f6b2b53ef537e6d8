"""Which triangle a point of the uv square lies in."""

import warp as wp

wp.set_module_options({"enable_backward": False})


@wp.kernel
def locate(
    bvh: wp.uint64,
    corners: wp.array(dtype=wp.vec2),
    points: wp.array(dtype=wp.vec2),
    face: wp.array(dtype=int),
    bary: wp.array(dtype=wp.vec3),
):
    """The triangle of each point, -1 for none, and barycentric coordinates there."""
    i = wp.tid()
    face[i] = -1
    bary[i] = wp.vec3(1.0, 0.0, 0.0)
    p = points[i]
    at = wp.vec3(p[0], p[1], 0.0)
    query = wp.bvh_query_aabb(bvh, at, at)
    other = int(0)
    while wp.bvh_query_next(query, other):
        a = corners[3 * other]
        b = corners[3 * other + 1] - a
        c = corners[3 * other + 2] - a
        q = p - a
        area = b[0] * c[1] - b[1] * c[0]
        if area != 0.0:
            s = (q[0] * c[1] - q[1] * c[0]) / area
            t = (b[0] * q[1] - b[1] * q[0]) / area
            if s >= -1.0e-5 and t >= -1.0e-5 and s + t <= 1.00001:
                face[i] = other
                bary[i] = wp.vec3(1.0 - s - t, s, t)
