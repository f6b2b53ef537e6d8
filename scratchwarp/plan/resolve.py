"""Settings with every value decided: the user's first, then the stage's, then the default."""

import math
import os
from dataclasses import replace
from typing import Any

from ..scene import Scene, Settings
from .knobs import KNOBS, by_quality, checked, switched, turned

DEFAULT_WIDTH = 640
# Full support in pixels at which each filter is sharp without aliasing.
FILTER_WIDTHS = {"box": 1.0, "gaussian": 3.0, "blackmanHarris": 3.3}


def resolve(scene: Scene, settings: Settings) -> tuple[Settings, tuple[int, int], tuple[int, int, int, int]]:
    """(settings without None but max_error, model and quality, (width, height), rendered window x0, x1, y0, y1)."""
    o, camera = scene.options, scene.camera
    width, height = settings.width, settings.height
    aspect = camera.horizontal_aperture / camera.vertical_aperture
    if o.resolution:
        aspect = o.resolution[0] / o.resolution[1]
    if width is None and height is None:
        width, height = o.resolution or (DEFAULT_WIDTH, max(1, round(DEFAULT_WIDTH / aspect)))
    elif height is None:
        assert width is not None
        height = max(1, round(width / aspect))
    elif width is None:
        width = max(1, round(height * aspect))
    assert width is not None and height is not None
    if width > 65536 or height > 65536:
        raise ValueError(f"{scene.path}: an image of {width} x {height} pixels is too large; give --imageWidth")

    if settings.crop is not None:
        left, right, top, bottom = settings.crop
    else:
        left, low, right, high = o.data_window
        top, bottom = 1.0 - high, 1.0 - low
    x0, x1 = math.floor(left * width + 1e-6), math.ceil(right * width - 1e-6)
    y0, y1 = math.floor(top * height + 1e-6), math.ceil(bottom * height - 1e-6)
    x0, y0 = max(x0, 0), max(y0, 0)
    x1, y1 = min(max(x1, x0 + 1), width), min(max(y1, y0 + 1), height)

    quality = settings.quality or o.quality
    knobs = checked(settings.knobs)
    try:
        authored = checked(dict(o.knobs))
    except ValueError as error:
        raise ValueError(f"{scene.path}: {o.path}: {error}") from None
    asked, chosen_by = turned(knobs, "settings"), {**by_quality(quality), **authored}
    stage_asks = turned(authored, "settings")
    own = {n: k for n, k in KNOBS.items() if k.place[0] == "settings"}
    falls_to: dict[str, Any] = {k.place[1]: chosen_by.get(n, k.default) for n, k in own.items()}
    own_quality = by_quality(settings.quality).get("spp")
    spp: Any = asked.get("spp") or settings.spp or own_quality or stage_asks.get("spp") or o.spp or falls_to["spp"]
    chosen = settings.filter or o.filter
    filter_width = settings.filter_width
    if filter_width is None:
        filter_width = o.filter_width if o.filter_width is not None and settings.filter in (None, o.filter) else None
    if filter_width is None:
        filter_width = FILTER_WIDTHS[chosen]
    decided = replace(
        settings,
        width=width,
        height=height,
        spp=spp,
        seed=settings.seed if settings.seed is not None else (o.seed or 0),
        threads=settings.threads or os.cpu_count() or 1,
        quality=quality,
        max_error=settings.max_error or o.max_error,
        integrator=settings.integrator or o.integrator or "direct",
        max_depth=asked.get("max_depth")
        or settings.max_depth
        or stage_asks.get("max_depth")
        or o.max_depth
        or falls_to["max_depth"],
        filter=chosen,
        filter_width=filter_width,
        cone_taps=asked.get("cone_taps") or settings.cone_taps or falls_to["cone_taps"],
        model=asked.get("model") or settings.model or stage_asks.get("model"),
        effects={**switched(authored), **dict(o.effects), **switched(knobs), **settings.effects},
        knobs={**chosen_by, **knobs},
    )
    return decided, (width, height), (x0, x1, y0, y1)
