"""The angular lobe across a scratch: sinc^2 and its integral, in cycles t = W q / lambda (x = k W q = 2 pi t)."""

import warp as wp

from .lobe_tables import INNER, ONE_MINUS_XF, SPLIT, XXG
from .real_device import HALF, ONE, PI, TWO, ZERO, real

_INNER = wp.constant(wp.types.vector(length=len(INNER), dtype=real)(*INNER))
_XF = wp.constant(wp.types.vector(length=len(ONE_MINUS_XF), dtype=real)(*ONE_MINUS_XF))
_XXG = wp.constant(wp.types.vector(length=len(XXG), dtype=real)(*XXG))
_INNER_LAST = wp.constant(len(INNER) - 1)
_XF_LAST = wp.constant(len(ONE_MINUS_XF) - 1)
_SPLIT = wp.constant(real(SPLIT))
_SMALL = wp.constant(real(1.0e-4))
_A0 = wp.constant(real(0.66142739))
_B0 = wp.constant(real(0.38272292))


@wp.struct
class HalfTurns:
    """A value ``half`` pi / 2 + ``rest``: differences of two stay exact where the values approach pi / 2."""

    half: int
    rest: real


@wp.func
def sinc(t: real) -> real:
    """sin(pi t) / (pi t); exactly 0 at whole t, 1 at 0."""
    x = PI * t
    r = ONE - x * x / real(6.0)
    if wp.abs(t) > _SMALL:
        n = wp.rint(t)
        odd = n - TWO * wp.floor(HALF * n)
        r = (ONE - TWO * odd) * wp.sin(PI * (t - n)) / x
    return r


@wp.func
def lobe_integral(t: real) -> HalfTurns:
    """M(2 pi t), odd, towards pi / 2: integral of (1 - cos x) / x^2 (Velinov et al. 2018 Eq. 27, exact Si)."""
    r = HalfTurns()
    x = TWO * PI * wp.abs(t)
    sign = wp.where(t < ZERO, -ONE, ONE)
    if x <= _SPLIT:
        y = x * x / (_SPLIT * _SPLIT)
        p = _INNER[_INNER_LAST]
        for i in range(wp.static(len(INNER) - 1)):
            p = p * y + _INNER[_INNER_LAST - 1 - i]
        r.rest = sign * x * p
    else:
        y = _SPLIT * _SPLIT / (x * x)
        f = _XF[_XF_LAST]
        g = _XXG[_XF_LAST]
        for i in range(wp.static(len(ONE_MINUS_XF) - 1)):
            f = f * y + _XF[_XF_LAST - 1 - i]
            g = g * y + _XXG[_XF_LAST - 1 - i]
        angle = TWO * PI * (wp.abs(t) - wp.rint(t * sign))
        inverse = ONE / x
        # pi/2 - M = [1 - (1 - x f) cos x + (x^2 g) sin x / x] / x
        tail = (ONE - f * inverse * inverse * wp.cos(angle) + g * inverse * wp.sin(angle)) * inverse
        r.half = wp.where(t < ZERO, -1, 1)
        r.rest = -sign * tail
    return r


@wp.func
def lobe_integral_paper(t: real) -> real:
    """M(2 pi t) with Si of Velinov et al. 2018 Eq. 29: error up to 0.051 at x = 3.56 and 0.339 / x far out, so that it
    falls with t on 18 % of [1, 60] and whole intervals come out negative. To compare with."""
    x = TWO * PI * wp.abs(t)
    r = ZERO
    if x > ZERO:
        sine = wp.sin(PI * (t - wp.rint(t)))
        one_minus_cos = TWO * sine * sine
        away = x - _B0
        si = HALF * PI * wp.tanh(x) - _A0 * x / (ONE + away * away) + one_minus_cos / (ONE + x)
        r = si - one_minus_cos / x
    return wp.where(t < ZERO, -r, r)
