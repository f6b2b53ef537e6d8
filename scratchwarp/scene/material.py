"""Materials: a base surface and the scratches on it."""

from dataclasses import dataclass

from .checks import in_range, one_of
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
class Material:
    """A base and its scratch layers (in the order in which they cut), and diffraction data if they diffract."""

    path: str
    surface: PreviewSurface | ScratchSurface = PreviewSurface()
    layers: tuple[Layer, ...] = ()
    wave: Wave | None = None
    uses_display_color: bool = False
