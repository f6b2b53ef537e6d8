"""Gauss-Legendre rules on the device."""

import warp as wp

from .real_device import real


@wp.struct
class Rules:
    """Rules over [0, 1] of the numbers of nodes that are wanted: that of n nodes begins at ``first[n]``."""

    first: wp.array(dtype=int)
    nodes: wp.array(dtype=real)
    weights: wp.array(dtype=real)


@wp.func
def rule_node(rules: Rules, n: int, i: int) -> real:
    """Node i of the rule of n."""
    return rules.nodes[rules.first[n] + i]


@wp.func
def rule_weight(rules: Rules, n: int, i: int) -> real:
    """Weight i of the rule of n; they sum to 1."""
    return rules.weights[rules.first[n] + i]
