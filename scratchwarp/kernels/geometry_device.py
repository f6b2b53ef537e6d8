"""The scene's triangles on the device, and what a ray finds on them."""

import warp as wp

wp.set_module_options({"enable_backward": False})


@wp.struct
class Geometry:
    """World triangles, metres relative to the camera; arrays over corners hold 3 entries a triangle."""

    mesh: wp.uint64
    empty: int
    points: wp.array(dtype=wp.vec3)
    normals: wp.array(dtype=wp.vec3)  # corner shading normals, unit
    uvs: wp.array(dtype=wp.vec2)  # corner coordinates in the uv set of the material
    tangents: wp.array(dtype=wp.vec3)  # corner tangents (only for materials with a direction)
    colors: wp.array(dtype=wp.vec3)  # corner display colours (only when some material uses them)
    dpdu: wp.array(dtype=wp.vec3)  # triangle: metres a unit of u and of v
    dpdv: wp.array(dtype=wp.vec3)
    material: wp.array(dtype=int)  # triangle
    instance: wp.array(dtype=int)  # triangle
    light: wp.array(dtype=int)  # triangle: mesh light, or -1
    pattern_scale: wp.array(dtype=wp.vec2d)  # instance: micrometres a unit of u and of v, over the surface


@wp.struct
class Surface:
    """A point on the scene, seen from ``wo``. Normals point to the viewer's side."""

    t: float
    face: int
    material: int
    instance: int
    light: int
    outside: int  # 1: seen from outside
    p: wp.vec3
    ng: wp.vec3
    ns: wp.vec3
    bary: wp.vec3
    uv: wp.vec2d
    offset: float  # how far to step off the surface before tracing on, metres


@wp.func
def intersect(g: Geometry, origin: wp.vec3, direction: wp.vec3, max_t: float) -> Surface:
    """The nearest triangle along a ray, at t < max_t; t < 0 where there is none."""
    s = Surface()
    s.t = -1.0
    s.face = -1
    s.light = -1
    s.instance = -1
    if g.empty == 0:
        hit = wp.mesh_query_ray(g.mesh, origin, direction, max_t)
        if hit.result:
            face = hit.face
            a = g.points[3 * face]
            b = g.points[3 * face + 1]
            c = g.points[3 * face + 2]
            s.t = hit.t
            s.face = face
            s.bary = wp.vec3(hit.u, hit.v, 1.0 - hit.u - hit.v)
            # interpolation keeps the point on the triangle; origin + t direction would drift off it far away
            s.p = s.bary[0] * a + s.bary[1] * b + s.bary[2] * c
            n = wp.normalize(wp.cross(b - a, c - a))
            s.outside = 1
            if wp.dot(n, direction) > 0.0:
                n = -n
                s.outside = 0
            s.ng = n
            s.material = g.material[face]
            s.instance = g.instance[face]
            s.light = g.light[face]
            size = wp.max(wp.max(wp.max(wp.abs(a[0]), wp.abs(a[1])), wp.abs(a[2])), wp.length(b - a))
            size = wp.max(size, wp.max(wp.max(wp.abs(s.p[0]), wp.abs(s.p[1])), wp.abs(s.p[2])))
            s.offset = 1.0e-6 * size
    return s


@wp.func
def interpolate_normal(g: Geometry, s: Surface, wo: wp.vec3) -> wp.vec3:
    """Shading normal on the viewer's side, bent back where it would turn away from the viewer."""
    n = (
        s.bary[0] * g.normals[3 * s.face]
        + s.bary[1] * g.normals[3 * s.face + 1]
        + s.bary[2] * g.normals[3 * s.face + 2]
    )
    if s.outside == 0:
        n = -n
    if wp.length_sq(n) < 1.0e-12 or wp.dot(n, s.ng) <= 0.0:
        n = s.ng
    return face_viewer(wp.normalize(n), s.ng, wo)


