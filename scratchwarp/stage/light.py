"""UsdLux lights: what is common to all of them, and which file reads which type.

L = intensity * 2^exposure * color * temperature / sizeFactor, where sizeFactor is the light's area in the world (in
scene units, scale included) when ``normalize`` is on, and 1 when it is not (UsdLux schema, LightAPI).
"""

from typing import Any

import numpy as np
from pxr import Usd, UsdLux, UsdShade

from scratchwarp.scene import Shaping

from .color import color
from .reading import Reading
from .texture import Textures

_WHITE_KELVIN = 6500.0
_MOST = 1.0e16  # images hold squares of radiances in float32


def radiance(reading: Reading, prim: Usd.Prim, size_factor: float) -> np.ndarray:
    """Emitted radiance, linear Rec.709, shape [3]; ``size_factor`` counts when ``normalize`` is on."""
    intensity = reading.number(prim, "inputs:intensity", 1.0)
    if intensity < 0:
        reading.warn(prim.GetPath(), "inputs:intensity is negative; it gives no light")
    scale = max(intensity, 0.0) * 2.0 ** min(reading.number(prim, "inputs:exposure"), 100.0)
    if reading.value(prim, "inputs:normalize", False):
        if not size_factor > 0:
            reading.warn(prim.GetPath(), "normalize is on but the light has no size; it gives no light")
            return np.zeros(3)
        scale /= size_factor
    tint = light_color(reading, prim, "inputs:color", (1.0, 1.0, 1.0))
    if reading.value(prim, "inputs:enableColorTemperature", False):
        tint = tint * temperature_rgb(reading.number(prim, "inputs:colorTemperature", _WHITE_KELVIN))
    return scale * tint * held(reading, prim, float(np.abs(scale * tint).max()))


def held(reading: Reading, prim: Usd.Prim, largest: float) -> float:
    """Factor, at most 1, that makes of the ``largest`` radiance that a prim emits one whose square images hold."""
    if largest <= _MOST:
        return 1.0
    reading.warn(prim.GetPath(), f"its radiance is {largest:.3g}, more than images hold; {_MOST:g} is used")
    return _MOST / largest


def through(reading: Reading, prim: Usd.Prim, emitted: np.ndarray, textures: Textures, texture: int) -> np.ndarray:
    """Radiance of a light with a texture (-1: none), whose texels multiply it, as far as images hold both."""
    if texture < 0:
        return emitted
    return emitted * held(reading, prim, float(emitted.max()) * float(textures.records[texture].pixels.max()))


def light_color(reading: Reading, prim: Usd.Prim, name: str, otherwise: tuple[float, float, float]) -> np.ndarray:
    """A colour attribute in linear Rec.709, shape [3]."""
    attribute = prim.GetAttribute(name)
    values = np.array(reading.value(prim, name, otherwise), np.float64)
    if not np.isfinite(values).all():
        reading.warn(prim.GetPath(), f"{name} is {tuple(values.tolist())}; {otherwise} is used")
        values = np.array(otherwise)
    return color(reading, attribute, values) if attribute else values


def temperature_rgb(kelvin: float) -> np.ndarray:
    """Colour of a blackbody, linear Rec.709, shape [3]; 6500 K is white.

    The schema asks for white at 6500 K, but UsdLux's own function gives (1.043, 0.984, 1.035) there: it is the
    Planckian locus with luminance 1. Dividing by its value at 6500 K satisfies the schema at every temperature.
    """
    blackbody = UsdLux.BlackbodyTemperatureAsRgb
    return np.array(blackbody(min(max(kelvin, 1000.0), 10000.0))) / np.array(blackbody(_WHITE_KELVIN))


def common(reading: Reading, prim: Usd.Prim, widest: float | None = None) -> dict[str, Any]:
    """Fields that every light record has, but for ``radiance`` and linking.

    ``widest``: the largest angle from its axis at which the light shines unshaped [degrees]; None: ShapingAPI does not
    apply to it.
    """
    path = prim.GetPath()
    if any(given.HasConnectedSource() for given in UsdShade.ConnectableAPI(prim).GetInputs()):
        reading.warn(path, "shaders connected to a light's inputs are not honoured")
    distance = reading.number(prim, "inputs:shadow:distance", -1.0)
    if reading.number(prim, "inputs:shadow:falloff", -1.0) > 0 and distance >= 0:
        reading.warn(path, "inputs:shadow:falloff is not honoured; the shadow ends sharply")
    if prim.GetRelationship("light:filters").GetForwardedTargets():
        reading.warn(path, "light filters are not honoured")
    return {
        "path": str(path),
        "diffuse": reading.number(prim, "inputs:diffuse", 1.0),
        "specular": reading.number(prim, "inputs:specular", 1.0),
        "shadow": bool(reading.value(prim, "inputs:shadow:enable", True)),
        "shadow_color": tuple(light_color(reading, prim, "inputs:shadow:color", (0.0, 0.0, 0.0)).tolist()),
        "shadow_distance": distance * reading.metres if distance >= 0 else np.inf,
        "shaping": _shaping(reading, prim, widest),
    }


def _shaping(reading: Reading, prim: Usd.Prim, widest: float | None) -> Shaping | None:
    """ShapingAPI's values, None where they change nothing."""
    if not prim.HasAPI(UsdLux.ShapingAPI):
        return None
    if reading.value(prim, "inputs:shaping:ies:file"):
        reading.warn(prim.GetPath(), "inputs:shaping:ies:file is not honoured")
    focus = max(reading.number(prim, "inputs:shaping:focus"), 0.0)
    angle = min(max(reading.number(prim, "inputs:shaping:cone:angle", 90.0), 0.0), 180.0)
    softness = min(max(reading.number(prim, "inputs:shaping:cone:softness"), 0.0), 1.0)
    if widest is None:
        if focus > 0 or prim.GetAttribute("inputs:shaping:cone:angle").HasAuthoredValue():
            reading.warn(prim.GetPath(), "ShapingAPI is not honoured on this type of light")
        return None
    if focus == 0 and softness == 0 and angle >= widest:
        return None
    return Shaping(
        focus=focus,
        focus_tint=tuple(light_color(reading, prim, "inputs:shaping:focusTint", (0.0, 0.0, 0.0)).tolist()),
        cone_angle=float(np.radians(angle)),
        cone_softness=softness,
    )
