"""Drawing directions for a measured BRDF: by a table of half vectors, a quarter of them by the cosine.

Rows of the table are even in the square root of the angle to the normal, so that highlights as narrow as a hundredth of
a degree have cells of their own; inside a cell half vectors are uniform in solid angle.
"""

import warp as wp

from ...optics.microfacets_device import half_vector
from ...optics.sampling_device import sample_cosine_hemisphere

wp.set_module_options({"enable_backward": False})

_INV_PI = wp.constant(0.3183098861837907)
_COSINE_SHARE = wp.constant(0.25)
_HALF_PI = wp.constant(1.5707963267948966)


@wp.struct
class HalfTable:
    """``rows [R + 1]`` and ``columns [R, C + 1]``: cumulative probabilities of rows, and of columns in each row.

    ``limit [theta, phi]``: the factor that energy allows views at cos theta = (1 - row / (rows - 1))^2."""

    rows: wp.array(dtype=float)
    columns: wp.array2d(dtype=float)
    limit: wp.array2d(dtype=float)


@wp.func
def half_cell_pdf(table: HalfTable, h: wp.vec3) -> float:
    """Density of half vectors [1/sr]."""
    rows = table.columns.shape[0]
    count = table.columns.shape[1] - 1
    angle = wp.atan2(wp.sqrt(h[0] * h[0] + h[1] * h[1]), h[2])
    row = wp.clamp(int(wp.sqrt(wp.max(angle, 0.0) / _HALF_PI) * float(rows)), 0, rows - 1)
    turn = wp.atan2(h[1], h[0]) / (2.0 * wp.pi)
    column = wp.clamp(int((turn - wp.floor(turn)) * float(count)), 0, count - 1)
    share = (table.rows[row + 1] - table.rows[row]) * (table.columns[row, column + 1] - table.columns[row, column])
    # cos a - cos b by the product of sines, without cancellation near the pole
    a = float(row) / float(rows)
    b = float(row + 1) / float(rows)
    a = _HALF_PI * a * a
    b = _HALF_PI * b * b
    area = 2.0 * wp.sin(0.5 * (a + b)) * wp.sin(0.5 * (b - a)) * 2.0 * wp.pi / float(count)
    return share / area


@wp.func
def half_pdf(table: HalfTable, wo: wp.vec3, wi: wp.vec3) -> float:
    """Density with which ``half_sample`` finds ``wi`` [1/sr]; both above the horizon."""
    h = half_vector(wo, wi)
    facets = 0.25 * half_cell_pdf(table, h) / wp.max(wp.dot(h, wo), 1.0e-6)
    return (1.0 - _COSINE_SHARE) * facets + _COSINE_SHARE * _INV_PI * wi[2]


@wp.func
def half_sample(table: HalfTable, wo: wp.vec3, u: wp.vec2, v: float) -> wp.vec3:
    """Draw a direction; perhaps one below the horizon."""
    result = sample_cosine_hemisphere(u)
    if v >= _COSINE_SHARE:
        rows = table.columns.shape[0]
        count = table.columns.shape[1] - 1
        low = int(0)
        high = int(rows)
        while high - low > 1:
            middle = (low + high) // 2
            if table.rows[middle] <= u[0]:
                low = middle
            else:
                high = middle
        row = low
        fy = (u[0] - table.rows[row]) / wp.max(table.rows[row + 1] - table.rows[row], 1.0e-20)
        low = int(0)
        high = int(count)
        while high - low > 1:
            middle = (low + high) // 2
            if table.columns[row, middle] <= u[1]:
                low = middle
            else:
                high = middle
        fx = (u[1] - table.columns[row, low]) / wp.max(table.columns[row, low + 1] - table.columns[row, low], 1.0e-20)
        a = float(row) / float(rows)
        b = float(row + 1) / float(rows)
        # 1 - z = 2 sin^2(angle / 2), uniform between the edges
        sa = wp.sin(0.5 * _HALF_PI * a * a)
        sb = wp.sin(0.5 * _HALF_PI * b * b)
        down = 2.0 * (sa * sa + wp.clamp(fy, 0.0, 1.0) * (sb * sb - sa * sa))
        r = wp.sqrt(wp.max(down * (2.0 - down), 0.0))
        phi = (float(low) + wp.clamp(fx, 0.0, 1.0)) / float(count) * 2.0 * wp.pi
        h = wp.vec3(r * wp.cos(phi), r * wp.sin(phi), 1.0 - down)
        facing = wp.dot(h, wo)
        result = wp.vec3(0.0, 0.0, -1.0)
        if facing > 0.0:
            result = wp.normalize(2.0 * facing * h - wo)
    return result
