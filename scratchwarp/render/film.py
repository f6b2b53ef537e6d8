"""Film: the rendered image, its AOVs, and what it took."""

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np

# name -> (channels, what it holds)
AOVS = {
    "color": "radiance, linear Rec.709",
    "alpha": "share of samples that met geometry or a light of finite extent",
    "depth": "distance along the camera's axis [m], inf where nothing was met",
    "normal": "shading normal, world, towards the viewer",
    "albedo": "directional albedo of the base, linear, in [0, 1]",
    "P": "world position [m]",
    "primId": "index of the instance in Scene.instances, -1 where nothing was met",
    "base": "radiance reflected by bases",
    "scratches": "radiance reflected by scratches",
    "emission": "radiance of lights and glowing surfaces that the camera sees directly",
    "variance": "estimated variance of the mean luminance",
    "error": "estimated standard error of the luminance: how far more samples would move it; with an error target on "
    "the scale of the estimate that ended the render",
}


@dataclass(frozen=True, eq=False)
class Film(Mapping[str, np.ndarray]):
    """``film[name]``: an AOV, float32 [h, w] or [h, w, 3] (primId int32); names are listed in ``AOVS``.

    Attributes:
        aovs: the arrays. stats: seconds read, plan, simulate, compile, trace, write and counts rays, samples,
            error (estimated relMSE), bias (of it what knobs leave, predicted, 0 without a target), halving (about how
            many seconds more half of it takes),
            kernels_compiled, kernels_launched, tables_simulated, invalid_samples.
        metadata: header entries for image files.
        full_size: (width, height) of the whole image; crop: (x0, x1, y0, y1) that the arrays cover, maxima exclusive.
    """

    aovs: Mapping[str, np.ndarray]
    stats: dict[str, float]
    metadata: Mapping[str, Any]
    full_size: tuple[int, int]
    crop: tuple[int, int, int, int]
    warnings: tuple[str, ...] = field(default=())

    def __getitem__(self, name: str) -> np.ndarray:
        try:
            return self.aovs[name]
        except KeyError:
            raise KeyError(f"no AOV {name!r}; there are {', '.join(self.aovs)}") from None

    def __iter__(self) -> Iterator[str]:
        return iter(self.aovs)

    def __len__(self) -> int:
        return len(self.aovs)
