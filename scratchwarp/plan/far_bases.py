"""Scratched materials rendered as highlight stencils: the cheapest level of detail, for what is seen from far away."""

from collections.abc import Sequence

from ..reflectance import measured, stencils
from ..reflectance.responses import stencil_response
from ..scene import Scene
from .choice import LayerPlan, ResponsePlan, TablePlan
from .far_field import BLUR, albedo_error, tabulate_layers

Layers = tuple[tuple[LayerPlan, ...], ...]


def far_bases(
    scene: Scene,
    used: Sequence[int],
    layers: Layers,
    tables: tuple[TablePlan, ...],
    responses: tuple[ResponsePlan, ...],
    bases: tuple[int, ...],
) -> tuple[Layers, tuple[ResponsePlan, ...], tuple[int, ...], str, tuple[str, ...]]:
    """(layers left, responses, bases, how far each model is off, warnings): every scratched material that is one BRDF
    from far away becomes the base ``stencils``; the others keep their scratches, with a warning."""
    left, found, numbers = list(layers), list(responses), list(bases)
    said, warnings = [], []
    for number in used:
        path = scene.materials[number].path
        if not left[number] or numbers[number] >= 0:
            continue
        try:
            values = tabulate_layers(scene, scene.materials[number], left[number], tables, BLUR)
        except ValueError as error:
            warnings.append(f"scratches.stencil: {error}; {path} is rendered with its scratches")
            continue
        model = fitted(values)
        shown = stencils.unfolded(model)
        psnr, albedo = measured.compare(values, shown)["psnr"], albedo_error(values, shown)
        said.append(f"{path} {len(model.modes)} modes, PSNR {psnr:.1f} dB, albedo within {albedo:.2g}")
        numbers[number] = len(found)
        found.append(ResponsePlan("stencils", model, None, (path,), stencil_response.albedo(model)))
        left[number] = ()
    return tuple(left), tuple(found), tuple(numbers), "; ".join(said), tuple(warnings)


def fitted(values: object) -> stencils.Model:
    """The refined fit, or the direct one where scipy is missing."""
    try:
        return stencils.fit(values)
    except ImportError:
        return stencils.fit(values, refine=False)
