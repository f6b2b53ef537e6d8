"""The scalar of wave optics on the device: float64.

The Gaussian along a scratch depends on sigma k xi_1, where xi_1 is the sum of two direction cosines and sigma k about
1000: rounding the cosines to float32 moves the argument by 1e-4 and the value, three widths off, by 6e-4. Measured over
random views near the peak, float32 leaves 1e-4 (95 %) and 3e-2 (worst) in the BRDF and 11 % in the worst radiance of a
5 cm light at 1 m. float64 costs 1.2 times the time for spheres, up to 1.9 times for polygons, and needs none of the
detours of float32.
"""

import warp as wp

real = wp.float64
vec2 = wp.vec2d
vec3 = wp.vec3d
vec4 = wp.vec4d
"""Vectors of ``real``."""

ZERO = wp.constant(real(0.0))
HALF = wp.constant(real(0.5))
ONE = wp.constant(real(1.0))
TWO = wp.constant(real(2.0))
PI = wp.constant(real(3.141592653589793))
"""Numbers that would otherwise be float32 literals."""
