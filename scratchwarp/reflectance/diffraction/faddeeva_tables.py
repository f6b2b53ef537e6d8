"""Coefficients of Weideman's rational series for the Faddeeva function w(z) = e^{-z^2} erfc(-i z), Im z >= 0.

w(z) = 2 p(Z) / (L - i z)^2 + 1 / (sqrt(pi) (L - i z)), Z = (L + i z) / (L - i z), L = 2^(-1/4) sqrt(n). Source:
Weideman 1994, Computation of the complex error function, Eq. 38.
"""

import numpy as np

TERMS = 32
SCALE = 2.0**-0.25 * TERMS**0.5


def _series() -> tuple[float, ...]:
    half = 2 * TERMS
    t = SCALE * np.tan(0.5 * np.pi * np.arange(1 - half, half) / half)
    values = np.concatenate(([0.0], np.exp(-t * t) * (SCALE**2 + t * t)))
    spectrum = np.fft.fft(np.fft.fftshift(values)).real / (2 * half)
    return tuple(float(c) for c in spectrum[TERMS:0:-1])


SERIES = _series()
"""p, the highest power first."""
