"""What the stage asks the renderer for: UsdRender settings, products and vars."""

from collections.abc import Iterable
from dataclasses import dataclass

from .camera import CONFORMS
from .checks import in_range, one_of

# What other renderers call the layers of a film.
ALIASES = {
    "Ci": "color",
    "rgb": "color",
    "rgba": "color",
    "C": "color",
    "a": "alpha",
    "A": "alpha",
    "z": "depth",
    "Z": "depth",
    "N": "normal",
    "Nn": "normal",
    "position": "P",
    "id": "primId",
}


@dataclass(frozen=True)
class RenderVar:
    """One AOV of a product: the channel name it is written under and where it comes from."""

    name: str
    source: str


@dataclass(frozen=True)
class RenderProduct:
    """One output file of the stage's render settings."""

    path: str
    name: str
    vars: tuple[RenderVar, ...] = ()


@dataclass(frozen=True)
class RenderOptions:
    """RenderSettings merged with its product; None where neither is authored.

    Attributes:
        path: RenderSettings prim path, "" when the stage has none.
        resolution: (width, height) in pixels; pixel_aspect: width of a pixel over its height.
        conform: aspectRatioConformPolicy; data_window: dataWindowNDC (xmin, ymin, xmax, ymax), (0, 0) bottom left.
        depth_of_field: False when disableDepthOfField is set.
        spp, seed, max_error, quality, integrator, max_depth: of ScratchRenderSettingsAPI, when authored.
        filter: box, gaussian or blackmanHarris; filter_width: pixels, full width.
        effects: (name, enabled) pairs that the stage forces. knobs: (name, value as text) pairs that it turns.
    """

    path: str = ""
    resolution: tuple[int, int] | None = None
    pixel_aspect: float = 1.0
    conform: str = "expandAperture"
    data_window: tuple[float, float, float, float] = (0.0, 0.0, 1.0, 1.0)
    depth_of_field: bool = True
    spp: int | None = None
    seed: int | None = None
    max_error: float | None = None
    quality: str | None = None
    integrator: str | None = None
    max_depth: int | None = None
    filter: str = "blackmanHarris"
    filter_width: float | None = None
    effects: tuple[tuple[str, bool], ...] = ()
    products: tuple[RenderProduct, ...] = ()
    knobs: tuple[tuple[str, str], ...] = ()

    def layers(self, known: Iterable[str]) -> tuple[tuple[str, ...], tuple[str, ...]]:
        """(layers that the products' vars ask for, in order; sources that are none of ``known``).

        Sources go by the layer's name or by what other renderers call it (``ALIASES``).
        """
        sources = dict.fromkeys(var.source for product in self.products for var in product.vars)
        names = {source: ALIASES.get(source, source) for source in sources}
        known = set(known)
        found = tuple(dict.fromkeys(name for name in names.values() if name in known))
        return found, tuple(source for source, name in names.items() if name not in known)

    def __post_init__(self) -> None:
        who = self.path or "render settings"
        one_of(who, "aspectRatioConformPolicy", self.conform, CONFORMS)
        one_of(who, "pixelFilter", self.filter, ("box", "gaussian", "blackmanHarris"))
        in_range(who, "pixelAspectRatio", self.pixel_aspect, 1e-6, 1e6)
