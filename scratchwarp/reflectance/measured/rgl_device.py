"""A BRDF in the adaptive parameterisation of RGL, interpolated on the device.

Dupuy and Jakob 2018: the half vector is brought by the distribution of visible normals to the unit square, in which
the measurement is a smooth image; f_r cos(theta_o) = image D / (4 sigma(omega_i)). All tables are bilinear on the unit
square, x by sqrt(2 theta / pi), y by phi over a full turn, and linear in the incident angles.
"""

import warp as wp

from ...optics.microfacets_device import half_vector

wp.set_module_options({"enable_backward": False})

_LEAST_COSINE = wp.constant(1.0e-3)


@wp.struct
class RglBrdf:
    """Tables of a file; slices are numbered phi_i * thetas + theta_i.

    ``vndf`` is scaled so that ``conditional`` (running integrals along x) and ``marginal`` (their running integrals
    along y) end at 1. ``turn`` 2 or 4: only directions of a half or a quarter turn of phi_i were measured, the rest
    follows by symmetry.
    """

    phi: wp.array(dtype=float)
    theta: wp.array(dtype=float)
    ndf: wp.array2d(dtype=float)
    sigma: wp.array2d(dtype=float)
    vndf: wp.array3d(dtype=float)
    conditional: wp.array3d(dtype=float)
    marginal: wp.array2d(dtype=float)
    rgb: wp.array3d(dtype=wp.vec3)
    isotropic: int
    turn: int


@wp.struct
class Slices:
    """Four slices around the incident direction and their weights."""

    number: wp.vec4i
    weight: wp.vec4


@wp.struct
class Cell:
    """A cell of a table over the unit square and the place in it."""

    x: int
    y: int
    fx: float
    fy: float


@wp.func
def interval(nodes: wp.array(dtype=float), value: float) -> int:
    """Number of the interval of ascending ``nodes`` that holds ``value``, the first or the last beyond them."""
    low = int(0)
    high = nodes.shape[0] - 1
    while high - low > 1:
        middle = (low + high) // 2
        if nodes[middle] <= value:
            low = middle
        else:
            high = middle
    return low


@wp.func
def share(nodes: wp.array(dtype=float), low: int, value: float) -> float:
    """How far ``value`` lies through interval ``low``, in [0, 1]."""
    f = float(0.0)
    if nodes.shape[0] > 1:
        f = wp.clamp((value - nodes[low]) / wp.max(nodes[low + 1] - nodes[low], 1.0e-12), 0.0, 1.0)
    return f


@wp.func
def slices_at(brdf: RglBrdf, phi: float, theta: float) -> Slices:
    """The slices to interpolate between."""
    p = interval(brdf.phi, phi)
    t = interval(brdf.theta, theta)
    fp = share(brdf.phi, p, phi)
    ft = share(brdf.theta, t, theta)
    q = wp.min(p + 1, brdf.phi.shape[0] - 1)
    u = wp.min(t + 1, brdf.theta.shape[0] - 1)
    n = brdf.theta.shape[0]
    s = Slices()
    s.number = wp.vec4i(p * n + t, p * n + u, q * n + t, q * n + u)
    s.weight = wp.vec4((1.0 - fp) * (1.0 - ft), (1.0 - fp) * ft, fp * (1.0 - ft), fp * ft)
    return s


@wp.func
def cell_at(width: int, height: int, x: float, y: float) -> Cell:
    """The cell of a table of ``height`` rows of ``width`` that holds a point of the unit square."""
    c = Cell()
    px = wp.clamp(x, 0.0, 1.0) * float(width - 1)
    py = wp.clamp(y, 0.0, 1.0) * float(height - 1)
    c.x = wp.clamp(int(px), 0, width - 2)
    c.y = wp.clamp(int(py), 0, height - 2)
    c.fx = px - float(c.x)
    c.fy = py - float(c.y)
    return c


@wp.func
def blend(table: wp.array3d(dtype=float), s: Slices, y: int, x: int) -> float:
    """An entry between slices."""
    v = float(0.0)
    for i in range(4):
        v += s.weight[i] * table[s.number[i], y, x]
    return v


@wp.func
def blend_marginal(table: wp.array2d(dtype=float), s: Slices, y: int) -> float:
    """An entry of the marginal between slices."""
    v = float(0.0)
    for i in range(4):
        v += s.weight[i] * table[s.number[i], y]
    return v


