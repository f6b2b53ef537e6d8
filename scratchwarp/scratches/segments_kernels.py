"""Cutting scratches to triangles: each thread takes one straight stretch and finds the triangles that it crosses."""

import warp as wp

from .segments_device import Plane, Segment, clip_to, in_plane, plane_of, turn_between

wp.set_module_options({"enable_backward": False})


@wp.struct
class Stretches:
    """Straight stretches of polylines: ends (metres, or u, v, 0), unit directions of the scratch there, sizes [um]
    (negative: fractions of the uv square, to be scaled by the mapping)."""

    a: wp.array(dtype=wp.vec3d)
    b: wp.array(dtype=wp.vec3d)
    along_a: wp.array(dtype=wp.vec3)
    along_b: wp.array(dtype=wp.vec3)
    width: wp.array(dtype=float)
    depth: wp.array(dtype=float)
    layer: int


@wp.struct
class Facets:
    """Triangles to cut at. ``edges``: for each corner k the normal of the plane through the edge from k to k + 1 and
    the mean normal of both its triangles, pointing inside. ``taken``: whether scratches of the layer lie there."""

    points: wp.array(dtype=wp.vec3)
    edges: wp.array(dtype=wp.vec3)
    uvs: wp.array(dtype=wp.vec2)
    dpdu: wp.array(dtype=wp.vec3)
    dpdv: wp.array(dtype=wp.vec3)
    taken: wp.array(dtype=wp.uint8)


@wp.func
def _shifted(plane: Plane, p: wp.vec3d, inward: wp.vec3) -> wp.vec2d:
    """A point on a cutting plane moved within it, across the edge, into the triangle's plane: onto the edge itself,
    so that pieces on both of its sides meet."""
    height = wp.dot(p - wp.vec3d(plane.origin), wp.vec3d(plane.n))
    edge = wp.cross(plane.n, inward)  # along the edge
    across = wp.cross(edge, inward)  # in the cutting plane, across the edge
    climb = wp.dot(across, plane.n)
    q = p
    if wp.abs(climb) > 1.0e-3 * wp.length(across):
        q = p - wp.vec3d(across) * (height / wp.float64(climb))
    return in_plane(plane, q)


@wp.func
def _piece(
    s: Stretches,
    i: int,
    face: int,
    start: wp.vec2d,
    end: wp.vec2d,
    tangent_a: wp.vec2,
    tangent_b: wp.vec2,
    scale: float,
) -> Segment:
    r = Segment()
    chord = end - start
    half = wp.float64(0.5)
    r.middle = half * (start + end)
    r.half = wp.vec2(float(half * chord[0]), float(half * chord[1]))
    r.turn_a = turn_between(r.half, tangent_a)
    r.turn_b = turn_between(r.half, tangent_b)
    r.width = wp.where(s.width[i] < 0.0, -s.width[i] * scale, s.width[i])
    r.depth = wp.where(s.depth[i] < 0.0, -s.depth[i] * scale, s.depth[i])
    r.triangle = face
    r.layer = s.layer
    return r


@wp.func
def _mixed(a: wp.vec3, b: wp.vec3, t: float) -> wp.vec3:
    return (1.0 - t) * a + t * b


@wp.func
def _over(mesh: wp.uint64, p: wp.vec3d, reach: float) -> float:
    """Distance from the surface, -1 beyond ``reach``."""
    found = wp.mesh_query_point_no_sign(mesh, wp.vec3(p), reach)
    r = float(-1.0)
    if found.result:
        r = wp.length(wp.vec3(p) - wp.mesh_eval_position(mesh, found.face, found.u, found.v))
    return r


