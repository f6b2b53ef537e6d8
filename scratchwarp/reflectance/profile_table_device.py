"""Reflectance of a scratch from its simulated table (Raymond 2016 Eq. 5).

With theta a reflector's table follows the model that the plan chose for it (``profiles.theta``): Raymond's power of
theta (Eq. 2, "gamma"), or parabolas through three of the equal steps of t = mu (1 + shift) / (mu + shift), mu =
cos(theta), of "quadratic" (2 steps) and "table" (16). Eq. 2 is off by up to a third of the light on exact metals at
steep theta; parabolas through 16 steps by 0.3 %, half of what straight lines are.

Between bins of phi_o the row is drawn at random with the weights of linear interpolation, so that value, density and
energy stay those of whole rows; the caller draws a row once for each shading point and uses it throughout.
"""

import warp as wp

wp.set_module_options({"enable_backward": False})


@wp.struct
class TableArrays:
    """All tables of a plan, M bins of phi each; rows of ``mirror`` are normalised to energy sum_i mirror w_i = 1."""

    bins: int
    mirror: wp.array3d(dtype=float)  # [table, phi_o, phi_i]
    slices: wp.array3d(dtype=wp.vec3)  # [phi_o, rows of all reflectors, phi_i]: rho_s, linear Rec.709
    first: wp.array(dtype=int)  # table -> its first row in ``slices``, the mirror; -1: a mirror throughout
    steps: wp.array(dtype=int)  # table -> steps from there to theta = 0; 0: Eq. 2, rows mirror, theta = 0, gamma
    shift: wp.array(dtype=float)  # table -> s of its steps
    cdf: wp.array3d(dtype=float)  # [table, phi_o, M + 1]
    sums: wp.array3d(dtype=wp.vec4)  # [phi_o, as slices, M + 1]: int rho cos from -pi/2, its luminance; may be empty
    first_sum: wp.array(dtype=int)  # table -> its first row in ``sums``


@wp.struct
class ConeSample:
    """A direction on the mirror cone: phi_i, its density in phi, and rho cos(phi_i) / density."""

    phi: float
    pdf: float
    weight: wp.vec3


@wp.func
def table_row(tables: TableArrays, phi_o: float, xi: float) -> int:
    """Row for ``phi_o``, one of the two nearest, with the probability of linear interpolation; xi in [0, 1)."""
    width = wp.pi / float(tables.bins)
    at = (phi_o + 0.5 * wp.pi) / width - 0.5
    return wp.clamp(int(wp.floor(at + xi)), 0, tables.bins - 1)


@wp.func
def bin_weight(tables: TableArrays, i: int) -> float:
    """Exact integral of cos(phi) over bin i."""
    width = wp.pi / float(tables.bins)
    center = -0.5 * wp.pi + (float(i) + 0.5) * width
    return 2.0 * wp.sin(0.5 * width) * wp.cos(center)


@wp.func
def table_value(tables: TableArrays, table: int, row: int, column: int, sin_theta: float) -> wp.vec3:
    """rho_s [1/rad] at a theta."""
    first = tables.first[table]
    if first < 0:
        mirror = tables.mirror[table, row, column]
        return wp.vec3(mirror, mirror, mirror)
    steps = tables.steps[table]
    if steps == 0:
        r = wp.asin(wp.clamp(wp.abs(sin_theta), 0.0, 1.0)) * (2.0 / wp.pi)
        g = tables.slices[row, first + 2, column]
        w = wp.vec3(wp.pow(r, g[0]), wp.pow(r, g[1]), wp.pow(r, g[2]))
        normal = tables.slices[row, first + 1, column]
        return normal + wp.cw_mul(w, tables.slices[row, first, column] - normal)
    mu = wp.sqrt(wp.max(1.0 - sin_theta * sin_theta, 0.0))
    shift = tables.shift[table]
    at = mu * (1.0 + shift) / (mu + shift) * float(steps)
    middle = wp.clamp(int(at + 0.5), 1, steps - 1)
    d = at - float(middle)
    value = (0.5 * d * (d - 1.0)) * tables.slices[row, first + middle - 1, column]
    value += (1.0 - d * d) * tables.slices[row, first + middle, column]
    value += (0.5 * d * (d + 1.0)) * tables.slices[row, first + middle + 1, column]
    return wp.vec3(wp.max(value[0], 0.0), wp.max(value[1], 0.0), wp.max(value[2], 0.0))


@wp.func
def phi_bin(tables: TableArrays, phi: float) -> int:
    """Bin that holds ``phi``."""
    return wp.clamp(int(wp.floor((phi + 0.5 * wp.pi) * float(tables.bins) / wp.pi)), 0, tables.bins - 1)


@wp.func
def table_pdf(tables: TableArrays, table: int, row: int, phi_i: float) -> float:
    """Density of ``table_sample`` [1/rad]."""
    i = phi_bin(tables, phi_i)
    share = tables.cdf[table, row, i + 1] - tables.cdf[table, row, i]
    return share * wp.max(wp.cos(phi_i), 0.0) / bin_weight(tables, i)


@wp.func
def table_sample(tables: TableArrays, table: int, row: int, sin_theta: float, u: float) -> ConeSample:
    """Draw phi_i by the inverse of the row's distribution, proportional to cos(phi_i) inside a bin."""
    low = int(0)
    high = int(tables.bins)
    while high - low > 1:
        middle = (low + high) // 2
        if tables.cdf[table, row, middle] <= u:
            low = middle
        else:
            high = middle
    c0 = tables.cdf[table, row, low]
    share = tables.cdf[table, row, low + 1] - c0
    sample = ConeSample()
    sample.pdf = 0.0
    sample.weight = wp.vec3(0.0, 0.0, 0.0)
    if share > 0.0:
        t = wp.clamp((u - c0) / share, 0.0, 1.0)
        width = wp.pi / float(tables.bins)
        left = -0.5 * wp.pi + float(low) * width
        # sin phi uniform between the bin's ends, written from the nearer end of the quarter turn to keep digits
        s0 = wp.sin(left)
        s1 = wp.sin(left + width)
        sample.phi = wp.clamp(wp.asin(wp.clamp(s0 + t * (s1 - s0), -1.0, 1.0)), left, left + width)
        weight = bin_weight(tables, low)
        sample.pdf = share * wp.max(wp.cos(sample.phi), 1.0e-7) / weight
        sample.weight = table_value(tables, table, row, low, sin_theta) * (weight / share)
    return sample


@wp.func
def cone_direction(u: wp.vec3, v: wp.vec3, n: wp.vec3, sin_theta: float, phi: float) -> wp.vec3:
    """omega = sin(theta) u + cos(theta) (sin(phi) v + cos(phi) n)."""
    cos_theta = wp.sqrt(wp.max(1.0 - sin_theta * sin_theta, 0.0))
    return sin_theta * u + cos_theta * (wp.sin(phi) * v + wp.cos(phi) * n)
