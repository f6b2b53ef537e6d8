"""Integer hashing on the device, for seeds and for random numbers that depend on nothing but their key.

Source: the permuted congruential output function of O'Neill 2014 (PCG, RXS-M-XS), used as a hash as Jarzynski and Olano
2020 recommend ("Hash Functions for GPU Rendering").
"""

import warp as wp

_PCG_MULTIPLIER = wp.constant(wp.uint32(747796405))
_PCG_INCREMENT = wp.constant(wp.uint32(2891336453))
_PCG_OUTPUT = wp.constant(wp.uint32(277803737))


@wp.func
def pcg_hash(value: wp.uint32) -> wp.uint32:
    """A well mixed permutation of the 32-bit integers."""
    state = value * _PCG_MULTIPLIER + _PCG_INCREMENT
    word = ((state >> ((state >> wp.uint32(28)) + wp.uint32(4))) ^ state) * _PCG_OUTPUT
    return (word >> wp.uint32(22)) ^ word


@wp.func
def hash_combine(seed: wp.uint32, value: wp.uint32) -> wp.uint32:
    """A new seed from a seed and a number; the order of successive numbers matters."""
    return pcg_hash(pcg_hash(seed) + value)


@wp.func
def pixel_seed(x: int, y: int, seed: wp.uint32) -> wp.uint32:
    """Seed of pixel (x, y), negative coordinates included, for a frame ``seed``: the same for any tiling."""
    return hash_combine(hash_combine(seed, wp.uint32(x)), wp.uint32(y))


@wp.func
def unit_float(bits: wp.uint32) -> float:
    """The top 24 bits as a float32 in [0, 1), every value exact."""
    return float(bits >> wp.uint32(8)) * 5.9604644775390625e-8