@wp.kernel
def cut_on_surface(
    s: Stretches,
    f: Facets,
    mesh: wp.uint64,
    slack: float,
    starts: wp.array(dtype=int),
    counts: wp.array(dtype=int),
    out: wp.array(dtype=Segment),
):
    """Stretches in space: projected on every triangle that they pass near, between the planes of its edges. Without
    ``starts`` the pieces are counted, with them they are written."""
    i = wp.tid()
    writing = starts.shape[0] > 0
    if writing and counts[i] == 0:
        return
    a = s.a[i]
    b = s.b[i]
    length = float(wp.length(b - a))
    reach = 0.5 * length + slack
    half = wp.float64(0.5)
    off_a = _over(mesh, a, reach)
    off_b = _over(mesh, b, reach)
    off_m = _over(mesh, half * (a + b), reach)
    n = int(0)
    if off_a >= 0.0 and off_b >= 0.0 and off_m >= 0.0:
        # a chord of a smooth surface leaves it most at its middle
        near = 1.5 * wp.max(wp.max(off_a, off_b), off_m) + slack
        low = wp.vec3(wp.min(a, b)) - wp.vec3(near, near, near)
        high = wp.vec3(wp.max(a, b)) + wp.vec3(near, near, near)
        query = wp.mesh_query_aabb(mesh, low, high)
        face = int(0)
        while wp.mesh_query_aabb_next(query, face):
            if f.taken[face] != wp.uint8(0):
                pa = f.points[3 * face]
                pb = f.points[3 * face + 1]
                pc = f.points[3 * face + 2]
                plane = plane_of(pa, pb, pc)
                if plane.cy > 0.0:
                    part = wp.vec2d(wp.float64(0.0), wp.float64(1.0))
                    first = int(-1)
                    last = int(-1)
                    for k in range(3):
                        corner = wp.vec3d(f.points[3 * face + k])
                        inward = wp.vec3d(f.edges[3 * face + k])
                        cut = clip_to(part, wp.dot(a - corner, inward), wp.dot(b - corner, inward))
                        if cut[0] > part[0]:
                            first = k
                        if cut[1] < part[1]:
                            last = k
                        part = cut
                    if part[1] > part[0]:
                        p = a + part[0] * (b - a)
                        q = a + part[1] * (b - a)
                        origin = wp.vec3d(plane.origin)
                        normal = wp.vec3d(plane.n)
                        off = wp.max(wp.abs(wp.dot(p - origin, normal)), wp.abs(wp.dot(q - origin, normal)))
                        if float(off) <= near:
                            start = in_plane(plane, p)
                            end = in_plane(plane, q)
                            if first >= 0:
                                start = _shifted(plane, p, f.edges[3 * face + first])
                            if last >= 0:
                                end = _shifted(plane, q, f.edges[3 * face + last])
                            if wp.length(end - start) > wp.float64(1.0e-12) * wp.float64(length):
                                if writing:
                                    ta = _mixed(s.along_a[i], s.along_b[i], float(part[0]))
                                    tb = _mixed(s.along_a[i], s.along_b[i], float(part[1]))
                                    out[starts[i] + n] = _piece(
                                        s,
                                        i,
                                        face,
                                        start,
                                        end,
                                        wp.vec2(wp.dot(ta, plane.x), wp.dot(ta, plane.y)),
                                        wp.vec2(wp.dot(tb, plane.x), wp.dot(tb, plane.y)),
                                        1.0,
                                    )
                                n += 1
    if not writing:
        counts[i] = n


