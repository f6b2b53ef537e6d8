"""Owen-scrambled Sobol points of any number of dimensions, padded from pairs: no tables, no state.

Each pair of dimensions is the two-dimensional Sobol (0, 2)-sequence with its own shuffled index and its own nested
uniform scrambling, both by hashing. Any aligned block of 2^m indices puts one point in every elementary interval of
area 2^-m; different pairs are independent of one another. A point depends on (seed, index, dimension) alone.

Sources: Owen 1995 (nested uniform scrambling); Laine and Karras 2011 (a hash whose bits depend on lower bits alone,
applied to reversed bits, is such a scrambling); Burley 2020, "Practical Hash-based Owen Scrambling" (shuffling the
index, padding); the constants of the permutation are those that Vegdahl found. The second Sobol dimension applies
Pascal's triangle modulo 2 to the bits of the index; as that matrix is the fifth Kronecker power of [[1, 1], [0, 1]],
five masked shifts do it.
"""

import warp as wp

from scratchwarp.optics.hash_device import hash_combine, pcg_hash, unit_float

_M1 = wp.constant(wp.uint32(0x55555555))
_M2 = wp.constant(wp.uint32(0x33333333))
_M4 = wp.constant(wp.uint32(0x0F0F0F0F))
_M8 = wp.constant(wp.uint32(0x00FF00FF))
_P1 = wp.constant(wp.uint32(0x3D20ADEA))
_P2 = wp.constant(wp.uint32(0x05526C56))
_P3 = wp.constant(wp.uint32(0x53A22864))
_ONE_DIMENSIONAL = wp.constant(wp.uint32(0x8E2D7A51))  # keeps 1D dimensions apart from pairs of the same number


@wp.func
def reverse_bits(x: wp.uint32) -> wp.uint32:
    """The 32 bits in the opposite order."""
    y = ((x >> wp.uint32(1)) & _M1) | ((x & _M1) << wp.uint32(1))
    y = ((y >> wp.uint32(2)) & _M2) | ((y & _M2) << wp.uint32(2))
    y = ((y >> wp.uint32(4)) & _M4) | ((y & _M4) << wp.uint32(4))
    y = ((y >> wp.uint32(8)) & _M8) | ((y & _M8) << wp.uint32(8))
    return (y >> wp.uint32(16)) | (y << wp.uint32(16))


@wp.func
def permute_upwards(x: wp.uint32, seed: wp.uint32) -> wp.uint32:
    """A permutation of the integers in which each bit depends on lower bits alone (Laine-Karras)."""
    y = x ^ (x * _P1)
    y = (y + seed) * ((seed >> wp.uint32(16)) | wp.uint32(1))
    y = y ^ (y * _P2)
    return y ^ (y * _P3)


@wp.func
def owen_scramble(x: wp.uint32, seed: wp.uint32) -> wp.uint32:
    """Nested uniform scrambling of a 32-bit fraction: each bit is flipped or not, depending on the bits above it."""
    return reverse_bits(permute_upwards(reverse_bits(x), seed))


@wp.func
def pascal_bits(radical_inverse: wp.uint32) -> wp.uint32:
    """Second Sobol coordinate from the first (the reversed index), as 32-bit fractions."""
    y = radical_inverse ^ (radical_inverse << wp.uint32(16))
    y = y ^ ((y & _M8) << wp.uint32(8))
    y = y ^ ((y & _M4) << wp.uint32(4))
    y = y ^ ((y & _M2) << wp.uint32(2))
    return y ^ ((y & _M1) << wp.uint32(1))


@wp.func
def sobol_1d(index: wp.uint32, dimension: int, seed: wp.uint32) -> float:
    """Point ``index`` of one-dimensional stream ``dimension``, in [0, 1)."""
    key = hash_combine(seed ^ _ONE_DIMENSIONAL, wp.uint32(dimension))
    first = permute_upwards(reverse_bits(index), key)
    return unit_float(owen_scramble(first, pcg_hash(key)))


@wp.func
def sobol_2d(index: wp.uint32, pair: int, seed: wp.uint32) -> wp.vec2:
    """Point ``index`` of two-dimensional stream ``pair``, in [0, 1)^2."""
    key = hash_combine(seed, wp.uint32(pair))
    first = permute_upwards(reverse_bits(index), key)
    second = pascal_bits(first)
    key_x = pcg_hash(key)
    key_y = pcg_hash(key_x)
    return wp.vec2(unit_float(owen_scramble(first, key_x)), unit_float(owen_scramble(second, key_y)))
