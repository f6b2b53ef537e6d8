"""Kernel behind ``masking``: one thread a pair of angles and a facet, in float64."""

import warp as wp

from .masking_device import Section, seen_fraction

wp.set_module_options({"enable_backward": False})


@wp.kernel
def fractions(
    section: Section,
    direction_o: wp.array(dtype=wp.vec2d),
    direction_i: wp.array(dtype=wp.vec2d),
    jointly: int,
    facets: wp.array(dtype=int),
    out: wp.array2d(dtype=wp.float64),
):
    """Seen (and lit) share of the base line, a row a pair of directions, a column an entry of ``facets``."""
    row, column = wp.tid()
    out[row, column] = seen_fraction(section, facets[column], direction_o[row], direction_i[row], jointly)
