"""A material at a point: its base reflectance, opacity and glow from constants, textures and display colours."""

import warp as wp

from ..optics.frames_device import Frame, frame_with_tangent, to_world
from ..reflectance.base_device import Base, preview_surface
from .geometry_device import Geometry, Surface, face_viewer, interpolate_color
from .key import KernelKey
from .material_device import MaterialArrays, MaterialData, clamp_color, read_color, read_scalar, read_texture

# Positions in kernels.material.KINDS.
CONDUCTOR = wp.constant(1)
DIELECTRIC = wp.constant(2)


def make_base_at(key: KernelKey):
    """(base, opacity, emission, frame) device functions, compiled for what the materials of ``key`` use."""

    @wp.func
    def color(arrays: MaterialArrays, constant: wp.vec3, read: int, uv: wp.vec2d) -> wp.vec3:
        if wp.static(key.textures):
            return read_color(arrays, constant, read, uv)
        return constant

    @wp.func
    def scalar(arrays: MaterialArrays, constant: float, read: int, uv: wp.vec2d) -> float:
        if wp.static(key.textures):
            return read_scalar(arrays, constant, read, uv)
        return constant

    @wp.func
    def measured_base(m: MaterialData) -> Base:
        b = Base()
        b.diffuse = wp.vec3(0.0, 0.0, 0.0)
        b.f90 = wp.vec3(1.0, 1.0, 1.0)
        b.ior = 1.5
        b.alpha_x = m.alpha_x
        b.alpha_y = m.alpha_y
        b.specular = 1.0
        b.clearcoat_alpha = 1.0
        if m.kind == CONDUCTOR:
            b.fresnel = 1
            b.eta = m.eta
            b.k = m.k
        elif m.kind == DIELECTRIC:
            b.fresnel = 2
            b.ior = m.ior
            b.diffuse = m.diffuse
        else:
            b.specular = 0.0
            b.diffuse = m.diffuse
        return b

    @wp.func
    def base_at(g: Geometry, arrays: MaterialArrays, m: MaterialData, s: Surface) -> Base:
        b = Base()
        if wp.static(key.measured):
            if m.kind != 0:
                b = measured_base(m)
        if wp.static(key.preview):
            if m.kind == 0:
                diffuse = color(arrays, m.diffuse, m.diffuse_read, s.uv)
                if wp.static(key.display_colors):
                    if m.display_color == 1:
                        diffuse = interpolate_color(g, s)
                b = preview_surface(
                    clamp_color(diffuse),
                    wp.clamp(scalar(arrays, m.metallic, m.metallic_read, s.uv), 0.0, 1.0),
                    m.specular_workflow,
                    clamp_color(color(arrays, m.specular, m.specular_read, s.uv)),
                    wp.clamp(scalar(arrays, m.roughness, m.roughness_read, s.uv), 0.0, 1.0),
                    m.ior,
                    wp.clamp(scalar(arrays, m.clearcoat, m.clearcoat_read, s.uv), 0.0, 1.0),
                    wp.clamp(scalar(arrays, m.clearcoat_roughness, m.clearcoat_roughness_read, s.uv), 0.0, 1.0),
                )
        return b

    @wp.func
    def opacity_at(arrays: MaterialArrays, m: MaterialData, uv: wp.vec2d) -> float:
        o = wp.clamp(scalar(arrays, m.opacity, m.opacity_read, uv), 0.0, 1.0)
        if m.opacity_threshold > 0.0:
            o = wp.where(o >= m.opacity_threshold, 1.0, 0.0)
        return o

    @wp.func
    def emission_at(arrays: MaterialArrays, m: MaterialData, uv: wp.vec2d) -> wp.vec3:
        e = color(arrays, m.emissive, m.emissive_read, uv)
        return wp.vec3(wp.max(e[0], 0.0), wp.max(e[1], 0.0), wp.max(e[2], 0.0))

    @wp.func
    def frame_at(
        g: Geometry, arrays: MaterialArrays, m: MaterialData, s: Surface, tangent: wp.vec3, wo: wp.vec3
    ) -> Frame:
        f = frame_with_tangent(s.ns, tangent)
        if wp.static(key.normal_maps):
            if m.normal_read >= 0:
                t = read_texture(arrays, m.normal_read, s.uv)
                # normal maps speak of dP/du, dP/dv and the outside
                du = g.dpdu[s.face]
                dv = g.dpdv[s.face]
                outward = wp.where(s.outside == 1, 1.0, -1.0)
                side = wp.where(wp.dot(wp.cross(du, dv), outward * s.ng) < 0.0, -1.0, 1.0)
                local = frame_with_tangent(outward * s.ns, du)
                n = wp.normalize(t[0] * local.x + side * t[1] * local.y + wp.max(t[2], 1.0e-3) * local.n)
                s_n = face_viewer(outward * n, s.ng, wo)
                f = frame_with_tangent(s_n, tangent)
        return f

    @wp.func
    def rotated(f: Frame, m: MaterialData) -> Frame:
        """The frame turned by the base's own direction of anisotropy."""
        r = f
        r.x = to_world(f, wp.vec3(m.cos_rotation, m.sin_rotation, 0.0))
        r.y = to_world(f, wp.vec3(-m.sin_rotation, m.cos_rotation, 0.0))
        return r

    return base_at, opacity_at, emission_at, frame_at, rotated
