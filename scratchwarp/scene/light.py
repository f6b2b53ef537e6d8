"""One record for each light. Radiance is what UsdLux's rules give: linear Rec.709, exposure and colour included."""

from dataclasses import dataclass

import numpy as np

from .checks import all_finite, constant, freeze, in_range, put


@dataclass(frozen=True)
class Shaping:
    """UsdLux ShapingAPI: focus exponent, tint, and the cone (radians, from the axis) with its softness."""

    focus: float = 0.0
    focus_tint: tuple[float, float, float] = (0.0, 0.0, 0.0)
    cone_angle: float = np.pi / 2
    cone_softness: float = 0.0

    def __post_init__(self) -> None:
        all_finite("ShapingAPI", self)


@dataclass(frozen=True, eq=False, kw_only=True)
class Light:
    """What all lights share.

    Attributes:
        path: prim path.
        radiance: emitted radiance (irradiance for lights without extent), linear Rec.709, shape [3].
        diffuse, specular: multipliers of what the light adds to diffuse and to specular reflection.
        shadow: whether it casts shadows; shadow_color: light left in full shadow, linear Rec.709.
        shadow_distance: metres along which shadows are cast (inf: all the way).
        shaping: None when the light shines evenly.
        linked: indices of the instances it lights; None: all. shadow_linked: that cast its shadows; None: all.
    """

    path: str
    radiance: np.ndarray
    diffuse: float = 1.0
    specular: float = 1.0
    shadow: bool = True
    shadow_color: tuple[float, float, float] = (0.0, 0.0, 0.0)
    shadow_distance: float = np.inf
    shaping: Shaping | None = None
    linked: frozenset[int] | None = None
    shadow_linked: frozenset[int] | None = None

    def __post_init__(self) -> None:
        all_finite(self.path, self, ("shadow_distance",))
        put(self, radiance=freeze(self.path, "radiance", self.radiance, (3,)))
        for name, shape in self._arrays().items():
            put(self, **{name: freeze(self.path, name, getattr(self, name), shape)})

    def _arrays(self) -> dict[str, tuple[int, ...]]:
        return {}


@dataclass(frozen=True, eq=False, kw_only=True)
class DistantLight(Light):
    """Light from infinity. ``direction``: the way it travels, unit, world. ``angle``: full angle of its disk [rad];
    0: ``radiance`` holds the irradiance at normal incidence."""

    direction: np.ndarray
    angle: float = 0.0

    def _arrays(self) -> dict[str, tuple[int, ...]]:
        in_range(self.path, "angle", self.angle, 0.0, 2 * np.pi)
        return {"direction": (3,)}


@dataclass(frozen=True, eq=False, kw_only=True)
class SphereLight(Light):
    """``center``, ``radius`` in metres. ``axis``: emission axis (-Z of the prim) that shaping turns about.
    ``point``: treatAsPoint or radius 0; then ``radiance`` holds the radiant intensity [W/sr]."""

    center: np.ndarray
    radius: float
    axis: np.ndarray = constant((0.0, 0.0, -1.0))
    point: bool = False

    def _arrays(self) -> dict[str, tuple[int, ...]]:
        in_range(self.path, "radius", self.radius, 0.0)
        return {"center": (3,), "axis": (3,)}


@dataclass(frozen=True, eq=False, kw_only=True)
class RectLight(Light):
    """``center``; half-edge vectors ``ex`` (+X) and ``ey`` (+Y); shines along ``normal`` (-Z), that side only.
    ``texture``: index into ``Scene.textures`` or -1; its (0, 0) lies at +X +Y, as UsdLux has it."""

    center: np.ndarray
    ex: np.ndarray
    ey: np.ndarray
    normal: np.ndarray
    texture: int = -1

    def _arrays(self) -> dict[str, tuple[int, ...]]:
        return {"center": (3,), "ex": (3,), "ey": (3,), "normal": (3,)}


@dataclass(frozen=True, eq=False, kw_only=True)
class DiskLight(Light):
    """Ellipse with half-axis vectors ``ex``, ``ey`` about ``center``; shines along ``normal``, that side only."""

    center: np.ndarray
    ex: np.ndarray
    ey: np.ndarray
    normal: np.ndarray

    def _arrays(self) -> dict[str, tuple[int, ...]]:
        return {"center": (3,), "ex": (3,), "ey": (3,), "normal": (3,)}


@dataclass(frozen=True, eq=False, kw_only=True)
class CylinderLight(Light):
    """``center``, half-length vector ``axis`` (+X), ``radius``; shines from its side, without caps.
    ``forward``: -Z of the prim, unit, that shaping turns about."""

    center: np.ndarray
    axis: np.ndarray
    radius: float
    forward: np.ndarray = constant((0.0, 0.0, -1.0))

    def _arrays(self) -> dict[str, tuple[int, ...]]:
        in_range(self.path, "radius", self.radius, 0.0)
        return {"center": (3,), "axis": (3,), "forward": (3,)}


@dataclass(frozen=True, eq=False, kw_only=True)
class DomeLight(Light):
    """Light from all around. ``rotation``: dome to world, shape [3, 3]; in the dome's frame the pole is +Y and the
    OpenEXR latlong centre (longitude 0) is +Z. ``texture``: index into ``Scene.textures`` or -1.
    ``camera_visible``: whether camera rays see it."""

    rotation: np.ndarray = constant(((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0)))
    texture: int = -1
    camera_visible: bool = True

    def _arrays(self) -> dict[str, tuple[int, ...]]:
        return {"rotation": (3, 3)}


@dataclass(frozen=True, eq=False, kw_only=True)
class MeshLight(Light):
    """Light from every triangle of instance ``instance``, from its outside."""

    instance: int
