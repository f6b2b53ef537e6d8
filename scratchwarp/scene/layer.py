"""Scratch layers: what a material's ScratchLayerAPI instances say."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from .checks import all_finite, freeze, in_range, one_of, put
from .normal_map import NormalMap

SHAPES = ("flat", "vGroove", "rectangle", "trapezoid", "round", "quartic", "gaussian", "sine", "points")
MODELS = (
    "auto",
    "table",
    "diffraction",
    "groove",
    "normalMap",
    "ashikhminShirley",
    "tabulatedNdf",
    "singleBounce",
    "mirror",
    "fullTable",
)
DISTRIBUTIONS = ("worley", "random", "linear", "concentric", "spiral", "crosshatch", "curves")
SPACES = ("surface", "uv")
MATERIALS = ("inherit", "conductor", "dielectric", "diffuse")
FRESNELS = ("exact", "schlick", "lazanyi", "lazanyiError", "mirror")


@dataclass(frozen=True, eq=False)
class Profile:
    """A ScratchProfile prim: normalised, x in widths over [0, 1], z in depths (0 surface, -1 deepest, rims > 0).

    Attributes:
        path: prim path. shape: one of ``SHAPES``; points: (x, z) of shape "points", shape [n, 2].
        rim: height of the ridges on either side, in depths; rim_width: what each takes of the width.
        periodic: the profile repeats without flat ground between.
        parameters: the shape's own attributes (for example ``floorWidth``) by their schema name.
    """

    path: str
    shape: str = "vGroove"
    points: np.ndarray | None = None
    rim: float = 0.0
    rim_width: float = 0.25
    periodic: bool = False
    parameters: tuple[tuple[str, float], ...] = ()

    def __post_init__(self) -> None:
        all_finite(self.path, self)
        one_of(self.path, "scratch:shape", self.shape, SHAPES)
        if self.shape == "points" and self.points is None:
            raise ValueError(f"{self.path}: scratch:points is empty; shape 'points' needs at least two (x, z) points")
        if self.points is not None:
            put(self, points=freeze(self.path, "scratch:points", self.points, (None, 2)))


@dataclass(frozen=True, eq=False)
class Layer:
    """One layer of scratches. Lengths in micrometres (space surface) or fractions of the uv square (space uv).

    Attributes:
        name: instance name; prim: path of the Material, for messages; profile: the cross-section.
        order: layers cut in ascending order, ties by name.
        model, distribution, space, material, fresnel: tokens of the schema.
        width, depth, length: mean scratch size; depth is in the unit of width.
        coverage: area fraction in [0, 1] (statistical distributions); density: scratches a square millimetre
            (overrides coverage when positive); pitch: distance between regular scratches, in the unit of width.
        angle, angle_spread: radians, counter-clockwise from the surface's u.
        curvature: radians of turn for each ``length`` travelled along the scratch.
        offset: shift of the pattern in cells, shape [2]; center: uv of concentric and spiral patterns, shape [2].
        seed: of the layout; width_variation, depth_variation: relative, each scratch within 1 -+ this.
        metal, eta, k, ior, diffuse_color: of the scratch's own material when ``material`` is not inherit.
        curves: indices into ``Scene.curves``.
        patterns: overlaid sets of parallel scratches of a worley layer, each turned within ``angle_spread``.
        cross_angle: radians between the two sets of a crosshatch.
        variation_length: how far one goes along a scratch until its width, depth and profile have changed and come
            back, in the unit of length; 0: each scratch is alike all along.
        mask_texture, orientation_texture: indices into ``Scene.textures``, -1: none; mask_primvar, orientation_primvar:
            names in ``Mesh.primvars``, empty: none; orientation_encoding: angle or vector. The primvar of an
            orientation wins over its texture.
        profile_end, profile_variation: another cross-section, and how far scratches go towards it at most, in [0, 1].
        extra: further attributes by schema name, as authored.
        normal_map: of model normalMap.
    """

    name: str
    prim: str
    profile: Profile
    order: int = 0
    model: str = "auto"
    distribution: str = "worley"
    space: str = "surface"
    width: float = 10.0
    depth: float = 1.0
    length: float = 1000.0
    coverage: float = 0.1
    density: float = 0.0
    pitch: float = 100.0
    angle: float = 0.0
    angle_spread: float = 0.0
    curvature: float = 0.0
    offset: tuple[float, float] = (0.0, 0.0)
    center: tuple[float, float] = (0.5, 0.5)
    seed: int = 0
    width_variation: float = 0.0
    depth_variation: float = 0.0
    material: str = "inherit"
    fresnel: str = "exact"
    metal: str = "custom"
    eta: tuple[float, float, float] = (1.0, 1.0, 1.0)
    k: tuple[float, float, float] = (1.0, 1.0, 1.0)
    ior: float = 1.5
    diffuse_color: tuple[float, float, float] = (0.18, 0.18, 0.18)
    curves: tuple[int, ...] = ()
    patterns: int = 1
    cross_angle: float = np.pi / 2
    extra: tuple[tuple[str, Any], ...] = ()
    variation_length: float = 0.0
    profile_variation: float = 0.0
    profile_end: Profile | None = None
    normal_map: NormalMap | None = None
    mask_texture: int = -1
    mask_primvar: str = ""
    orientation_texture: int = -1
    orientation_encoding: str = "vector"
    orientation_primvar: str = ""

    def __post_init__(self) -> None:
        who = self.label
        one_of(who, "orientationEncoding", self.orientation_encoding, ("angle", "vector"))
        one_of(who, "model", self.model, MODELS)
        one_of(who, "distribution", self.distribution, DISTRIBUTIONS)
        one_of(who, "space", self.space, SPACES)
        one_of(who, "material", self.material, MATERIALS)
        one_of(who, "fresnelModel", self.fresnel, FRESNELS)
        for name in ("width", "depth", "length", "density", "pitch"):
            in_range(who, name, getattr(self, name), 0.0, 1e12)
        in_range(who, "variationLength", self.variation_length, 0.0, 1e12)
        in_range(who, "coverage", self.coverage, 0.0, 1.0)
        in_range(who, "widthVariation", self.width_variation, 0.0, 1.0)
        in_range(who, "depthVariation", self.depth_variation, 0.0, 1.0)
        in_range(who, "profileVariation", self.profile_variation, 0.0, 1.0)
        turns = {"angle": self.angle, "angleSpread": self.angle_spread, "curvature": self.curvature}
        for name, turn in {**turns, "crossAngle": self.cross_angle}.items():
            in_range(who, f"{name} in radians", turn, -1e6, 1e6)
        for name, pair in {"offset": self.offset, "center": self.center}.items():
            for value in pair:
                in_range(who, name, value, -1e12, 1e12)
        in_range(who, "patterns", self.patterns, 1, 64)
        in_range(who, "seed", self.seed, 0, 2**32 - 1)
        for value in self.diffuse_color:
            in_range(who, "diffuseColor", value, 0.0, 1.0)
        all_finite(who, self)

    @property
    def label(self) -> str:
        """The Material's path and the layer's name, as messages show it."""
        return f"{self.prim} layer {self.name!r}"


@dataclass(frozen=True, eq=False)
class Wave:
    """ScratchWaveAPI: coherence radius [um], wavelengths [nm], tabulated index of refraction."""

    coherence_radius: float = 60.0
    wavelength_range: tuple[float, float] = (380.0, 780.0)
    samples: int = 16
    ior: np.ndarray | None = None  # [n, 3]: wavelength [nm], eta, k
    phase: str = "smallAngle"
    summation: str = "incoherent"
    sampling: str = "auto"
    roughness: float = 0.0  # [um]

    def __post_init__(self) -> None:
        all_finite("ScratchWaveAPI", self)
        in_range("ScratchWaveAPI", "coherenceRadius", self.coherence_radius, 1e-6, 1e9)
        in_range("ScratchWaveAPI", "samples", self.samples, 1, 1024)
        in_range("ScratchWaveAPI", "roughness", self.roughness, 0.0, 1e12)
        for wavelength in self.wavelength_range:
            in_range("ScratchWaveAPI", "wavelengthRange", wavelength, 100.0, 20000.0)
        if not self.wavelength_range[0] < self.wavelength_range[1]:
            raise ValueError(f"ScratchWaveAPI: wavelengthRange is {self.wavelength_range}; the first must be smaller")
        if self.ior is not None:
            put(self, ior=freeze("ScratchWaveAPI", "ior", self.ior, (None, 3)))


@dataclass(frozen=True, eq=False)
class Curves:
    """Explicit scratches: polylines of one BasisCurves prim.

    Attributes:
        path: prim path.
        points: world metres relative to ``Scene.origin`` (space object) or (u, v, 0) (space uv), shape [n, 3].
        counts: points of each curve, shape [c], int32.
        widths: full width, shape [n]; depths: shape [n].
        space: object or uv.
        width_unit, depth_unit: um, or uv for fractions of the uv square's side (possible in space uv only).
    """

    path: str
    points: np.ndarray
    counts: np.ndarray
    widths: np.ndarray
    depths: np.ndarray
    space: str = "object"
    width_unit: str = "um"
    depth_unit: str = "um"

    def __post_init__(self) -> None:
        one_of(self.path, "scratch:curves:space", self.space, ("object", "uv"))
        one_of(self.path, "width_unit", self.width_unit, ("um", "uv"))
        one_of(self.path, "depth_unit", self.depth_unit, ("um", "uv"))
        points = freeze(self.path, "points", self.points, (None, 3))
        counts = freeze(self.path, "curveVertexCounts", self.counts, (None,), np.int32)
        if int(counts.sum()) != len(points):
            raise ValueError(f"{self.path}: curveVertexCounts add up to {int(counts.sum())}, points has {len(points)}")
        widths = freeze(self.path, "widths", self.widths, (len(points),))
        put(
            self,
            points=points,
            counts=counts,
            widths=widths,
            depths=freeze(self.path, "primvars:scratch:depth", self.depths, (len(points),)),
        )
