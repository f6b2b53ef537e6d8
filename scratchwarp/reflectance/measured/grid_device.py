"""A BRDF on the grid of a UTIA measurement, interpolated on the device: linear in both thetas and both phis.

Azimuths are periodic, so that there is no seam at phi = 0; at theta = 0, where all azimuths are one direction, the
table holds their mean, so that there is none at the pole; beyond the last theta (75 degrees) values are held.
"""

import warp as wp

wp.set_module_options({"enable_backward": False})

_THETAS = wp.constant(6)
_PHIS = wp.constant(48)
_PER_THETA = wp.constant(3.8197186342054885)  # 1 / 15 degrees
_PER_PHI = wp.constant(7.639437268410977)  # 1 / 7.5 degrees


@wp.struct
class GridBrdf:
    """``values [illumination, view]``, number 48 it + ip, not negative, linear Rec.709 [1/sr]."""

    values: wp.array2d(dtype=wp.vec3)


@wp.struct
class GridPlace:
    """The four grid directions around a direction and their weights."""

    number: wp.vec4i
    weight: wp.vec4


@wp.func
def grid_place(w: wp.vec3) -> GridPlace:
    """Where a direction lies on the grid."""
    t = wp.min(wp.atan2(wp.sqrt(w[0] * w[0] + w[1] * w[1]), w[2]) * _PER_THETA, float(_THETAS - 1))
    p = wp.atan2(w[1], w[0]) * _PER_PHI
    p = p - wp.floor(p / float(_PHIS)) * float(_PHIS)
    it = wp.clamp(int(t), 0, _THETAS - 2)
    ip = int(p) % _PHIS
    after = (ip + 1) % _PHIS
    ft = t - float(it)
    fp = wp.clamp(p - wp.floor(p), 0.0, 1.0)
    place = GridPlace()
    row = it * _PHIS
    place.number = wp.vec4i(row + ip, row + after, row + _PHIS + ip, row + _PHIS + after)
    place.weight = wp.vec4((1.0 - ft) * (1.0 - fp), (1.0 - ft) * fp, ft * (1.0 - fp), ft * fp)
    return place


@wp.func
def grid_eval(brdf: GridBrdf, wi: wp.vec3, wo: wp.vec3) -> wp.vec3:
    """f_r [1/sr] for directions above the horizon."""
    a = grid_place(wi)
    b = grid_place(wo)
    f = wp.vec3(0.0, 0.0, 0.0)
    for i in range(4):
        for j in range(4):
            f += (a.weight[i] * b.weight[j]) * brdf.values[a.number[i], b.number[j]]
    return f
