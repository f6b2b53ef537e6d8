"""What a textured base lends its scratches: the greatest reflectance on it, which each point scales to its own."""

import numpy as np

from ..scene import PreviewSurface, Scene, ScratchSurface, TextureInput

Color = tuple[float, float, float]


def _range(value: object, scene: Scene) -> tuple[np.ndarray, np.ndarray]:
    """Least and greatest value of an input in each channel, [3], within [0, 1]."""
    if isinstance(value, TextureInput):
        texels = scene.textures[value.texture].pixels.reshape(-1, 4)
        ends = np.stack([texels.min(0), texels.max(0)]) * value.scale + value.bias
        if value.channel != "rgb":
            ends = np.repeat(ends[:, ["rgba".index(value.channel)]], 4, axis=1)
        low, high = np.sort(ends[:, :3], axis=0)
    else:
        low = high = np.broadcast_to(np.asarray(value, np.float64), 3)
    return np.clip(low, 0.0, 1.0), np.clip(high, 0.0, 1.0)


def greatest_f0(scene: Scene, surface: PreviewSurface | ScratchSurface) -> tuple[Color, bool] | None:
    """(a bound of the reflectance at normal incidence of a base in each channel, whether its diffuse term shows
    anywhere), None where neither its colour nor its metalness is textured."""
    if not isinstance(surface, PreviewSurface):
        return None
    if surface.use_specular_workflow:
        if not isinstance(surface.specular_color, TextureInput):
            return None
        r, g, b = (float(c) for c in _range(surface.specular_color, scene)[1])
        return (r, g, b), True
    if not any(isinstance(v, TextureInput) for v in (surface.diffuse_color, surface.metallic)):
        return None
    metallic, color = _range(surface.metallic, scene), _range(surface.diffuse_color, scene)[1]
    r2 = ((1.0 - surface.ior) / (1.0 + surface.ior)) ** 2
    found = [(r2 + m * (1.0 - r2)) * (1.0 + m * (color - 1.0)) for m in metallic]
    r, g, b = (float(c) for c in np.clip(np.maximum(*found), 1e-3, 1.0))
    return (r, g, b), bool(metallic[0].min() < 1.0)