@wp.kernel
def cut_in_uv(
    s: Stretches,
    f: Facets,
    bvh: wp.uint64,
    faces: wp.array(dtype=int),
    starts: wp.array(dtype=int),
    counts: wp.array(dtype=int),
    out: wp.array(dtype=Segment),
):
    """Stretches in the uv square, clipped to the triangles' images there (``bvh`` over those of ``faces``)."""
    i = wp.tid()
    writing = starts.shape[0] > 0
    if writing and counts[i] == 0:
        return
    a = s.a[i]
    b = s.b[i]
    thick = wp.vec3(0.0, 0.0, 1.0)
    query = wp.bvh_query_aabb(bvh, wp.vec3(wp.min(a, b)) - thick, wp.vec3(wp.max(a, b)) + thick)
    number = int(0)
    n = int(0)
    while wp.bvh_query_next(query, number):
        face = faces[number]
        plane = plane_of(f.points[3 * face], f.points[3 * face + 1], f.points[3 * face + 2])
        ua = wp.vec2d(f.uvs[3 * face])
        ub = wp.vec2d(f.uvs[3 * face + 1])
        uc = wp.vec2d(f.uvs[3 * face + 2])
        area = (ub[0] - ua[0]) * (uc[1] - ua[1]) - (ub[1] - ua[1]) * (uc[0] - ua[0])
        if plane.cy > 0.0 and area != wp.float64(0.0):
            # barycentric coordinates of both ends
            a0 = wp.vec2d(a[0] - ua[0], a[1] - ua[1])
            b0 = wp.vec2d(b[0] - ua[0], b[1] - ua[1])
            a1 = (a0[0] * (uc[1] - ua[1]) - a0[1] * (uc[0] - ua[0])) / area
            a2 = ((ub[0] - ua[0]) * a0[1] - (ub[1] - ua[1]) * a0[0]) / area
            b1 = (b0[0] * (uc[1] - ua[1]) - b0[1] * (uc[0] - ua[0])) / area
            b2 = ((ub[0] - ua[0]) * b0[1] - (ub[1] - ua[1]) * b0[0]) / area
            one = wp.float64(1.0)
            part = clip_to(wp.vec2d(wp.float64(0.0), one), a1, b1)
            part = clip_to(part, a2, b2)
            part = clip_to(part, one - a1 - a2, one - b1 - b2)
            if part[1] > part[0]:
                p1 = a1 + part[0] * (b1 - a1)
                p2 = a2 + part[0] * (b2 - a2)
                q1 = a1 + part[1] * (b1 - a1)
                q2 = a2 + part[1] * (b2 - a2)
                bx = wp.float64(plane.bx)
                cx = wp.float64(plane.cx)
                cy = wp.float64(plane.cy)
                start = wp.vec2d(p1 * bx + p2 * cx, p2 * cy)
                end = wp.vec2d(q1 * bx + q2 * cx, q2 * cy)
                if wp.length(end - start) > wp.float64(0.0):
                    if writing:
                        du = f.dpdu[face]
                        dv = f.dpdv[face]
                        ta = _mixed(s.along_a[i], s.along_b[i], float(part[0]))
                        tb = _mixed(s.along_a[i], s.along_b[i], float(part[1]))
                        wa = ta[0] * du + ta[1] * dv
                        wb = tb[0] * du + tb[1] * dv
                        out[starts[i] + n] = _piece(
                            s,
                            i,
                            face,
                            start,
                            end,
                            wp.vec2(wp.dot(wa, plane.x), wp.dot(wa, plane.y)),
                            wp.vec2(wp.dot(wb, plane.x), wp.dot(wb, plane.y)),
                            1.0e6 * wp.sqrt(wp.length(du) * wp.length(dv)),
                        )
                    n += 1
    if not writing:
        counts[i] = n


@wp.kernel
def bounds(
    segments: wp.array(dtype=Segment),
    points: wp.array(dtype=wp.vec3),
    lower: wp.array(dtype=wp.vec3),
    upper: wp.array(dtype=wp.vec3),
):
    """World box of each piece."""
    i = wp.tid()
    s = segments[i]
    plane = plane_of(points[3 * s.triangle], points[3 * s.triangle + 1], points[3 * s.triangle + 2])
    m = plane.origin + float(s.middle[0]) * plane.x + float(s.middle[1]) * plane.y
    h = s.half[0] * plane.x + s.half[1] * plane.y
    lower[i] = wp.min(m - h, m + h)
    upper[i] = wp.max(m - h, m + h)
