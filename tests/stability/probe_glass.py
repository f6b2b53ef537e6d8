"""As ``probe_kernels``: rough glass one facet at a time, and how often grooves are laid out."""

import warp as wp

from scratchwarp.kernels.geometry_device import Geometry, Surface
from scratchwarp.kernels.groove_arrays_device import GrooveArrays
from scratchwarp.kernels.groove_glass_device import chance_through, from_within, glass_base, refracted
from scratchwarp.optics.sampling_device import sample_cosine_hemisphere
from scratchwarp.reflectance.base_device import Base

wp.set_module_options({"enable_backward": False})


@wp.kernel
def through(u: wp.array(dtype=wp.vec4), alpha: float, ior: float, within: int, out: wp.array(dtype=wp.vec3)):
    """(cosine before, cosine behind, share that passes) of a direction of Lambert's law, from the air or within."""
    i = wp.tid()
    b = Base()
    b.alpha_x = alpha
    b.alpha_y = alpha
    b.ior = ior
    b = glass_base(b)
    if within == 1:
        b = from_within(b)
    wo = sample_cosine_hemisphere(wp.vec2(u[i][0], u[i][1]))
    chance = chance_through(b, wo, 1.0, 0.0)
    gone = refracted(b, wo, wp.vec2(u[i][2], u[i][3]), 1.0, chance)
    out[i] = wp.vec3(wo[2], -gone.wi[2], gone.weight * chance)


def make_share(is_near):
    """The kernel of how often a footprint whose edges are ``steps`` [m] along x and y shows grooves."""

    @wp.kernel(module="unique")
    def share(arrays: GrooveArrays, g: Geometry, steps: wp.array(dtype=float), out: wp.array(dtype=float)):
        i = wp.tid()
        s = Surface()
        out[i] = is_near(arrays, g, s, wp.vec3(steps[i], 0.0, 0.0), wp.vec3(0.0, steps[i], 0.0))

    return share
