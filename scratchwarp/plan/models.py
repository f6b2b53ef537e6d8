"""What a layer's model makes of it: another table than Raymond's, or a response over solid angle.

The comparison models of Raymond 2016, Figure 7: ``singleBounce`` (the table without inter-reflections), ``mirror`` (the
table with every facet a perfect mirror), ``fullTable`` (reflectances at many theta instead of Eq. 2), ``tabulatedNdf``
(the facets' distribution times masking) are tables; ``ashikhminShirley`` is a lobe over solid angle.
"""

from dataclasses import dataclass, replace
from typing import Any

from .. import optics
from ..reflectance.responses import facets
from ..scene import Layer
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
