"""Images and how a material input reads them."""

from dataclasses import dataclass

import numpy as np

from .checks import constant, freeze, one_of, put

WRAPS = ("black", "clamp", "repeat", "mirror")
CHANNELS = ("rgb", "r", "g", "b", "a")


@dataclass(frozen=True, eq=False)
class Texture:
    """Pixels, decoded to linear Rec.709 (or left raw), shape [h, w, 4], float32, row 0 at the top (v = 1)."""

    path: str
    pixels: np.ndarray

    def __post_init__(self) -> None:
        put(self, pixels=freeze(self.path, "pixels", self.pixels, (None, None, 4), np.float32))
        if self.pixels.size == 0:
            raise ValueError(f"{self.path}: the image has no pixels")


@dataclass(frozen=True, eq=False)
class TextureInput:
    """value = scale * texel + bias, read at ``transform @ (u, v, 1)``.

    Attributes:
        texture: index into ``Scene.textures``.
        channel: rgb, r, g, b or a.
        scale, bias: shape [4].
        wrap_s, wrap_t: black, clamp, repeat or mirror.
        transform: shape [2, 3], from UsdTransform2d.
        uv_set: name of the uv set.
    """

    texture: int
    channel: str = "rgb"
    scale: np.ndarray = constant((1.0, 1.0, 1.0, 1.0))
    bias: np.ndarray = constant((0.0, 0.0, 0.0, 0.0))
    wrap_s: str = "repeat"
    wrap_t: str = "repeat"
    transform: np.ndarray = constant(((1.0, 0.0, 0.0), (0.0, 1.0, 0.0)))
    uv_set: str = "st"

    def __post_init__(self) -> None:
        owner = f"texture input {self.texture}"
        one_of(owner, "channel", self.channel, CHANNELS)
        one_of(owner, "wrap_s", self.wrap_s, WRAPS)
        one_of(owner, "wrap_t", self.wrap_t, WRAPS)
        put(
            self,
            scale=freeze(owner, "scale", self.scale, (4,)),
            bias=freeze(owner, "bias", self.bias, (4,)),
            transform=freeze(owner, "transform", self.transform, (2, 3)),
        )
