"""A scratched material seen from far away: its BRDF on the grid of a measurement, and highlight stencils fitted to it.

From far away a pixel holds so many scratches that only their mean is seen. The mean of a set of parallel scratches is
rho(phi_o, phi_i; theta) delta(theta_i + theta_o) / cos^2 theta; a grid of 15 by 7.5 degrees cannot hold the delta, nor
the spikes that flat facets put into rho, so that both are blurred by a normal distribution, as they are by a light and
a detector of that size. Sets share the area as they do where they are rendered (``kernels.layers_device``).
"""

from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from .. import profiles
from ..optics import metals
from ..reflectance import measured, stencils
from ..reflectance.base import BaseSurface, evaluate_base, preview_base
from ..reflectance.stencils.angles import grid_directions
from ..scene import Material, PreviewSurface, Scene, Settings
from .choice import EffectPlan, LayerPlan, TablePlan
from .layers import mean_color

BLUR = np.radians(3.75)  # half a step of azimuth
_COSINES = np.cos(np.radians((0.0, 15.0, 30.0, 45.0, 60.0, 70.0, 80.0)))
_PLACELESS = ("worley", "linear", "full")  # distributions whose direction is the same everywhere


@dataclass(frozen=True, eq=False)
class FarField:
    """A material as one BRDF: ``values`` float64 [288, 288, 3] [1/sr], the ``model`` fitted to them, and how far it is
    off, as ``measured.compare`` has it; ``albedo``: largest error of the light reflected by a view along the grid."""

    material: str
    values: np.ndarray
    model: stencils.Model
    error: dict[str, float]
    albedo: float
    notes: tuple[str, ...] = ()


def fit_far_field(
    scene: Scene, material: int | str = 0, modes: int | None = None, refine: bool = True, blur: float = BLUR
) -> FarField:
    """Fit highlight stencils to a material of ``scene``, by its number, path or name; ``blur`` [rad] as ``tabulate``.

    Raises as ``tabulate`` and ``stencils.fit`` do.
    """
    found, values, notes = tabulate(scene, material, blur)
    model = stencils.fit(values, modes, refine=refine)
    fitted = stencils.unfolded(model)
    return FarField(found.path, values, model, measured.compare(values, fitted), albedo_error(values, fitted), notes)


def tabulate(
    scene: Scene, material: int | str = 0, blur: float = BLUR, plan: EffectPlan | None = None
) -> tuple[Material, np.ndarray, tuple[str, ...]]:
    """(the material, its BRDF float64 [288, 288, 3] (illumination, view, rgb) [1/sr], what it stands for).

    ``blur`` [rad]: standard deviation of the light's direction, in (0, 0.5]. Raises ValueError on a material that is
    not there and on scratches that run in other directions at other places (concentric, spiral, curves).
    """
    if not 0.0 < blur <= 0.5:
        raise ValueError(f"blur must lie in (0, 0.5] rad, got {blur}")
    number = _number(scene, material)
    found = scene.materials[number]
    from .make import make_plan

    chosen = plan or make_plan(scene, Settings())
    layers = chosen.layers[number]
    values = tabulate_layers(scene, found, layers, chosen.tables, blur)
    notes = [f"{found.path}: {len(layers)} sets of scratches, blurred by {np.degrees(blur):.3g} degrees."]
    if any(value.__class__.__name__ == "TextureInput" for value in vars(found.surface).values()):
        notes.append("Textures count with their means.")
    if any(plan.variation is not None for plan in layers):
        notes.append("Scratches that differ count as the first of them.")
    return found, values, tuple(notes)


def tabulate_layers(
    scene: Scene,
    material: Material,
    layers: tuple[LayerPlan, ...],
    tables: tuple[TablePlan, ...],
    blur: float = BLUR,
) -> np.ndarray:
    """The BRDF [288, 288, 3] of a planned material; raises as ``evaluate`` does."""
    w = grid_directions()
    wi, wo = np.broadcast_to(w[:, None], (len(w), len(w), 3)), np.broadcast_to(w[None], (len(w), len(w), 3))
    return evaluate(scene, material, layers, tables, wi.reshape(-1, 3), wo.reshape(-1, 3), blur).reshape(wi.shape)


