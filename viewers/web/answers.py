"""What is said of a stage and of a pixel, as JSON."""

import math
from dataclasses import asdict
from typing import Any

from scratchwarp.render.inspect import PixelReport
from scratchwarp.scene import Control

from ..looking import Shown


def described(control: Control) -> dict[str, Any]:
    """A control with all that the page shows of it."""
    return asdict(control)


def values(shown: Shown) -> dict[str, Any]:
    """id -> value of every control."""
    return {c.id: c.value for c in shown.controls}


def state(shown: Shown) -> dict[str, Any]:
    """How far the image is and what was said last."""
    return {
        "version": shown.version,
        "picture": shown.picture,
        "edits": shown.edits,
        "size": shown.size,
        "samples": shown.samples,
        "spp": shown.spp,
        "redone": shown.redone,
        "message": shown.message,
    }


def pixel(report: PixelReport) -> dict[str, Any]:
    """What made a pixel; numbers that JSON has not are null."""
    found = asdict(report)
    for layer in found["layers"]:
        layer["theta"], layer["phi"] = math.degrees(layer["theta"]), math.degrees(layer["phi"])
        layer["angles"] = [math.degrees(a) for a in layer["angles"]]
    return _finite(found)


def _finite(value: Any) -> Any:
    if isinstance(value, dict):
        return {k: _finite(v) for k, v in value.items()}
    if isinstance(value, list | tuple):
        return [_finite(v) for v in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value
