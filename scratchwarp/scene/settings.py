"""Settings: what the user asks for, on top of what the stage says."""

from collections.abc import Mapping
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any

from .checks import in_range, one_of, put
from .knob import QUALITIES
from .layer import MODELS

MOST_CONE_TAPS = 64
INTEGRATORS = ("direct", "path")


@dataclass(frozen=True, kw_only=True)
class Settings:
    """How to render. None leaves the choice to the stage, then to the default in brackets.

    Attributes:
        width, height: image size in pixels [stage resolution, else 640 wide]; one of them follows from the aspect of
            the stage's resolution or the camera's aperture.
        spp: samples a pixel [16]; seed: of every random choice [0].
        threads: worker threads [all cores]; the image does not depend on it.
        quality: draft, preview, final or reference, which turns all knobs that are not turned otherwise: 4, 16, 128 or
            1024 samples and tables, look-ups and depths of paths to go with them.
        max_error: samples are doubled until the relative mean square error that they leave is estimated below this [no
            target]; also the largest error of the albedo of scratches by their tables' theta model [0.01].
        integrator: direct or path; max_depth: surfaces that a path may meet.
        crop: (xmin, xmax, ymin, ymax) in [0, 1], from the top left; only that part is rendered.
        tile: edge of a square tile in pixels.
        filter: box, gaussian or blackmanHarris [blackmanHarris]; filter_width: full width in pixels.
        cone_taps: look-ups into an image or a shaped light along the mirror cone of a scratch, for each sample [16].
        effects: name -> True or False forces one effect of the plan on or off.
        knobs: name -> value of approximations (``plan.knobs.KNOBS`` has them all); they go before the fields of the
            same meaning, and effects before them.
        model: how light on scratches is computed, a token of ``scratch:layer:model`` in place of every layer's own.
    """

    width: int | None = None
    height: int | None = None
    spp: int | None = None
    seed: int | None = None
    threads: int | None = None
    quality: str | None = None
    max_error: float | None = None
    integrator: str | None = None
    max_depth: int | None = None
    crop: tuple[float, float, float, float] | None = None
    tile: int = 32
    filter: str | None = None
    filter_width: float | None = None
    effects: Mapping[str, bool] = field(default_factory=dict)
    model: str | None = None
    cone_taps: int | None = None
    knobs: Mapping[str, int | str] = field(default_factory=dict)

    def __post_init__(self) -> None:
        limits = {"width": 65536, "height": 65536, "spp": 1 << 20, "threads": 4096, "max_depth": 1024, "tile": 4096}
        limits["cone_taps"] = MOST_CONE_TAPS
        for name, high in limits.items():
            value = getattr(self, name)
            if value is not None:
                if not isinstance(value, int) or isinstance(value, bool):
                    raise ValueError(f"Settings: {name} is {value!r}, expected a whole number")
                in_range("Settings", name, value, 1, high)
        if self.seed is not None:
            in_range("Settings", "seed", self.seed, 0, 2**32 - 1)
        if self.quality is not None:
            one_of("Settings", "quality", self.quality, QUALITIES)
        if self.integrator is not None:
            one_of("Settings", "integrator", self.integrator, INTEGRATORS)
        if self.filter is not None:
            one_of("Settings", "filter", self.filter, ("box", "gaussian", "blackmanHarris"))
        if self.model is not None:
            one_of("Settings", "model", self.model, MODELS)
        if self.filter_width is not None:
            in_range("Settings", "filter_width", self.filter_width, 0.0, 64.0)
        if self.max_error is not None:
            in_range("Settings", "max_error", self.max_error, 1e-9, 1e9)
        if self.crop is not None:
            _check_crop(self.crop)
        if not isinstance(self.effects, Mapping):
            raise ValueError(f"Settings: effects is {self.effects!r}, expected a mapping of names to True or False")
        for name, value in self.effects.items():
            if not isinstance(value, bool):
                raise ValueError(f"Settings: effects[{name!r}] is {value!r}, expected True or False")
        if not isinstance(self.knobs, Mapping):
            raise ValueError(f"Settings: knobs is {self.knobs!r}, expected a mapping of names to values")
        put(self, effects=MappingProxyType(dict(self.effects)), knobs=MappingProxyType(dict(self.knobs)))


def _check_crop(crop: Any) -> None:
    try:
        x0, x1, y0, y1 = (float(edge) for edge in crop)
        fits = 0 <= x0 < x1 <= 1 and 0 <= y0 < y1 <= 1
    except (TypeError, ValueError):
        fits = False
    if not fits:
        raise ValueError(f"Settings: crop is {crop!r}, expected (xmin, xmax, ymin, ymax) with 0 <= min < max <= 1")
