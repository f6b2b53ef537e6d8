"""Materials: a base surface and the scratches on it."""

from dataclasses import dataclass

import numpy as np

from .checks import all_finite, constant, freeze, in_range, one_of, put
from .layer import Layer, Wave
from .texture import TextureInput

Color = tuple[float, float, float]


@dataclass(frozen=True, eq=False)
class PreviewSurface:
    """The inputs of a UsdPreviewSurface; each a constant or a TextureInput."""

    diffuse_color: Color | TextureInput = (0.18, 0.18, 0.18)
    emissive_color: Color | TextureInput = (0.0, 0.0, 0.0)
    use_specular_workflow: bool = False
    specular_color: Color | TextureInput = (0.0, 0.0, 0.0)
    metallic: float | TextureInput = 0.0
    roughness: float | TextureInput = 0.5
    clearcoat: float | TextureInput = 0.0
    clearcoat_roughness: float | TextureInput = 0.01
    opacity: float | TextureInput = 1.0
    opacity_threshold: float = 0.0
    opacity_mode: str = "transparent"
    ior: float = 1.5
    normal: TextureInput | None = None

    def __post_init__(self) -> None:
        all_finite("UsdPreviewSurface", self)
        one_of("UsdPreviewSurface", "opacityMode", self.opacity_mode, ("transparent", "presence"))
        in_range("UsdPreviewSurface", "ior", self.ior, 0.0, 100.0)


@dataclass(frozen=True, eq=False)
class ScratchSurface:
    """The base that ``outputs:scratchwarp:surface`` names: a measured conductor, a dielectric or a Lambert surface.

    Attributes:
        base: conductor, dielectric or diffuse.
        metal: custom (use eta, k) or the name of a measured metal.
        eta, k: complex index of refraction for R, G, B.
        color: albedo of the diffuse base, or of the diffuse term under a dielectric; linear Rec.709.
        roughness: GGX alpha; anisotropy: in [-1, 1]; rotation: radians, counter-clockwise from the tangent.
        ior: real index of the dielectric.
    """

    base: str = "conductor"
    metal: str = "aluminium"
    eta: Color = (1.0, 1.0, 1.0)
    k: Color = (1.0, 1.0, 1.0)
    color: Color = (0.0, 0.0, 0.0)
    roughness: float = 0.05
    anisotropy: float = 0.0
    rotation: float = 0.0
    ior: float = 1.5

    def __post_init__(self) -> None:
        all_finite("ScratchSurface", self)
        one_of("ScratchSurface", "base", self.base, ("conductor", "dielectric", "diffuse"))
        one_of(
            "ScratchSurface",
            "metal",
            self.metal,
            ("custom", "aluminium", "gold", "copper", "silver", "iron", "brass"),
        )
        in_range("ScratchSurface", "roughness", self.roughness, 0.0, 1.0)
        in_range("ScratchSurface", "anisotropy", self.anisotropy, -1.0, 1.0)
        in_range("ScratchSurface", "ior", self.ior, 0.0, 100.0)


@dataclass(frozen=True, eq=False)
class Measured:
    """ScratchMeasuredAPI: a base in place of the surface, as highlight stencils or as the file of a measurement.

    Attributes:
        source: stencils or file. file: path of the measurement; format: auto, utia, merl or rgl.
        azimuth [n] (radians, counter-clockwise from the tangent), width, a, b, kd, ks, alpha [n], color [n, 3]: of each
            mode, the dominant one first.
        beta, background, k, specular_alpha: of the whole model. retro: highlights return the light.
        mask: smooth or binary. betas [n - 1]: of each crossing, in place of beta; empty: beta everywhere.
    """

    source: str = "stencils"
    file: str = ""
    format: str = "auto"
    azimuth: np.ndarray = constant(())
    width: np.ndarray = constant(())
    a: np.ndarray = constant(())
    b: np.ndarray = constant(())
    kd: np.ndarray = constant(())
    ks: np.ndarray = constant(())
    alpha: np.ndarray = constant(())
    color: np.ndarray = constant(())
    beta: float = 0.0
    background: float = 0.0
    k: float = 0.0
    specular_alpha: float = 1.0
    retro: bool = False
    mask: str = "smooth"
    betas: np.ndarray = constant(())

    def __post_init__(self) -> None:
        owner = "ScratchMeasuredAPI"
        all_finite(owner, self)
        one_of(owner, "source", self.source, ("stencils", "file"))
        one_of(owner, "format", self.format, ("auto", "utia", "merl", "rgl"))
        one_of(owner, "mask", self.mask, ("smooth", "binary"))
        modes = len(self.azimuth)
        for name in ("azimuth", "width", "a", "b", "kd", "ks", "alpha"):
            put(self, **{name: freeze(owner, f"modes:{name}", getattr(self, name), (modes,))})
        if len(self.betas):
            put(self, betas=freeze(owner, "modes:beta", self.betas, (max(modes - 1, 0),)))
        put(self, color=freeze(owner, "modes:color", np.reshape(self.color, (-1, 3)), (modes, 3)))


@dataclass(frozen=True, eq=False)
class Material:
    """A base and its scratch layers (in the order in which they cut), and diffraction data if they diffract.

    ``measured``: a base in place of ``surface``, which scratches that inherit still take after.
    """

    path: str
    surface: PreviewSurface | ScratchSurface = PreviewSurface()
    layers: tuple[Layer, ...] = ()
    wave: Wave | None = None
    uses_display_color: bool = False
    measured: Measured | None = None