@wp.func
def face_viewer(n: wp.vec3, ng: wp.vec3, wo: wp.vec3) -> wp.vec3:
    """Turn a shading normal towards the facet's just enough that the viewer is above it."""
    result = n
    least = wp.min(0.01, 0.5 * wp.max(wp.dot(ng, wo), 1.0e-4))
    facing = wp.dot(n, wo)
    if facing < least:
        toward = wp.dot(ng, wo) - facing
        t = float(1.0)
        if toward > 1.0e-8:
            t = wp.clamp((least - facing) / toward, 0.0, 1.0)
        result = wp.normalize(n + t * (ng - n))
    return result


@wp.func
def lifted(g: Geometry, s: Surface) -> wp.vec3:
    """The hit moved onto the smooth surface that the shading normals describe (Hanika 2021, shadow terminator).

    Only outwards: each corner's tangent plane pulls the point up by the part of it that lies above the facet.
    """
    a = g.points[3 * s.face]
    b = g.points[3 * s.face + 1]
    c = g.points[3 * s.face + 2]
    sign = wp.where(s.outside == 1, 1.0, -1.0)
    na = sign * g.normals[3 * s.face]
    nb = sign * g.normals[3 * s.face + 1]
    nc = sign * g.normals[3 * s.face + 2]
    moved = (
        s.bary[0] * (s.p - wp.min(wp.dot(s.p - a, na), 0.0) * na)
        + s.bary[1] * (s.p - wp.min(wp.dot(s.p - b, nb), 0.0) * nb)
        + s.bary[2] * (s.p - wp.min(wp.dot(s.p - c, nc), 0.0) * nc)
    )
    return moved + s.offset * s.ng


@wp.func
def interpolate_uv(g: Geometry, s: Surface) -> wp.vec2d:
    """Texture coordinates in float64: micrometres have to survive on a metre of surface."""
    a = g.uvs[3 * s.face]
    b = g.uvs[3 * s.face + 1]
    c = g.uvs[3 * s.face + 2]
    u = wp.float64(s.bary[0])
    v = wp.float64(s.bary[1])
    ab = wp.vec2d(wp.float64(a[0]) - wp.float64(c[0]), wp.float64(a[1]) - wp.float64(c[1]))
    bc = wp.vec2d(wp.float64(b[0]) - wp.float64(c[0]), wp.float64(b[1]) - wp.float64(c[1]))
    return wp.vec2d(wp.float64(c[0]) + u * ab[0] + v * bc[0], wp.float64(c[1]) + u * ab[1] + v * bc[1])


@wp.func
def interpolate_tangent(g: Geometry, s: Surface) -> wp.vec3:
    """Tangent between the corners', not normalised."""
    return (
        s.bary[0] * g.tangents[3 * s.face]
        + s.bary[1] * g.tangents[3 * s.face + 1]
        + s.bary[2] * g.tangents[3 * s.face + 2]
    )


@wp.func
def interpolate_color(g: Geometry, s: Surface) -> wp.vec3:
    """Display colour between the corners'."""
    return (
        s.bary[0] * g.colors[3 * s.face] + s.bary[1] * g.colors[3 * s.face + 1] + s.bary[2] * g.colors[3 * s.face + 2]
    )


@wp.func
def uv_motion(g: Geometry, s: Surface, dp: wp.vec3) -> wp.vec2:
    """How (u, v) change along a step ``dp`` in the triangle's plane."""
    du = g.dpdu[s.face]
    dv = g.dpdv[s.face]
    e = wp.dot(du, du)
    f = wp.dot(du, dv)
    h = wp.dot(dv, dv)
    det = e * h - f * f
    result = wp.vec2(0.0, 0.0)
    if det > 1.0e-12 * e * h and det > 0.0:
        pu = wp.dot(dp, du)
        pv = wp.dot(dp, dv)
        result = wp.vec2((h * pu - f * pv) / det, (e * pv - f * pu) / det)
    return result
