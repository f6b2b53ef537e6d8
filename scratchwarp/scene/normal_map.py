"""A scratch normal map and the facets around its normals."""

from dataclasses import dataclass

from .checks import in_range, one_of

DEFORMATIONS = ("linear", "sqrt", "none")
FACETS = ("ashikhminShirley", "ward", "beckmann", "ggx")


@dataclass(frozen=True)
class NormalMap:
    """What model normalMap of a layer reflects by.

    Attributes:
        texture: index into ``Scene.textures``, tangent-space normals as n * 0.5 + 0.5 (raw).
        repeats: over the unit square of the uv set; strength: factor of the normals' x and y.
        deformation: linear, sqrt, or none for plain normal mapping.
        facets: their distribution; roughness: its widths along the layer's angle and across, in [0.001, 1].
    """

    texture: int
    repeats: tuple[float, float] = (1.0, 1.0)
    strength: float = 1.0
    deformation: str = "linear"
    facets: str = "ashikhminShirley"
    roughness: tuple[float, float] = (0.3, 0.1)

    def __post_init__(self) -> None:
        one_of("normal map", "normalDeformation", self.deformation, DEFORMATIONS)
        one_of("normal map", "facets", self.facets, FACETS)
        in_range("normal map", "normalStrength", self.strength, 0.0, 1e6)
        for value in self.repeats:
            in_range("normal map", "normalRepeats", value, -1e6, 1e6)
        for value in self.roughness:
            in_range("normal map", "facetRoughness", value, 1e-3, 1.0)
