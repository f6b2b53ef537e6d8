"""Cumulative distributions on the device."""

import warp as wp


@wp.func
def interval_of(cdf: wp.array[float], first: int, count: int, u: float) -> int:
    """The i in [0, count) with cdf[first + i] <= u < cdf[first + i + 1]; never an empty interval unless all are."""
    low = int(0)
    high = int(count)
    while high - low > 1:
        middle = (low + high) // 2
        if cdf[first + middle] <= u:
            low = middle
        else:
            high = middle
    return low
