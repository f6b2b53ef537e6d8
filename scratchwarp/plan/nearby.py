"""Which layers of model auto go over from statistics to grooves where the camera comes near to them.

What is left out would show the switch: where the two ways do not lay scratches at the same places, or do not mean the
same brightness. ``grooves.handover`` forced on lays out all that can be.
"""

import math

import numpy as np

from ..scene import Layer, Scene, Settings
from .grooves import FAR, MOST
from .waves import WavePlan, is_grating

SHALLOW = 0.1  # depth in widths up to which a tilted diffuse facet is as bright as the ground (cosine above 0.98)
SMOOTH_BASE = 0.1  # roughness
WAVES = 10.0  # least width [um] of a scratch that diffracts and is laid out: some twenty wavelengths
_PLACED = ("linear", "crosshatch", "concentric", "spiral", "curves")


def number_of(layer: Layer, scene: Scene, area: float) -> float:
    """About how many pieces the scratches of a layer are laid out in on ``area`` square metres."""
    if layer.distribution == "curves":
        return float(sum(len(scene.curves[c].points) for c in layer.curves))
    unit = 1e6 * math.sqrt(area) if layer.space == "surface" else 1.0
    if layer.distribution in ("worley", "random"):
        each = max(layer.length, layer.width) * layer.width
        dense = layer.density * (1e-6 if layer.space == "surface" else 1.0)
        return unit * unit * (dense or layer.coverage / max(each, 1e-300))
    if repeats(layer):
        return 1.0
    lines = unit / max(layer.pitch, 1e-300)
    # chords of circles as wide as the surface
    return lines * max(math.sqrt(lines) * 8.0, 8.0) if layer.distribution in ("concentric", "spiral") else lines


def repeats(layer: Layer) -> bool:
    """Whether the lines of a layer take no more memory than one."""
    varies = layer.width_variation, layer.depth_variation, layer.variation_length, layer.profile_variation
    return layer.distribution in ("linear", "crosshatch") and not any(varies)


def nearest(scene: Scene, settings: Settings, size: tuple[int, int], number: int, layer: Layer) -> float:
    """Least width of a sample's footprint in widths of a layer of material ``number``, over all surfaces made of it;
    infinite where one of them has more than ``MOST`` of its scratches."""
    camera = scene.camera
    left, right, *_ = camera.window(*size, scene.options.conform, scene.options.pixel_aspect)
    pixel = (right - left) / size[0] / math.sqrt(settings.spp or 1)
    eye = camera.transform[:3, 3]
    least = math.inf
    for instance in scene.instances:
        if number not in instance.materials:
            continue
        mesh = scene.meshes[instance.mesh]
        corners = mesh.points[mesh.triangles] @ instance.transform[:3, :3].T + instance.transform[:3, 3]
        if not len(corners):
            continue
        area = 0.5 * float(np.linalg.norm(np.cross(*np.moveaxis(np.diff(corners, axis=1), 1, 0)), axis=-1).sum())
        if number_of(layer, scene, area) > MOST:
            return math.inf
        away = 1.0 if camera.projection == "orthographic" else distance(eye, corners)
        width = _width(layer, scene) * (1.0 if layer.space == "surface" else 1e6 * math.sqrt(max(area, 0.0)))
        least = min(least, 1.128e6 * pixel * away / max(width, 1e-300))
    return least


def distance(eye: np.ndarray, corners: np.ndarray) -> float:
    """Least distance of a point to triangles [n, 3, 3]."""
    edges = np.roll(corners, -1, axis=1) - corners
    to = eye - corners
    t = np.clip((to * edges).sum(-1) / np.maximum((edges * edges).sum(-1), 1e-300), 0.0, 1.0)
    least = float(np.linalg.norm(to - t[..., None] * edges, axis=-1).min())
    normal = np.cross(edges[:, 0], edges[:, 1])
    sides = (np.cross(edges, to) * normal[:, None]).sum(-1)
    over = (sides >= 0.0).all(1) & (normal != 0.0).any(1)
    if over.any():
        height = np.abs((to[over, 0] * normal[over]).sum(-1)) / np.linalg.norm(normal[over], axis=-1)
        least = min(least, float(height.min()))
    return least


def _width(layer: Layer, scene: Scene) -> float:
    """Width of the scratches of a layer, of explicit ones the mean, in the layer's unit."""
    if layer.distribution != "curves":
        return layer.width
    unit = "uv" if layer.space == "uv" else "um"
    own = [scene.curves[c].widths for c in layer.curves if scene.curves[c].width_unit == unit]
    return float(np.mean(np.concatenate(own))) if own else layer.width


def differs(layer: Layer) -> str:
    """Why a layer of its own is not handed over, empty where it can be."""
    if layer.distribution not in _PLACED:
        return f"{layer.distribution} scratches do not lie where they would as grooves"
    if layer.mask_texture >= 0 or layer.mask_primvar or layer.orientation_texture >= 0 or layer.orientation_primvar:
        return "maps move them or leave them out"
    if layer.variation_length > 0.0 or layer.width_variation > 0.0 or layer.profile_variation > 0.0:
        return "each has sizes of its own, drawn in another way"
    return ""


def near_layers(
    scene: Scene, settings: Settings, size: tuple[int, int], number: int, wave: WavePlan | None, asked: bool,
    reflects: dict[str, tuple[bool, bool]], smooth: bool = True,
) -> list[Layer]:  # fmt: skip
    """Layers of model auto of a material that are laid out where they are near.

    ``wave``: what of the material diffracts: all of that, or nothing. ``asked``: also what ``differs`` or changes its
    brightness. ``reflects``: label -> (whether it reflects by a table, whether the base's diffuse term stays);
    ``smooth``: whether the base is.
    """
    waved = {w.layer.label for w in wave.layers} if wave is not None else set()
    found: list[Layer] = []
    for layer in scene.materials[number].layers:
        if layer.model != "auto" or layer.width <= 0.0:
            continue
        tabled, diffuse = reflects.get(layer.label, (True, False))
        alike = not differs(layer) and tabled and (not diffuse or layer.depth <= SHALLOW * layer.width)
        if wave is not None and layer.label in waved:
            # holes and scratches of a rough base diffract as if it were smooth, and steep facets lose light
            shallow = smooth and layer.depth <= SHALLOW * layer.width
            alike = alike and shallow and layer.width >= WAVES and not is_grating(wave.wave, layer)
        if (alike or asked) and nearest(scene, settings, size, number, layer) < FAR:
            found.append(layer)
    if waved and not waved <= {layer.label for layer in found}:
        found = [layer for layer in found if layer.label not in waved]
    return found
