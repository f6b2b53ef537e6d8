"""Where a ray in the plane of the cross-section goes next: device functions on an outline of flat facets and
parabolic arcs.

The outline is scaled to period 1 with its base line at z = 0. Which facet is hit is decided by the sides on which its
two end points lie, the same numbers for neighbouring facets, so that no ray slips through a vertex; the facet just
left is excluded by its index. No length enters as a tolerance, and the hit point lies on the facet by construction.
"""

import warp as wp

wp.set_module_options({"enable_backward": False})

ESCAPED = wp.constant(-1)
GROUND = wp.constant(-2)
ASTRAY = wp.constant(-3)


@wp.struct
class Outline:
    """An outline from left to right, x in [0, 1], z <= 0."""

    vertex: wp.array(dtype=wp.vec2)  # [n + 1]
    rise: wp.array(dtype=wp.vec2)  # [n] half the first derivative at the facet's start: control point minus start
    bend: wp.array(dtype=wp.vec2)  # [n] half the second derivative: start - 2 control + end, zero when flat
    turn: wp.array(dtype=int)  # [n] 0 flat, 1 cup, -1 hump
    normal: wp.array(dtype=wp.vec2)  # [n] unit normal of the chord
    # left, right and top of each run of ``group`` facets, which a ray may pass over at once
    box: wp.array(dtype=wp.vec3)
    concave: wp.array(dtype=int)  # [n + 1] whether the two facets at a vertex face each other
    start: wp.array(dtype=int)  # [cells] the facet under x = cell / cells
    group: int  # a power of two
    ground: float  # height of the flat ground beside an isolated profile
    isolated: int
    height_field: int


@wp.func
def cross2(a: wp.vec2, b: wp.vec2) -> float:
    """Positive where b lies counter-clockwise of a."""
    return a[0] * b[1] - a[1] * b[0]


@wp.func
def on_facet(outline: Outline, k: int, t: float) -> wp.vec2:
    """The point at parameter t in [0, 1] of facet k."""
    return outline.vertex[k] + 2.0 * t * outline.rise[k] + t * t * outline.bend[k]


@wp.func
def upward_root(s0: float, s1: float, rise: float, bend: float) -> float:
    """Parameter where s(t) = s0 + 2 rise t + bend t^2 goes from below 0 to above; -1 where it does not in [0, 1]."""
    t = float(-1.0)
    if bend == 0.0:
        if s1 > s0:
            t = wp.clamp(-s0 / (s1 - s0), 0.0, 1.0)
    else:
        root2 = rise * rise - bend * s0
        # a crossing that the signs at the ends promise is kept whatever rounding does
        promised = s0 <= 0.0 and s1 > 0.0
        if root2 >= 0.0 or promised:
            root = wp.sqrt(wp.max(root2, 0.0))
            if rise > 0.0:
                t = -s0 / (rise + root)
            else:
                t = (root - rise) / bend
            if promised:
                t = wp.clamp(t, 0.0, 1.0)
            if t > 1.0:
                t = -1.0
    return t


@wp.func
def meets(outline: Outline, k: int, o: wp.vec2, d: wp.vec2, s0: float, s1: float) -> float:
    """Parameter at which the line from o along d meets the front of facet k, or -1; s0 and s1 are the sides of its
    ends."""
    t = float(-1.0)
    if s0 <= 0.0 and s1 > 0.0:
        if outline.turn[k] == 0:
            t = wp.clamp(s0 / (s0 - s1), 0.0, 1.0)
        else:
            t = upward_root(s0, s1, cross2(d, outline.rise[k]), cross2(d, outline.bend[k]))
    elif outline.turn[k] < 0:
        # a hump may stand up between two ends that the ray clears
        rise = cross2(d, outline.rise[k])
        middle = s0 + rise
        if (d[0] >= 0.0 and s1 <= 0.0 and middle > 0.0) or (d[0] < 0.0 and s0 > 0.0 and middle <= 0.0):
            t = upward_root(s0, s1, rise, cross2(d, outline.bend[k]))
    return t


@wp.func
def entry_facet(outline: Outline, x: float) -> int:
    """The facet of a height field under x in [0, 1]."""
    cells = outline.start.shape[0]
    last = outline.vertex.shape[0] - 2
    k = outline.start[wp.min(int(x * float(cells)), cells - 1)]
    while k < last and outline.vertex[k + 1][0] <= x:
        k += 1
    return k


