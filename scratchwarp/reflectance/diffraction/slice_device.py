"""The radiance of one slice: xi_1 is fixed, so that light comes from the half circle (u, s sin psi, s cos psi), u =
xi_1 - omega_o1, s = sqrt(1 - u^2), and what is integrated over xi_2 = omega_o2 + s sin psi is the lobe across.

A light tells at which psi its outline crosses the slice, and whether it begins or ends there. The antiderivative is
summed with these signs, so that outlines of any shape need neither sorting nor storage.
"""

import warp as wp

from .lobe_device import lobe_integral, lobe_integral_paper
from .quadrature_device import Rules, rule_node, rule_weight
from .real_device import HALF, ONE, PI, TWO, ZERO, real, vec2, vec3, vec4
from .scratch_device import WaveScratch, across_power, depth_power, to_scratch

EXACT = wp.constant(0)
"""Antiderivative: the rectangle's closed form with exact Si."""
PAPER = wp.constant(1)
"""Antiderivative: the same with Eq. 29."""
TABLE = wp.constant(2)
"""Antiderivative: the table of an outline, small angles."""
NUMERIC = wp.constant(3)
"""Antiderivative: numerical, where the depth phase depends on psi."""

LENGTH = wp.constant(4)
"""No antiderivative: what is lit of a slice alone, as a length of xi_2."""

_PANEL = wp.constant(real(1.0))  # cycles of phase for each 8 nodes: error 1e-9
_PANEL_NODES = wp.constant(8)


@wp.struct
class LobeTables:
    """Outlines (rows of ``outline_transform``) and, for each lobe that has one, the integral from 0 of |P|^2 / lambda^2
    over xi_2 and its slope at equal steps over [-2, 2]; ``rounds``: the table of ``round_rules``."""

    outlines: wp.array(dtype=vec4)
    integrals: wp.array(dtype=vec2)
    rounds: wp.array2d(dtype=vec4)


@wp.struct
class Lobe:
    """What does not change from slice to slice; omega_o in the frame of the scratch."""

    scratch: WaveScratch
    omega_o: vec3
    wavelength: real
    ratio: real  # width / wavelength
    peak: real  # |D|^2 W / (pi lambda), before M
    kind: int
    table_first: int
    table_count: int


@wp.struct
class Breaks:
    """Least and greatest u of what is seen of a light (``low`` >= ``high``: nothing), whether its width grows there as
    a square root or more gently, and the next u at which it has a corner (4: none)."""

    low: real
    high: real
    round_low: int
    round_high: int
    following: real


@wp.struct
class SliceSum:
    """What the crossings of one slice have added up to."""

    steps: int
    rest: real
    length: real
    anchor: real
    crossings: int


@wp.func
def make_lobe(s: WaveScratch, omega_o: vec3, wavelength: real, kind: int, table_first: int, table_count: int) -> Lobe:
    """The lobe of a scratch seen from ``omega_o`` (shading frame)."""
    r = Lobe()
    r.scratch = s
    r.omega_o = to_scratch(s, omega_o)
    r.wavelength = wavelength
    r.ratio = s.width / wavelength
    r.peak = r.ratio * depth_power(s, wavelength, TWO) / PI
    r.kind = kind
    r.table_first = table_first
    r.table_count = table_count
    return r


@wp.func
def integral_between(lobe: Lobe, tables: LobeTables, rules: Rules, u: real, psi0: real, psi1: real) -> real:
    """Integral over xi_2 of the lobe with its angle-dependent depth, from psi0 to psi1."""
    s = wp.sqrt(wp.max((ONE - u) * (ONE + u), ZERO))
    cycles = (lobe.ratio + lobe.scratch.depth / lobe.wavelength) * s * wp.abs(psi1 - psi0)
    panels = wp.max(int(wp.ceil(cycles / _PANEL)), 1)
    width = (psi1 - psi0) / real(panels)
    total = ZERO
    for i in range(panels):
        left = psi0 + width * real(i)
        for j in range(_PANEL_NODES):
            psi = left + width * rule_node(rules, _PANEL_NODES, j)
            height = s * wp.cos(psi)
            value = across_power(
                lobe.scratch,
                tables.outlines,
                lobe.wavelength,
                lobe.omega_o[1] + s * wp.sin(psi),
                lobe.omega_o[2] + height,
            )
            total += rule_weight(rules, _PANEL_NODES, j) * width * height * value
    return total


@wp.func
def tabled_integral(lobe: Lobe, tables: LobeTables, xi2: real) -> real:
    """The table at ``xi2`` by cubic Hermite interpolation; xi2 in [-2, 2]."""
    last = lobe.table_count - 1
    step = real(4.0) / real(last)
    at = wp.clamp((xi2 + TWO) / step, ZERO, real(last))
    cell = wp.min(int(at), last - 1)
    t = at - real(cell)
    a = tables.integrals[lobe.table_first + cell]
    b = tables.integrals[lobe.table_first + cell + 1]
    rise = b[0] - a[0]
    # the chord and what bends it to the two slopes
    bend = t * (ONE - t) * ((ONE - t) * (a[1] * step - rise) - t * (b[1] * step - rise))
    return a[0] + t * rise + bend


@wp.func
def add_crossing(
    acc: SliceSum, lobe: Lobe, tables: LobeTables, rules: Rules, u: real, across: real, height: real, sign: int
) -> SliceSum:
    """Count the crossing at (u, across, height): ``sign`` 1 where the light ends as psi grows, -1 where it begins (or
    the reverse throughout)."""
    r = acc
    factor = real(sign)
    xi2 = lobe.omega_o[1] + across
    r.length += factor * across
    if lobe.kind == EXACT:
        m = lobe_integral(lobe.ratio * xi2)
        r.steps += sign * m.half
        r.rest += factor * m.rest
    elif lobe.kind == PAPER:
        r.rest += factor * lobe_integral_paper(lobe.ratio * xi2)
    elif lobe.kind == TABLE:
        r.rest += factor * tabled_integral(lobe, tables, xi2)
    elif lobe.kind == NUMERIC:
        psi = wp.atan2(across, wp.max(height, ZERO))
        if r.crossings == 0:
            r.anchor = psi
        else:
            r.rest += factor * integral_between(lobe, tables, rules, u, r.anchor, psi)
    r.crossings += 1
    return r


@wp.func
def slice_value(acc: SliceSum, lobe: Lobe) -> real:
    """Integral over xi_2 of |W D|^2 / lambda^2 across the light; negative only for Eq. 29."""
    value = real(acc.steps) * HALF * PI + acc.rest
    if lobe.kind == EXACT or lobe.kind == PAPER:
        value *= lobe.peak
    # an outline that runs the other way round changes both signs
    value = wp.where(acc.length < ZERO, -value, value)
    if lobe.kind != PAPER:
        value = wp.max(value, ZERO)
    return value
