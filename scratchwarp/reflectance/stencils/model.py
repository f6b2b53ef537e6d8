"""The stencil model as records that check themselves; ``dataclasses.replace`` is the editor.

Filip et al. 2015, Eq. 2 to 10. Source of the corrections: the printed mask has its cases exchanged (here it rises with
1 - |H . U|, as the width is described), and the axis is the one that scratches run along.
"""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

MASKS = ("smooth", "binary")
_SOFTNESS = 0.15  # half-width of a mask in widths, the middle of what the paper recommends


def _check(owner: str, name: str, value: Any, low: float, high: float) -> float:
    try:
        number = float(value)
    except (TypeError, ValueError):
        raise ValueError(f"{owner}: {name} must be a number, got {value!r}") from None
    if not low <= number <= high or not np.isfinite(number):
        raise ValueError(f"{owner}: {name} must lie in [{low:g}, {high:g}], got {value}")
    return number


@dataclass(frozen=True)
class Mode:
    """One anisotropic highlight, of scratches, threads or fibres along the axis (cos azimuth, sin azimuth, 0).

    ``width`` w in [0, 1]: the mode is seen where 1 - |H . U| exceeds it, 0 everywhere, 1 nowhere. ``half_width`` of the
    smooth edge of that mask, 0.15 w unless given. ``a + b / (cos_i cos_o)`` scales the stencil with elevation, ``kd +
    ks (...)^alpha`` shapes it, ``color [3]`` (linear Rec.709) paints it. Raises ValueError naming the field.
    """

    azimuth: float
    width: float
    a: float
    b: float
    kd: float
    ks: float
    alpha: float
    color: Any = (1.0, 1.0, 1.0)
    half_width: float | None = None

    def __post_init__(self) -> None:
        for name in ("azimuth", "a", "b", "kd", "ks"):
            object.__setattr__(self, name, _check("mode", name, getattr(self, name), -np.inf, np.inf))
        object.__setattr__(self, "width", _check("mode", "width", self.width, 0.0, 1.0))
        object.__setattr__(self, "alpha", _check("mode", "alpha", self.alpha, 0.0, 1e9))
        if self.half_width is not None:
            object.__setattr__(self, "half_width", _check("mode", "half_width", self.half_width, 0.0, 1.0))
        try:
            color = np.broadcast_to(np.asarray(self.color, np.float64), 3)
        except (TypeError, ValueError):
            raise ValueError(f"mode: color must be one number or three, got {self.color!r}") from None
        object.__setattr__(self, "color", tuple(_check("mode", "color", c, 0.0, np.inf) for c in color))

    @property
    def softness(self) -> float:
        """Half-width of the edge of the mask."""
        return _SOFTNESS * self.width if self.half_width is None else self.half_width


@dataclass(frozen=True)
class Model:
    """Modes, dominant first, over a background, with a specular highlight.

    ``beta`` in [0, 1]: translucency where a mode crosses the next, one number or one for each mode but the last.
    ``background`` the paper's r: the colour between highlights in units of the last mode's. ``k`` and
    ``specular_alpha`` of the factor max(1, k H_z^alpha (a_1 + b_1 / (cos_i cos_o))). ``retro`` turns the light by 180
    degrees before the half vector: highlights that return the light. ``mask`` "smooth" or "binary". Reciprocal by
    construction. Raises ValueError naming the field.
    """

    modes: tuple[Mode, ...]
    beta: Any = 0.0
    background: float = 0.0
    k: float = 0.0
    specular_alpha: float = 1.0
    retro: bool = False
    mask: str = "smooth"

    def __post_init__(self) -> None:
        modes = (self.modes,) if isinstance(self.modes, Mode) else tuple(self.modes)
        if not modes or not all(isinstance(m, Mode) for m in modes):
            raise ValueError(f"model: modes must hold one Mode or more, got {self.modes!r}")
        object.__setattr__(self, "modes", modes)
        betas = (self.beta,) * (len(modes) - 1) if np.ndim(self.beta) == 0 else tuple(self.beta)
        if len(betas) != len(modes) - 1:
            raise ValueError(f"model: beta must be one number or {len(modes) - 1}, got {self.beta}")
        if np.ndim(self.beta) == 0:
            _check("model", "beta", self.beta, 0.0, 1.0)
        object.__setattr__(self, "beta", tuple(_check("model", "beta", b, 0.0, 1.0) for b in betas))
        object.__setattr__(self, "background", _check("model", "background", self.background, 0.0, np.inf))
        object.__setattr__(self, "k", _check("model", "k", self.k, 0.0, np.inf))
        object.__setattr__(self, "specular_alpha", _check("model", "specular_alpha", self.specular_alpha, 0.0, 1e9))
        object.__setattr__(self, "retro", bool(self.retro))
        if self.mask not in MASKS:
            raise ValueError(f"model: mask must be one of {', '.join(MASKS)}, got {self.mask!r}")

    @property
    def parameters(self) -> int:
        """How many numbers it has: 10 a mode, a translucency for each crossing, background and specular factor."""
        return 10 * len(self.modes) + len(self.beta) + 3

    def edit(self, mode: int, **changes: Any) -> "Model":
        """This model with fields of one of its modes replaced."""
        if not -len(self.modes) <= mode < len(self.modes):
            raise ValueError(f"model: mode must be one of its {len(self.modes)} modes, got {mode}")
        modes = list(self.modes)
        modes[mode] = replace(modes[mode], **changes)
        return replace(self, modes=tuple(modes))