@wp.func
def march(outline: Outline, o: wp.vec2, d: wp.vec2, k: int, t: float):
    """Next hit of a ray on a height field, cell by cell: (facet, parameter, periods crossed).

    o is on facet k at t, or on the base line above facet k where t < 0. facet is ESCAPED, GROUND or ASTRAY where none
    is hit.
    """
    count = outline.vertex.shape[0] - 1
    leaving = t >= 0.0
    hit = int(-1)
    where = float(-1.0)
    shift = float(0.0)
    rightward = d[0] >= 0.0
    done = bool(False)
    j = k
    if leaving:
        if outline.turn[k] > 0:
            # the other crossing of the same arc; the one at t is known, so only a linear equation is left
            bend = cross2(d, outline.bend[k])
            if bend != 0.0:
                slope = cross2(d, outline.rise[k] + t * outline.bend[k])
                other = t - 2.0 * slope / bend
                if (rightward and other > t and other <= 1.0) or (not rightward and other < t and other >= 0.0):
                    hit = k
                    where = other
                    done = True
        if not done:
            j = wp.where(rightward, k + 1, k - 1)
    near = float(0.0)
    fresh = bool(True)
    turns = int(0)
    mask = outline.group - 1
    first = wp.where(rightward, 0, mask)
    stride = wp.where(rightward, outline.group, -outline.group)
    p = o
    while not done:
        if j < 0 or j >= count:
            # over the side: out above the base line, onto the ground, or into the neighbouring period
            edge = wp.where(rightward, 1.0, 0.0)
            z = p[1] + (edge - p[0]) * d[1] / wp.where(d[0] == 0.0, 1.0e-30, d[0])
            turns += 1
            if outline.isolated != 0:
                hit = wp.where(d[1] < 0.0, GROUND, ESCAPED)
                done = True
            elif d[1] >= 0.0 and z >= 0.0:
                hit = ESCAPED
                done = True
            elif turns > 64:
                hit = ASTRAY
                done = True
            else:
                step = wp.where(rightward, 1.0, -1.0)
                shift += step
                p = wp.vec2(o[0] - shift, o[1])
                j = wp.where(rightward, 0, count - 1)
                fresh = True
        clear = bool(False)
        if not done and (j & mask) == first:
            box = outline.box[j / outline.group]
            one = cross2(d, wp.vec2(box[0], box[2]) - p)
            two = cross2(d, wp.vec2(box[1], box[2]) - p)
            clear = wp.where(rightward, wp.max(one, two) <= 0.0, wp.min(one, two) > 0.0)
        if clear:
            j += stride
            fresh = True
        elif not done:
            if fresh:
                near = cross2(d, outline.vertex[wp.where(rightward, j, j + 1)] - p)
                fresh = False
            far = cross2(d, outline.vertex[wp.where(rightward, j + 1, j)] - p)
            above = wp.where(rightward, far > 0.0, far <= 0.0)
            if above or outline.turn[j] < 0:
                s0 = wp.where(rightward, near, far)
                s1 = wp.where(rightward, far, near)
                if above:
                    # rounding may put the near end on the wrong side too; it is then where the ray goes in
                    s0 = wp.min(s0, 0.0)
                    s1 = wp.max(s1, 1.0e-30)
                where = meets(outline, j, p, d, s0, s1)
                if where >= 0.0:
                    hit = j
                    done = True
            near = far
            j = wp.where(rightward, j + 1, j - 1)
    return hit, where, shift


@wp.func
def search(outline: Outline, o: wp.vec2, d: wp.vec2, k: int, t: float):
    """As ``march`` for any outline of flat facets: every facet is tested and the nearest front taken.

    A facet next to the one just left is met whenever the vertex between them is concave, the ray comes from its front
    and its far end lies beyond the ray: neither the sign of the distance nor the side of the shared vertex, both near
    zero in a corner, is asked for.
    """
    count = outline.vertex.shape[0] - 1
    hit = int(-1)
    where = float(-1.0)
    shift = float(0.0)
    left = wp.where(t >= 0.0, k, -9)
    entering = t < 0.0
    p = o
    done = bool(False)
    turns = int(0)
    while not done:
        nearest = float(1.0e30)
        near = cross2(d, outline.vertex[0] - p)
        for j in range(count):
            far = cross2(d, outline.vertex[j + 1] - p)
            begins = near <= 0.0
            ends = far > 0.0
            ahead = j != left
            if j == left - 1:
                ahead = outline.concave[left] != 0
                ends = True
            if j == left + 1:
                ahead = outline.concave[j] != 0
                begins = True
            if ahead and begins and ends and far > near:
                u = wp.clamp(near / (near - far), 0.0, 1.0)
                distance = wp.dot(d, on_facet(outline, j, u) - p)
                # nothing is above the base line, so a ray that comes from there meets every facet ahead of it
                beside = j == left - 1 or j == left + 1
                if (distance >= 0.0 or entering or beside) and distance < nearest:
                    nearest = distance
                    hit = j
                    where = u
            near = far
        turns += 1
        if hit >= 0:
            done = True
        else:
            edge = wp.where(d[0] >= 0.0, 1.0, 0.0)
            z = p[1] + (edge - p[0]) * d[1] / wp.where(d[0] == 0.0, 1.0e-30, d[0])
            if d[1] >= 0.0 and z >= 0.0:
                hit = ESCAPED
                done = True
            elif outline.isolated != 0:
                hit = wp.where(d[1] < 0.0, GROUND, ESCAPED)
                done = True
            elif turns > 64:
                hit = ASTRAY
                done = True
            else:
                shift += wp.where(d[0] >= 0.0, 1.0, -1.0)
                p = wp.vec2(o[0] - shift, o[1])
                left = wp.where(left == count - 1 and d[0] >= 0.0, -1, wp.where(left == 0 and d[0] < 0.0, count, -9))
    return hit, where, shift