def albedo_error(reference: np.ndarray, found: np.ndarray) -> float:
    """Largest difference of what a view of the grid sees under a uniform sky, of any channel."""
    w = grid_directions()
    theta = np.arccos(np.clip(w[:, 2], -1.0, 1.0))
    band = np.radians(15.0)
    # each ring of the grid stands for its band of elevations; the normal's for a cap
    cosine = 0.5 * (np.sin(theta + 0.5 * band) ** 2 - np.sin(np.maximum(theta - 0.5 * band, 0.0)) ** 2)
    sky = cosine * 2.0 * np.pi / 48.0
    return float(np.abs(np.einsum("i,ioc->oc", sky, np.asarray(found) - np.asarray(reference))).max())


def evaluate(
    scene: Scene,
    material: Material,
    layers: tuple[LayerPlan, ...],
    tables: tuple[TablePlan, ...],
    wi: np.ndarray,
    wo: np.ndarray,
    blur: float = BLUR,
) -> np.ndarray:
    """f_r [1/sr], float64 [n, 3], of a planned material for unit directions [n, 3] above the horizon."""
    for plan in layers:
        if plan.response >= 0:
            raise ValueError(f"{plan.sublayer.layer.label}: model {plan.sublayer.layer.model} has no profile table")
        if plan.sublayer.distribution not in _PLACELESS:
            raise ValueError(
                f"{plan.sublayer.layer.label}: {plan.sublayer.distribution} scratches run in other directions at other "
                "places, so that they are no one BRDF"
            )
    covers = np.array([plan.sublayer.coverage for plan in layers])
    bare = float(np.prod(1.0 - np.minimum(covers, 1.0)))
    share = (1.0 - bare) / covers.sum() if covers.sum() > 0.0 else 0.0
    kept = float(share * covers[[plan.keeps_diffuse for plan in layers]].sum()) if len(layers) else 0.0
    base = _base(scene, material, blur)
    value = evaluate_base(base, wi, wo, bare + kept, bare).astype(np.float64) / np.maximum(wi[:, 2:], 1e-6)
    ready: dict[int, np.ndarray] = {}
    for plan, cover in zip(layers, covers, strict=True):
        if plan.lambert:
            value += share * cover * np.asarray(plan.diffuse) / np.pi
            continue
        if plan.table not in ready:
            ready[plan.table] = blurred_slices(tables[plan.table], blur)
        value += share * cover * parallel(ready[plan.table], plan.sublayer.angle, wi, wo, blur)
    return value


def blurred_slices(plan: TablePlan, blur: float) -> np.ndarray:
    """rho_s [thetas, M, M, 3] at the cosines of ``parallel``, facets blurred by ``blur`` [rad] in phi_o and phi_i."""
    table = profiles.simulate(
        plan.profile, resolution=128, rays=max(plan.rays, 256), fresnel=plan.fresnel, max_bounces=plan.max_bounces,
        theta_model=plan.theta_model, store=profiles.store(),
    )  # fmt: skip
    apart = table.angles[:, None] - table.angles[None, :]
    spread = np.exp(-((apart / blur) ** 2))  # half of the variance on either side of the reflection
    spread /= spread.sum(axis=0, keepdims=True)
    weights = table.weights[:, None] * table.weights[None, :]
    reached = spread @ table.weights
    found = []
    for cosine in _COSINES:
        rho = table.slice(float(np.arccos(cosine)))
        rho = np.broadcast_to(rho[..., None] if rho.ndim == 2 else rho, (*rho.shape[:2], 3))
        # the light from bin to bin, moved to neighbours
        energy = np.einsum("ao,oic,bi->abc", spread, rho * weights[..., None], spread, optimize=True)
        found.append(energy / (reached[:, None] * reached[None, :])[..., None])
    return np.stack(found)


