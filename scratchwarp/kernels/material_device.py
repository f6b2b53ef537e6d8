"""Materials on the device: constants or textures, evaluated into the base reflectance at a point."""

import warp as wp

from ..reflectance.texture_device import TextureAtlas, texel_bilinear

wp.set_module_options({"enable_backward": False})


@wp.struct
class TextureRead:
    """A TextureInput: value = scale * texel + bias at (m0 m1 m2; m3 m4 m5) (u, v, 1)."""

    texture: int
    channel: int  # position in scene.texture.CHANNELS
    wrap_s: int
    wrap_t: int
    scale: wp.vec4
    bias: wp.vec4
    row0: wp.vec3
    row1: wp.vec3


@wp.struct
class MaterialData:
    """One material. ``*_read``: index of a TextureRead that overrides the constant, or -1."""

    kind: int  # position in kernels.material.KINDS
    diffuse: wp.vec3
    diffuse_read: int
    display_color: int  # 1: the mesh's display colour is the diffuse colour
    emissive: wp.vec3
    emissive_read: int
    specular_workflow: int
    specular: wp.vec3
    specular_read: int
    metallic: float
    metallic_read: int
    roughness: float
    roughness_read: int
    clearcoat: float
    clearcoat_read: int
    clearcoat_roughness: float
    clearcoat_roughness_read: int
    opacity: float
    opacity_read: int
    opacity_threshold: float
    presence: int  # 1: opacity removes specular reflection, too
    refracts: int  # 1: what passes through is refracted by ``ior``
    ior: float
    normal_read: int
    eta: wp.vec3
    k: wp.vec3
    alpha_x: float
    alpha_y: float
    cos_rotation: float
    sin_rotation: float
    response: int  # that stands in for the base, -1: none
    first_layer: int
    layers: int
    veil: float  # what scratches that nothing passes through leave of light that passes through, on the average


@wp.struct
class MaterialArrays:
    """All materials of a scene and the textures they read."""

    materials: wp.array(dtype=MaterialData)
    reads: wp.array(dtype=TextureRead)
    atlas: TextureAtlas


@wp.func
def read_texture(arrays: MaterialArrays, read: int, uv: wp.vec2d) -> wp.vec4:
    """scale * texel + bias at the transformed coordinates."""
    r = arrays.reads[read]
    u = float(wp.float64(r.row0[0]) * uv[0] + wp.float64(r.row0[1]) * uv[1] + wp.float64(r.row0[2]))
    v = float(wp.float64(r.row1[0]) * uv[0] + wp.float64(r.row1[1]) * uv[1] + wp.float64(r.row1[2]))
    texel = texel_bilinear(arrays.atlas, r.texture, wp.vec2(u, v), r.wrap_s, r.wrap_t)
    return wp.cw_mul(r.scale, texel) + r.bias


@wp.func
def read_color(arrays: MaterialArrays, constant: wp.vec3, read: int, uv: wp.vec2d) -> wp.vec3:
    """A colour input: the constant, or the texture's rgb."""
    result = constant
    if read >= 0:
        t = read_texture(arrays, read, uv)
        result = wp.vec3(t[0], t[1], t[2])
        channel = arrays.reads[read].channel
        if channel > 0:
            result = wp.vec3(t[channel - 1], t[channel - 1], t[channel - 1])
    return result


@wp.func
def read_scalar(arrays: MaterialArrays, constant: float, read: int, uv: wp.vec2d) -> float:
    """A scalar input: the constant, or the texture's channel."""
    result = constant
    if read >= 0:
        t = read_texture(arrays, read, uv)
        result = t[wp.max(arrays.reads[read].channel - 1, 0)]
    return result


@wp.func
def clamp_color(c: wp.vec3) -> wp.vec3:
    """An albedo: each channel in [0, 1]."""
    return wp.vec3(wp.clamp(c[0], 0.0, 1.0), wp.clamp(c[1], 0.0, 1.0), wp.clamp(c[2], 0.0, 1.0))


@wp.func
def cut_out(m: MaterialData) -> bool:
    """Whether opacity removes the surface, its specular reflection included."""
    return m.presence == 1 or m.opacity_threshold > 0.0
