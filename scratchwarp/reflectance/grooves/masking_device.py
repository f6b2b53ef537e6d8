"""What of each facet of a cross-section is seen from one direction, or from two at once: exact, by intervals.

A facet runs from vertex j to j + 1 of a polyline with the solid on its right. Across a direction d every vertex has a
position s and along it a position r. A facet is turned to d when its s grows; another facet hides it over the part of
their common s where its r is the larger one. What is hidden from either direction is a union of intervals on the
facet; what is left is seen and lit. Height fields, walls and overhangs are all the same to this rule.

In a periodic surface only the two neighbouring periods can hide: a ray that crosses one whole period in the air has all
of that period's polyline below it, and so the next one's, for the ray rises. (Where a section is wider inside than at
its ends, as many more as it reaches into.)
"""

import warp as wp

wp.set_module_options({"enable_backward": False})


@wp.struct
class Section:
    """One polyline: vertices ``points[first]`` to ``points[first + count - 1]``.

    ``period`` is 0 when it is alone; ``reach``: how many periods to either side may hide it.
    """

    points: wp.array(dtype=wp.vec2d)
    first: int
    count: int
    period: wp.float64
    reach: int


@wp.func
def across(p: wp.vec2d, d: wp.vec2d) -> wp.float64:
    """Position of ``p`` across direction ``d``, growing with x seen from above."""
    return p[0] * d[1] - p[1] * d[0]


@wp.func
def hidden_part(a: wp.vec2d, b: wp.vec2d, p: wp.vec2d, q: wp.vec2d, d: wp.vec2d) -> wp.vec2d:
    """The part (t0, t1) of facet ``a b``, turned to ``d``, that facet ``p q`` hides; t0 > t1 when there is none."""
    zero = wp.float64(0.0)
    one = wp.float64(1.0)
    none = wp.vec2d(one, zero)
    result = none
    s_a = across(a, d)
    s_b = across(b, d)
    s_p = across(p, d)
    s_q = across(q, d)
    low = wp.max(s_a, wp.min(s_p, s_q))
    high = wp.min(s_b, wp.max(s_p, s_q))
    if high > low:
        # how far the other facet is in front, at both ends of the common part
        t0 = (low - s_a) / (s_b - s_a)
        t1 = (high - s_a) / (s_b - s_a)
        w0 = (low - s_p) / (s_q - s_p)
        w1 = (high - s_p) / (s_q - s_p)
        front0 = wp.dot(p + w0 * (q - p) - a - t0 * (b - a), d)
        front1 = wp.dot(p + w1 * (q - p) - a - t1 * (b - a), d)
        if front0 > zero and front1 > zero:
            result = wp.vec2d(t0, t1)
        elif front0 > zero:
            result = wp.vec2d(t0, t0 + (t1 - t0) * front0 / (front0 - front1))
        elif front1 > zero:
            result = wp.vec2d(t0 + (t1 - t0) * front0 / (front0 - front1), t1)
    return result


@wp.func
def hidden_from(section: Section, facet: int, other: int, shift: int, d: wp.vec2d) -> wp.vec2d:
    """``hidden_part`` for facets of a section, the other one moved by ``shift`` periods."""
    a = section.points[section.first + facet]
    b = section.points[section.first + facet + 1]
    move = wp.vec2d(section.period * wp.float64(shift), wp.float64(0.0))
    p = section.points[section.first + other] + move
    q = section.points[section.first + other + 1] + move
    result = wp.vec2d(wp.float64(1.0), wp.float64(0.0))
    if other != facet or shift != 0:
        result = hidden_part(a, b, p, q, d)
    return result


@wp.func
def is_turned_to(section: Section, facet: int, d: wp.vec2d) -> bool:
    """Whether the facet's outer side faces direction ``d``."""
    return across(section.points[section.first + facet + 1], d) > across(section.points[section.first + facet], d)


@wp.func
def next_free(section: Section, facet: int, d_o: wp.vec2d, d_i: wp.vec2d, jointly: int, start: wp.float64) -> wp.vec2d:
    """The first part (t0, t1) of the facet at or after ``start`` that nothing hides; t0 >= 1 when there is none.

    ``jointly`` 1: hidden neither from ``d_o`` nor from ``d_i``. Both must see the facet's outer side.
    """
    one = wp.float64(1.0)
    reach = section.reach
    t0 = start
    t1 = wp.float64(1.0)
    searching = int(1)
    while searching == 1:
        searching = int(0)
        t1 = wp.float64(1.0)
        for shift in range(-reach, reach + 1):
            for other in range(section.count - 1):
                hidden = hidden_from(section, facet, other, shift, d_o)
                if hidden[0] <= t0 and hidden[1] > t0:
                    t0 = hidden[1]
                    searching = 1
                elif hidden[0] > t0 and hidden[0] < hidden[1]:
                    t1 = wp.min(t1, hidden[0])
                if jointly == 1:
                    dark = hidden_from(section, facet, other, shift, d_i)
                    if dark[0] <= t0 and dark[1] > t0:
                        t0 = dark[1]
                        searching = 1
                    elif dark[0] > t0 and dark[0] < dark[1]:
                        t1 = wp.min(t1, dark[0])
        if t0 >= one:
            searching = 0
    return wp.vec2d(t0, wp.max(t0, t1))


@wp.func
def base_line(p: wp.vec2d, d: wp.vec2d) -> wp.float64:
    """Where the ray through ``p`` along ``d`` meets the line z = 0."""
    return p[0] - p[1] * d[0] / d[1]


@wp.func
def seen_fraction(section: Section, facet: int, d_o: wp.vec2d, d_i: wp.vec2d, jointly: int) -> wp.float64:
    """Share of the base line, from the first to the last vertex's x, through which ``d_o`` sees the facet.

    ``jointly`` 1: and where ``d_i`` lights it. Directions are (sine, cosine) from the normal, cosine > 0.
    """
    zero = wp.float64(0.0)
    one = wp.float64(1.0)
    total = wp.float64(0.0)
    x_first = section.points[section.first][0]
    x_last = section.points[section.first + section.count - 1][0]
    turned = is_turned_to(section, facet, d_o)
    if jointly == 1:
        turned = turned and is_turned_to(section, facet, d_i)
    if turned:
        b0 = base_line(section.points[section.first + facet], d_o)
        b1 = base_line(section.points[section.first + facet + 1], d_o)
        t = wp.float64(0.0)
        while t < one:
            free = next_free(section, facet, d_o, d_i, jointly, t)
            low = b0 + free[0] * (b1 - b0)
            high = b0 + wp.min(free[1], one) * (b1 - b0)
            if section.period == zero:
                low = wp.max(low, x_first)
                high = wp.min(high, x_last)
            if free[0] < one:
                total += wp.max(high - low, zero)
            t = free[1]
            if free[1] <= free[0]:
                t = one
    return total / (x_last - x_first)
