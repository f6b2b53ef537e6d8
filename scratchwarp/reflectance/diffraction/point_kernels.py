"""The reflectance of scratches over arrays of directions, and the integrals of outlines."""

import warp as wp

from .complex_device import power
from .outline_device import outline_transform
from .quadrature_device import Rules, rule_node, rule_weight
from .real_device import TWO, ZERO, real, vec2, vec3, vec4
from .scratch_device import WaveScratch, mirror_amplitude, scratch_amplitude, scratch_brdf

wp.set_module_options({"enable_backward": False})

_NODES = wp.constant(3)


@wp.struct
class Pairs:
    """Directions and a wavelength for each value asked for."""

    omega_i: wp.array(dtype=vec3)
    omega_o: wp.array(dtype=vec3)
    wavelength: wp.array(dtype=real)


@wp.kernel
def brdf_kernel(
    pairs: Pairs,
    scratch: wp.array(dtype=WaveScratch),
    outlines: wp.array(dtype=vec4),
    angle_dependent: int,
    out: wp.array(dtype=real),
):
    """One scratch each."""
    i = wp.tid()
    out[i] = scratch_brdf(
        scratch[i], outlines, pairs.wavelength[i], pairs.omega_i[i], pairs.omega_o[i], angle_dependent
    )


@wp.kernel
def coherent_kernel(
    pairs: Pairs,
    scratches: wp.array2d(dtype=WaveScratch),
    outlines: wp.array(dtype=vec4),
    angle_dependent: int,
    sigma: wp.array(dtype=real),
    base: real,
    out: wp.array(dtype=real),
):
    """|base B - sum of S_m|^2 / (A_C lambda^2); the second index of ``scratches`` is the value asked for, or 0 for
    all."""
    i = wp.tid()
    omega_i = pairs.omega_i[i]
    omega_o = pairs.omega_o[i]
    wavelength = pairs.wavelength[i]
    if omega_i[2] > ZERO and omega_o[2] > ZERO:
        total = vec2(base * mirror_amplitude(sigma[i], wavelength, omega_i, omega_o), ZERO)
        column = wp.min(i, scratches.shape[1] - 1)
        for m in range(scratches.shape[0]):
            total -= scratch_amplitude(scratches[m, column], outlines, wavelength, omega_i, omega_o, angle_dependent)
        out[i] = power(total)


@wp.kernel
def outline_integral_kernel(
    outlines: wp.array(dtype=vec4),
    first: int,
    count: int,
    width: real,
    depth: real,
    nodes: int,
    rules: Rules,
    out: wp.array(dtype=vec2),
):
    """For node i of xi_2 over [-2, 2]: the integral of |P|^2 / lambda^2 from the node before, and |P|^2 / lambda^2."""
    i = wp.tid()
    step = real(4.0) / real(nodes - 1)
    xi2 = step * real(i) - TWO
    total = real(0.0)
    if i > 0:
        for j in range(_NODES):
            at = xi2 - step + step * rule_node(rules, _NODES, j)
            total += (
                rule_weight(rules, _NODES, j)
                * step
                * power(outline_transform(outlines, first, count, width, depth, at, TWO))
            )
    out[i] = vec2(total, power(outline_transform(outlines, first, count, width, depth, xi2, TWO)))
