"""The base reflectance over arrays of directions: thin loops over the functions that the renderer calls."""

import warp as wp

from .base_device import Base, base_eval_pdf, base_sample, preview_surface

wp.set_module_options({"enable_backward": False})


@wp.kernel
def evaluate(
    base: wp.array(dtype=Base),
    wi: wp.array(dtype=wp.vec3),
    wo: wp.array(dtype=wp.vec3),
    w_diffuse: float,
    w_specular: float,
    value: wp.array(dtype=wp.vec3),
    pdf: wp.array(dtype=float),
):
    """Value (f_r cos(theta_i) [1/sr]) and density [1/sr] for pairs of directions; one base for all."""
    i = wp.tid()
    t = base_eval_pdf(base[0], wo[i], wi[i], w_diffuse, w_specular)
    value[i] = t.value
    pdf[i] = t.pdf


@wp.kernel
def sample(
    base: wp.array(dtype=Base),
    wo: wp.array(dtype=wp.vec3),
    u: wp.array(dtype=wp.vec3),
    w_diffuse: float,
    w_specular: float,
    wi: wp.array(dtype=wp.vec3),
    weight: wp.array(dtype=wp.vec3),
    pdf: wp.array(dtype=float),
    delta: wp.array(dtype=int),
):
    """One sample for each view and triple of uniform numbers."""
    i = wp.tid()
    s = base_sample(base[0], wo[i], wp.vec2(u[i][0], u[i][1]), u[i][2], w_diffuse, w_specular)
    wi[i] = s.wi
    weight[i] = s.weight
    pdf[i] = s.pdf
    delta[i] = s.delta


@wp.kernel
def preview(
    diffuse: wp.vec3,
    metallic: float,
    specular_workflow: int,
    specular_color: wp.vec3,
    roughness: float,
    ior: float,
    clearcoat: float,
    clearcoat_roughness: float,
    base: wp.array(dtype=Base),
):
    """The base of one set of UsdPreviewSurface inputs."""
    base[0] = preview_surface(
        diffuse, metallic, specular_workflow, specular_color, roughness, ior, clearcoat, clearcoat_roughness
    )
