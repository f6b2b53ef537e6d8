"""What a layer's model makes of it: another table than Raymond's, or a response over solid angle.

The comparison models of Raymond 2016, Figure 7: ``singleBounce`` (the table without inter-reflections), ``mirror`` (the
table with every facet a perfect mirror), ``fullTable`` (reflectances at many theta instead of Eq. 2), ``tabulatedNdf``
(the facets' distribution times masking) are tables; ``ashikhminShirley`` is a lobe over solid angle.
"""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import Any

from .. import optics
from ..reflectance import stencils
from ..reflectance.responses import RESPONSES, facets, stencil_response, tabulated
from ..scene import Layer, Measured, Scene
from ..scratches.expand import Sublayer, Threshold, sublayers
from .choice import ResponsePlan, TablePlan
from .profiles import cross_section


@dataclass(frozen=True)
class TableModel:
    """How a model changes a layer's table; the fields replace those of its ``TablePlan`` where they are given."""

    source: str = "traced"
    max_bounces: int | None = None
    theta_model: str | None = None
    lossless: bool = False


TABLE_MODELS = {
    "tabulatedNdf": TableModel(source="facets", max_bounces=1, theta_model="table"),
    "singleBounce": TableModel(max_bounces=1),
    "mirror": TableModel(lossless=True),
    "fullTable": TableModel(theta_model="full"),
}


def reflector_of(model: str, fresnel: Any, keeps: bool) -> tuple[Any, bool]:
    """The reflector of a layer's facets, and whether the base's diffuse term stays, under its model."""
    table = TABLE_MODELS.get(model)
    if table is not None and table.lossless and fresnel is not None:
        return optics.Mirror(), False
    return fresnel, keeps


def laid_out(layer: Layer, threshold: Threshold) -> tuple[Sublayer, ...]:
    """The sublayers of a layer, as ``scratches.expand`` makes them; a scratch normal map covers everything."""
    if layer.model == "normalMap" and layer.normal_map is not None:
        return (Sublayer(layer, "full", layer.angle, 1.0, seed=layer.seed),)
    return sublayers(layer, threshold)


def changed(plan: TablePlan, model: str) -> TablePlan:
    """A table's plan under a model."""
    table = TABLE_MODELS.get(model)
    if table is None:
        return plan
    bounces = plan.max_bounces if table.max_bounces is None else table.max_bounces
    theta = plan.theta_model if table.theta_model is None or plan.fresnel is None else table.theta_model
    return replace(plan, source=table.source, max_bounces=bounces, theta_model=theta, error=0.0)


class Responses:
    """Responses asked for so far, each once."""

    def __init__(self) -> None:
        self._plans: list[ResponsePlan] = []

    def index(self, layer: Layer, sized: Layer, fresnel: Any) -> int:
        """Number of the response that a layer's model asks for, -1 where it reflects by a table. ``sized``: the layer
        with the size of its scratches."""
        if layer.model == "ashikhminShirley":
            lobe = facets.fitted(cross_section(layer.profile, sized).polyline())
            return self._number(layer.model, lobe, fresnel, layer.label)
        if layer.model == "normalMap" and layer.normal_map is not None:
            return self._number(layer.model, layer.normal_map, fresnel, layer.label)
        return -1

    def _number(self, name: str, values: Any, fresnel: Any, user: str) -> int:
        reflecting = None if isinstance(fresnel, optics.Mirror) else fresnel
        for number, known in enumerate(self._plans):
            if (known.name, known.values, known.fresnel) == (name, values, reflecting):
                if user not in known.users:
                    self._plans[number] = replace(known, users=(*known.users, user))
                return number
        self._plans.append(ResponsePlan(name, values, reflecting, (user,)))
        return len(self._plans) - 1

    def plans(self) -> tuple[ResponsePlan, ...]:
        """All of them, by number."""
        return tuple(self._plans)


def base_responses(
    scene: Scene, used: Sequence[int], responses: tuple[ResponsePlan, ...], allowed: Callable[[str], bool]
) -> tuple[tuple[ResponsePlan, ...], tuple[int, ...]]:
    """(responses with those that stand in for bases, their numbers by material or -1).

    ``used``: materials that something is made of; ``allowed(effect)``: whether it may be on. Raises ValueError naming
    the material whose measurement cannot be read or means nothing.
    """
    found, bases = list(responses), []
    for number, material in enumerate(scene.materials):
        bases.append(-1)
        if number in used and material.measured is not None:
            try:
                name, values, albedo = measured_base(material.measured)
            except (ValueError, OSError) as error:
                raise ValueError(f"{material.path}: {error}") from None
            if allowed(RESPONSES[name].effect):
                bases[-1] = len(found)
                found.append(ResponsePlan(name, values, None, (material.path,), albedo))
    return tuple(found), tuple(bases)


def measured_base(record: Measured) -> tuple[str, Any, tuple[float, float, float]]:
    """(response, its values, about its albedo) of a measured base."""
    if record.source == "file":
        name, file = tabulated.measured_file(record.file, record.format)
        return name, file, tabulated.tabulated(file).albedo
    columns = zip(
        record.azimuth, record.width, record.a, record.b, record.kd, record.ks, record.alpha, record.color, strict=True
    )
    model = stencils.Model(
        tuple(stencils.Mode(*map(float, numbers), color) for *numbers, color in columns),
        beta=tuple(record.betas) if len(record.betas) else record.beta,
        background=record.background,
        k=record.k,
        specular_alpha=record.specular_alpha,
        retro=record.retro,
        mask=record.mask,
    )
    return "stencils", model, stencil_response.albedo(model)
