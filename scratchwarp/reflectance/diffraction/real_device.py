"""The scalar of wave optics on the device: float64.

The Gaussian along a scratch depends on sigma k xi_1, where xi_1 is the sum of two direction cosines and sigma k about
1000: rounding the cosines to float32 moves the argument by 1e-4 and the value, three widths off, by 6e-4; phases k (g_i
+ g_o) D reach hundreds of radians. float64 costs 1.1 to 1.4 times the time in scalar code on the CPU and needs none of
the detours of float32. Results are rounded where they join colours.
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
