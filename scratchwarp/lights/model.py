"""What a light kind declares, and the collector that its host side writes shared data into."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from scratchwarp.scene.geometry import Instance, Mesh
from scratchwarp.scene.light import Light as LightRecord
from scratchwarp.scene.texture import Texture


@dataclass
class Packer:
    """Collects what lights share while they are packed: textures in use, distributions, triangles. ``filtered``: with
    smaller copies of the images of domes."""

    textures: Sequence[Texture] = ()
    instances: Sequence[Instance] = ()
    meshes: Sequence[Mesh] = ()
    images: list[np.ndarray] = field(default_factory=list)
    cdf: list[np.ndarray] = field(default_factory=list)
    triangles: list[np.ndarray] = field(default_factory=list)
    _slots: dict[int, int] = field(default_factory=dict)
    filtered: bool = False

    def image(self, texture: int) -> int:
        """Index in the lights' atlas of scene texture ``texture``, which is added on first use; -1 stays -1."""
        if texture < 0:
            return -1
        if texture not in self._slots:
            self._slots[texture] = len(self.images)
            self.images.append(self.textures[texture].pixels)
        return self._slots[texture]

    def put_cdf(self, values: np.ndarray) -> int:
        """Append a cumulative distribution; where it starts."""
        start = sum(len(c) for c in self.cdf)
        self.cdf.append(np.asarray(values, np.float32).ravel())
        return start

    def put_triangles(self, corners: np.ndarray) -> int:
        """Append triangles, shape [m, 3, 3] in metres; index of the first."""
        start = sum(len(t) for t in self.triangles)
        self.triangles.append(np.asarray(corners, np.float32))
        return start


@dataclass(frozen=True, eq=False)
class LightModel:
    """A kind of light.

    Attributes:
        name: of the kind, as device code is specialised by it; record: the record it renders.
        pack: (record, packer) -> fields of ``light_device.Light`` beyond those all lights share.
        sample, hit, span: its device functions, see ``light_device``.
        geometry: True when the light is scene geometry: rays meet its triangles, ``hit`` always misses.
        arcs, lit: device functions for integrals along a scratch cone, see ``arcs_device`` and ``lit_device``; None:
            only ``span`` is known, which may hold more than the light.
    """

    name: str
    record: type[LightRecord]
    pack: Callable[[Any, Packer], Mapping[str, Any]]
    sample: Any
    hit: Any
    span: Any
    geometry: bool = False
    arcs: Any = None
    lit: Any = None


def unit(vector: np.ndarray, otherwise: tuple[float, float, float] = (0.0, 0.0, -1.0)) -> np.ndarray:
    """``vector`` at length 1, float64; ``otherwise`` when it has none."""
    length = np.linalg.norm(vector)
    return np.asarray(vector, np.float64) / length if length > 0.0 else np.array(otherwise)


def reciprocal(ex: np.ndarray, ey: np.ndarray) -> tuple[np.ndarray, np.ndarray, float]:
    """Vectors rx, ry in the plane of ex, ey with rx.ex = ry.ey = 1, rx.ey = ry.ex = 0, and |ex x ey|; all zero when
    ex and ey span no area."""
    cross = np.cross(ex, ey)
    area = float(np.linalg.norm(cross))
    if not area > 1e-12 * max(float(ex @ ex), float(ey @ ey)):
        return np.zeros(3), np.zeros(3), 0.0
    n = cross / area
    return np.cross(ey, n) / area, np.cross(n, ex) / area, area