def parallel(rho: np.ndarray, azimuth: float, wi: np.ndarray, wo: np.ndarray, blur: float) -> np.ndarray:
    """f_r [n, 3] of scratches along ``azimuth`` that cover everything; ``rho`` as ``blurred_slices`` gives it."""
    u = np.array([np.cos(azimuth), np.sin(azimuth), 0.0])
    v = np.array([-np.sin(azimuth), np.cos(azimuth), 0.0])
    sin_i, sin_o = np.clip(wi @ u, -1.0, 1.0), np.clip(wo @ u, -1.0, 1.0)
    theta_i, theta_o = np.arcsin(sin_i), np.arcsin(sin_o)
    off = theta_i + theta_o
    near = np.abs(off) < 4.5 * blur
    value = np.zeros((len(wi), 3))
    if not np.any(near):
        return value
    cos_i, cos_o = np.cos(theta_i[near]), np.cos(theta_o[near])
    cone = np.exp(-0.5 * (off[near] / blur) ** 2) / (blur * np.sqrt(2.0 * np.pi))
    bins = rho.shape[1]
    at = [(np.arctan2(w[near] @ v, w[near][:, 2]) / np.pi + 0.5) * bins - 0.5 for w in (wo, wi)]
    cosine = np.clip(np.sqrt(cos_i * cos_o), _COSINES[-1], 1.0)
    level = np.interp(-cosine, -_COSINES, np.arange(len(_COSINES)))
    places = [level, *at]
    low = [np.clip(np.floor(p).astype(int), 0, size - 2) for p, size in zip(places, rho.shape[:3], strict=True)]
    high = [np.clip(p - n, 0.0, 1.0) for p, n in zip(places, low, strict=True)]
    found = np.zeros((len(cosine), 3))
    for corner in range(8):
        steps = [(corner >> k) & 1 for k in range(3)]
        weight = np.prod([h if s else 1.0 - h for h, s in zip(high, steps, strict=True)], axis=0)
        index = tuple(n + s for n, s in zip(low, steps, strict=True))
        found += weight[:, None] * rho[index]
    value[near] = found * (cone / (cos_i * cos_o))[:, None]
    return value


def _number(scene: Scene, material: int | str) -> int:
    paths = [m.path for m in scene.materials]
    if isinstance(material, int | np.integer) and 0 <= material < len(paths):
        return int(material)
    for number, path in enumerate(paths):
        if material in (path, path.rsplit("/", 1)[-1]):
            return number
    raise ValueError(f"material {material!r} is none of {scene.path}: {', '.join(p or '(no material)' for p in paths)}")


def _base(scene: Scene, material: Material, blur: float) -> BaseSurface:
    """The surface between the scratches, its lobe as wide as the blur makes it (slopes of half vectors add up)."""
    surface = material.surface
    if isinstance(surface, PreviewSurface):

        def one(name: str) -> Any:
            return np.clip(mean_color(getattr(surface, name), scene), 0.0, 1.0)

        names = ("metallic", "roughness", "clearcoat", "clearcoat_roughness")
        numbers: dict[str, Any] = {name: float(one(name)[0]) for name in names}
        base = preview_base(
            diffuse=one("diffuse_color"), specular_workflow=surface.use_specular_workflow,
            specular_color=one("specular_color"), ior=surface.ior, **numbers,
        )  # fmt: skip
    else:
        wide = surface.roughness * (1.0 + surface.anisotropy), surface.roughness * (1.0 - surface.anisotropy)
        if surface.base == "conductor":
            eta, k = metals.rgb(surface.metal) if surface.metal != "custom" else (surface.eta, surface.k)
            base = BaseSurface(fresnel="conductor", eta=eta, k=k, alpha_x=min(wide[0], 1.0), alpha_y=min(wide[1], 1.0))
        elif surface.base == "dielectric":
            base = BaseSurface(
                surface.color,
                fresnel="dielectric",
                ior=surface.ior,
                alpha_x=min(wide[0], 1.0),
                alpha_y=min(wide[1], 1.0),
            )
        else:
            base = BaseSurface(surface.color, specular=0.0)

    def wider(alpha: float) -> float:
        return min(float(np.sqrt(alpha**2 + 0.5 * blur**2)), 1.0)

    assert base.alpha_y is not None
    return replace(
        base, alpha_x=wider(base.alpha_x), alpha_y=wider(base.alpha_y), clearcoat_alpha=wider(base.clearcoat_alpha)
    )