@wp.func
def bilinear(table: wp.array2d(dtype=float), x: float, y: float) -> float:
    """A table at a point of the unit square."""
    c = cell_at(table.shape[1], table.shape[0], x, y)
    top = (1.0 - c.fx) * table[c.y, c.x] + c.fx * table[c.y, c.x + 1]
    bottom = (1.0 - c.fx) * table[c.y + 1, c.x] + c.fx * table[c.y + 1, c.x + 1]
    return (1.0 - c.fy) * top + c.fy * bottom


@wp.func
def to_square(brdf: RglBrdf, s: Slices, x: float, y: float) -> wp.vec2:
    """Where the distribution of visible normals takes a half vector: the two distribution functions."""
    width = brdf.vndf.shape[2]
    c = cell_at(width, brdf.vndf.shape[1], x, y)
    left = (1.0 - c.fy) * blend(brdf.vndf, s, c.y, c.x) + c.fy * blend(brdf.vndf, s, c.y + 1, c.x)
    right = (1.0 - c.fy) * blend(brdf.vndf, s, c.y, c.x + 1) + c.fy * blend(brdf.vndf, s, c.y + 1, c.x + 1)
    before = (1.0 - c.fy) * blend(brdf.conditional, s, c.y, c.x) + c.fy * blend(brdf.conditional, s, c.y + 1, c.x)
    row = blend(brdf.conditional, s, c.y, width - 1)
    below = blend(brdf.conditional, s, c.y + 1, width - 1)
    u = before + c.fx * (left + 0.5 * c.fx * (right - left))
    u = u / wp.max((1.0 - c.fy) * row + c.fy * below, 1.0e-20)
    v = blend_marginal(brdf.marginal, s, c.y) + c.fy * (row + 0.5 * c.fy * (below - row))
    return wp.vec2(u, v)


@wp.func
def rgl_eval(brdf: RglBrdf, light: wp.vec3, view: wp.vec3) -> wp.vec3:
    """f_r [1/sr] for directions above the horizon."""
    wi = light
    wo = view
    if brdf.turn >= 2:
        # into the part of the azimuths that was measured: y <= 0, for a quarter also x <= 0
        flip_y = wp.where(wi[1] > 0.0, -1.0, 1.0)
        flip_x = flip_y
        if brdf.turn == 4:
            flip_x = wp.where(wi[0] > 0.0, -1.0, 1.0)
        wi = wp.vec3(flip_x * wi[0], flip_y * wi[1], wi[2])
        wo = wp.vec3(flip_x * wo[0], flip_y * wo[1], wo[2])
    h = half_vector(wo, wi)
    theta = wp.atan2(wp.sqrt(wi[0] * wi[0] + wi[1] * wi[1]), wi[2])
    phi = wp.atan2(wi[1], wi[0])
    turned = wp.atan2(h[1], h[0]) - wp.where(brdf.isotropic == 1, phi, 0.0)
    x = wp.sqrt(wp.atan2(wp.sqrt(h[0] * h[0] + h[1] * h[1]), h[2]) * (2.0 / wp.pi))
    y = 0.5 * turned / wp.pi + 0.5
    y = y - wp.floor(y)
    s = slices_at(brdf, phi, theta)
    at = to_square(brdf, s, x, y)
    c = cell_at(brdf.rgb.shape[2], brdf.rgb.shape[1], at[0], at[1])
    f = wp.vec3(0.0, 0.0, 0.0)
    for i in range(4):
        k = s.number[i]
        top = (1.0 - c.fx) * brdf.rgb[k, c.y, c.x] + c.fx * brdf.rgb[k, c.y, c.x + 1]
        bottom = (1.0 - c.fx) * brdf.rgb[k, c.y + 1, c.x] + c.fx * brdf.rgb[k, c.y + 1, c.x + 1]
        f += s.weight[i] * ((1.0 - c.fy) * top + c.fy * bottom)
    projected = bilinear(brdf.sigma, wp.sqrt(theta * (2.0 / wp.pi)), 0.5 * phi / wp.pi + 0.5)
    scale = bilinear(brdf.ndf, x, y) / wp.max(4.0 * projected * wp.max(wo[2], _LEAST_COSINE), 1.0e-20)
    return scale * wp.vec3(wp.max(f[0], 0.0), wp.max(f[1], 0.0), wp.max(f[2], 0.0))
