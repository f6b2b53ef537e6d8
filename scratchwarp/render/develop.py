"""Sums of the kernel -> AOVs and the header of image files."""

from collections.abc import Mapping
from typing import Any

import numpy as np

from .. import __version__
from ..plan import EffectPlan
from ..scene import Camera, Scene


def aovs(sums: Mapping[str, np.ndarray], scene: Scene, samples: int | np.ndarray) -> dict[str, np.ndarray]:
    """Divide sums over samples [h, w] into AOVs. ``samples``: of each pixel, or [h, w] where they differ.

    Samples that were not finite are left out of the mean of their pixel (``stats`` counts them).
    """
    good = np.maximum(samples - sums["invalid"], 1).astype(np.float32)
    hits = np.maximum(sums["hits"], 1).astype(np.float32)
    seen = sums["hits"] > 0

    def mean(name: str) -> np.ndarray:
        return (sums[name] / good[..., None]).astype(np.float32)

    def over_hits(name: str) -> np.ndarray:
        value = sums[name] / (hits[..., None] if sums[name].ndim == 3 else hits)
        return np.asarray(value, np.float32)

    color, base, scratches = mean("color"), mean("base"), mean("scratches")
    shown = in_gamut(color)
    scratches = scratches + (shown - color)
    color = shown
    normal = over_hits("normal")
    length = np.linalg.norm(normal, axis=-1, keepdims=True)
    normal = np.divide(normal, length, out=np.zeros_like(normal), where=length > 0)
    # not a matrix product: that sums in an order which depends on the shape, and a crop has the bits of the whole
    luminance = np.float32(0.2126) * color[..., 0] + np.float32(0.7152) * color[..., 1]
    luminance += np.float32(0.0722) * color[..., 2]
    spread = np.maximum(sums["square"] / good - luminance**2, 0.0)
    position = (over_hits("position").astype(np.float64) + scene.origin).astype(np.float32)
    variance = (spread / np.maximum(good - 1.0, 1.0)).astype(np.float32)
    return {
        "color": color,
        "alpha": np.clip(sums["alpha"] / np.maximum(np.asarray(samples, np.float32), 1.0), 0.0, 1.0).astype(np.float32),
        "depth": np.where(seen, over_hits("depth"), np.inf).astype(np.float32),
        "normal": normal,
        "albedo": np.clip(over_hits("albedo"), 0.0, 1.0),
        "P": np.where(seen[..., None], position, 0.0).astype(np.float32),
        "primId": np.where(seen, sums["instance"], -1).astype(np.int32),
        "base": base,
        "scratches": scratches,
        "emission": (color - base - scratches).astype(np.float32),
        "variance": variance,
        "error": np.sqrt(variance),
    }


def in_gamut(color: np.ndarray) -> np.ndarray:
    """Colours more saturated than Rec.709 (only diffraction makes them) moved towards the grey of their luminance, just
    far enough that no component is negative. ``[..., 3]``; others keep their bits."""
    low = color.min(axis=-1)
    outside = low < 0.0
    if not outside.any():
        return color
    luminance = np.float32(0.2126) * color[..., 0] + np.float32(0.7152) * color[..., 1]
    luminance = np.maximum(luminance + np.float32(0.0722) * color[..., 2], 0.0)
    span = np.maximum(luminance - low, np.float32(1e-30))
    keep = np.where(outside, luminance / span, np.float32(1.0))[..., None].astype(np.float32)
    mapped = np.maximum(luminance[..., None] + keep * (color - luminance[..., None]), np.float32(0.0))
    return np.where(outside[..., None], mapped, color).astype(np.float32)


def _depths(camera: Camera) -> tuple[float, float]:
    """Clipping distances [m] that a matrix of depths can be made of: finite, the near one above 0, the far one beyond.

    A camera without a near plane has one at a millimetre, nearer where its far plane is (scenes of any size).
    """
    far = min(camera.far, 1e10)
    near = min(camera.near, 1e10) if camera.near > 0.0 else min(1e-3, 1e-3 * max(far, 1e-12))
    return near, far if far > near else 2.0 * near


def metadata(scene: Scene, plan: EffectPlan, digest: str, wall: float, cpu: float) -> dict[str, Any]:
    """Header entries: software, settings hash, samples, seed, seconds, camera matrices (row vectors)."""
    camera, (width, height) = scene.camera, plan.size
    to_camera = np.linalg.inv(camera.transform)
    shift = np.eye(4)
    shift[:3, 3] = -scene.origin
    world_to_camera = to_camera @ shift
    left, right, bottom, top = camera.window(width, height, scene.options.conform, scene.options.pixel_aspect)
    near, far = _depths(camera)
    ndc = np.zeros((4, 4))
    ndc[0, 0], ndc[1, 1] = 2.0 / (right - left), 2.0 / (top - bottom)
    if camera.projection == "perspective":
        ndc[0, 2], ndc[1, 2] = (right + left) / (right - left), (top + bottom) / (top - bottom)
        ndc[2, 2], ndc[2, 3] = -(far + near) / (far - near), -2.0 * far * near / (far - near)
        ndc[3, 2] = -1.0
    else:
        ndc[0, 3], ndc[1, 3] = -(right + left) / (right - left), -(top + bottom) / (top - bottom)
        ndc[2, 2], ndc[2, 3], ndc[3, 3] = -2.0 / (far - near), -(far + near) / (far - near), 1.0
    s = plan.settings
    entries = {
        "Software": f"scratchwarp {__version__}",
        "scratchwarp:settings": digest,
        "scratchwarp:stage": scene.path,
        "scratchwarp:spp": s.spp,
        "scratchwarp:seed": s.seed,
        "scratchwarp:integrator": s.integrator,
        "scratchwarp:seconds": wall,
        "scratchwarp:cpuSeconds": cpu,
        "scratchwarp:effects": " ".join(n for n, c in plan.effects.items() if c.enabled),
        "worldToCamera": tuple(world_to_camera.T.ravel().tolist()),
        "worldToNDC": tuple((ndc @ world_to_camera).T.ravel().tolist()),
    }
    if scene.time is not None:
        entries["scratchwarp:timeCode"] = float(scene.time)
    return entries
