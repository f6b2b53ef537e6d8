"""Makes the coefficients of ``scratchwarp.reflectance.diffraction.lobe_tables``: run it to print them."""

import numpy as np
from numpy.polynomial import chebyshev, polynomial

SPLIT, INNER_DEGREE, OUTER_DEGREE = 8.0, 12, 12
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(40)


def _panels(edges):
    half = 0.5 * np.diff(edges)[:, None]
    return (edges[:-1, None] + half + half * _NODES).ravel(), (half * _WEIGHTS).ravel()


def _monomials(y, values, degree):
    """Least squares at dense Chebyshev points of y in [0, 1], as ascending powers of y."""
    series = chebyshev.cheb2poly(chebyshev.chebfit(2.0 * y - 1.0, values, degree))
    powers = np.zeros(1)
    for coefficient in series[::-1]:
        powers = polynomial.polyadd(polynomial.polymul(powers, [-1.0, 2.0]), [coefficient])
    return powers


def fit():
    """INNER, ONE_MINUS_XF and XXG with their greatest errors."""
    y = 0.5 - 0.5 * np.cos(np.pi * (np.arange(400) + 0.5) / 400)
    # M / x = integral over v in [0, 1] of sinc^2(x v / 2) / 2
    v, weight = _panels(np.array([0.0, 1.0]))
    x = SPLIT * np.sqrt(y)
    inner = 0.5 * np.sinc(x[:, None] * v / (2.0 * np.pi)) ** 2 @ weight
    # with s = x t: 1 - x f = integral of e^{-s} (s/x)^2 / (1 + (s/x)^2), x^2 g = integral of e^{-s} s / (1 + (s/x)^2)
    s, weight = _panels(np.linspace(0.0, 60.0, 61))
    shared = np.exp(-s) / (1.0 + s * s * y[:, None] / SPLIT**2)
    outer = shared * s * s @ weight, shared * s @ weight
    for values, degree in ((inner, INNER_DEGREE), (outer[0], OUTER_DEGREE), (outer[1], OUTER_DEGREE)):
        powers = _monomials(y, values, degree)
        yield powers, np.abs(polynomial.polyval(y, powers) - values).max()


if __name__ == "__main__":
    for name, (powers, error) in zip(("INNER", "ONE_MINUS_XF", "XXG"), fit(), strict=True):
        print(f"{name} = (  # error {error:.1e}")
        print("\n".join(f"    {value!r}," for value in powers.tolist()) + "\n)")
