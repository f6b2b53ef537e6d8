"""Points in space onto a surface."""

import warp as wp

wp.set_module_options({"enable_backward": False})


@wp.kernel
def nearest(
    mesh: wp.uint64,
    reach: float,
    points: wp.array(dtype=wp.vec3),
    face: wp.array(dtype=int),
    weights: wp.array(dtype=wp.vec2),
):
    """The nearest triangle within ``reach`` [m], or -1, and the weights of its first two corners."""
    t = wp.tid()
    face[t] = -1
    found = wp.mesh_query_point_no_sign(mesh, points[t], reach)
    if found.result:
        face[t] = found.face
        weights[t] = wp.vec2(found.u, found.v)
