"""How the effects of wave optics are decided; rules as in ``effects``."""

import math
from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from ..scene import Layer, Scene, Settings
from .crowds import around, crowded, crowds, lit
from .waves import REGULAR, is_grating, looks_up, looks_up_points

# circles, spirals and curves go their own way
TURNED = ("linear", "crosshatch", "random", "worley")

MOST_AROUND = 10_000.0
"""Pieces on a triangle and its neighbours that are looked through rather than sought in a hierarchy."""

Answer = tuple[bool, str, tuple[str, ...]]


def _layers(f: Any) -> list[Layer]:
    return [p.layer for own in f.waves if own is not None for p in own.layers]


def _answer(labels: list[str], on: str, off: str) -> Answer:
    unique = tuple(dict.fromkeys(labels))
    return bool(unique), on if unique else off, unique


def _diffraction(f: Any) -> Answer:
    lit = _layers(f)
    if not lit and any(m.wave is not None for m in f.materials):
        return False, "ScratchWaveAPI is there, but no visible layer of model auto or diffraction", ()
    return _answer([x.label for x in lit], "scratches under ScratchWaveAPI", "no material has ScratchWaveAPI")


def _segments(f: Any) -> Answer:
    found = [x.label for x in _layers(f) if x.distribution not in REGULAR]
    return _answer(found, "scratches one by one, cut to the triangles", "no scratch that diffracts lies by itself")


def footprint_and_triangle(scene: Scene, settings: Settings, waves: Sequence[Any]) -> tuple[float, float]:
    """(edge of a sample's footprint, edge of a triangle) [m], both typical of what diffracts; settings are decided."""
    camera = scene.camera
    assert settings.width and settings.height and settings.spp
    left, right, _, _ = camera.window(settings.width, settings.height, scene.options.conform, 1.0)
    edge = (right - left) / settings.width / math.sqrt(settings.spp)
    sizes, far = [], []
    for instance in scene.instances:
        if not any(waves[m] is not None for m in instance.materials):
            continue
        mesh, matrix = scene.meshes[instance.mesh], instance.transform
        points = mesh.points @ matrix[:3, :3].T + matrix[:3, 3]
        some = mesh.triangles[:: max(1, len(mesh.triangles) // 1000)]
        if len(some):
            corners = points[some]
            double = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1)
            sizes.append(float(np.sqrt(np.median(double))))
            far.append(float(np.median(np.linalg.norm(corners[:, 0] - camera.transform[:3, 3], axis=1))))
    if not sizes:
        return 0.0, 0.0
    return edge * (1.0 if camera.projection == "orthographic" else min(far)), min(sizes)


def _lists(f: Any) -> Answer:
    found = _segments(f)
    if not found[0]:
        return False, "nothing to find", ()
    footprint, triangle = footprint_and_triangle(f.scene, f.settings, f.waves)
    said = f"footprints of {footprint:.2g} m on triangles of {triangle:.2g} m"
    counts = around(f.scene, f.waves, triangle)
    if 4.0 * footprint <= triangle and max(counts, default=0.0) > MOST_AROUND:
        return False, f"about {max(counts):.2g} pieces on a triangle and its neighbours, too many to look through", ()
    if 4.0 * footprint <= triangle:
        return True, f"pieces by triangle where the footprint fits its neighbours: {said}", found[2]
    return False, f"footprints would leave the neighbours of a triangle: {said}", ()


def _hierarchy(f: Any) -> Answer:
    found = _segments(f)
    return found[0], "pieces in a hierarchy where lists do not do" if found[0] else "nothing to find", found[2]


def _crowds(f: Any) -> Answer:
    if not _segments(f)[0]:
        return False, "nothing to find", ()
    counts = crowds(f.scene, f.waves, *footprint_and_triangle(f.scene, f.settings, f.waves))
    found = [m.path for m, count in zip(f.scene.materials, counts, strict=False) if crowded(count, f.settings)]
    held, most = f"about {max(counts, default=0.0):.2g} scratches under a footprint", lit(f.settings.knobs)
    if found:
        drawn = f"{most} of them are drawn for each sample" if most else "all of them are summed, as asked for"
        return True, f"{held}: {drawn}", tuple(found)
    return False, f"{held}, few enough to sum", ()


def _bands(f: Any) -> Answer:
    found = [x.label for x in _layers(f) if x.distribution in REGULAR]
    return _answer(found, "regular patterns, summed in closed form", "no regular pattern diffracts")


def _coherent(f: Any) -> Answer:
    waves = [own for own in f.waves if own is not None]
    found = [p.layer.label for own in waves for p in own.layers if is_grating(own.wave, p.layer)]
    return _answer(found, "patterns closer than light is coherent show orders", "no grating is to be summed coherently")


def _pairs(f: Any) -> Answer:
    waves = [own for own in f.waves if own is not None and own.wave.summation == "coherent"]
    found = [p.layer.label for own in waves for p in own.layers if p.layer.distribution not in REGULAR]
    return _answer(found, "scratches under one footprint interfere", "no single scratches are to be summed coherently")


def _masks(f: Any) -> Answer:
    found = [x.label for x in _layers(f) if x.mask_texture >= 0 or x.mask_primvar]
    return _answer(found, "masks say where these scratches are", "no layer that diffracts has a mask")


def _orientation(f: Any) -> Answer:
    layers = [x for x in _layers(f) if x.distribution in TURNED]
    found = [x.label for x in layers if x.orientation_texture >= 0 or x.orientation_primvar]
    return _answer(found, "maps turn these scratches", "no layer that diffracts has a map of directions")


def _areas(f: Any) -> Answer:
    if not _layers(f):
        return False, "nothing diffracts", ()
    found = [x.path for x in f.scene.lights if not getattr(x, "point", False) and getattr(x, "angle", 1.0) > 0.0]
    return _answer(found, "lights with an extent, integrated slice by slice", "every light is a point or a direction")


def _lookup(f: Any) -> Answer:
    if not _areas(f)[0]:
        return False, "no light has an extent", ()
    found = [p.layer.label for own in f.waves if own is not None for p in own.layers if looks_up(own.wave)]
    return _answer(found, "colours under area lights come from a table", "wavelengths are sampled, as asked for")


def _distant_lookup(f: Any) -> Answer:
    if not any(getattr(x, "point", False) or getattr(x, "angle", 1.0) == 0.0 for x in f.scene.lights):
        return False, "every light has an extent", ()
    waves = [own for own in f.waves if own is not None]
    found = [p.layer.label for own in waves for p in own.layers if looks_up_points(own.wave, p)]
    on = "colours under lights without extent come from a table, no wavelength sampled"
    return _answer(found, on, "wavelengths are sampled, as asked for or as cross-sections need it")


def _outlines(f: Any) -> Answer:
    waves = [own for own in f.waves if own is not None]
    found = [p.layer.label for own in waves for p in own.layers if any(x is not None for x in p.outlines)]
    return _answer(found, "cross-sections other than rectangles, integrated numerically", "every one is a rectangle")


def _angles(f: Any) -> Answer:
    waves = [own for own in f.waves if own is not None and own.wave.phase == "angleDependent"]
    found = [p.layer.label for own in waves for p in own.layers]
    return _answer(found, "phases of depths depend on the directions, integrated numerically", "small angles")


def _never(text: str) -> Callable[[Any], Answer]:
    return lambda f: (False, text, ())


WAVE_EFFECTS: dict[str, Callable[[Any], Answer]] = {
    "diffraction": _diffraction,
    "diffraction.segments": _segments,
    "diffraction.lists": _lists,
    "diffraction.hierarchy": _hierarchy,
    "diffraction.crowds": _crowds,
    "diffraction.bands": _bands,
    "diffraction.coherent": _coherent,
    "diffraction.pairs": _pairs,
    "diffraction.masks": _masks,
    "diffraction.orientation": _orientation,
    "diffraction.areaLights": _areas,
    "diffraction.lookup": _lookup,
    "diffraction.distantLookup": _distant_lookup,
    "diffraction.outlines": _outlines,
    "diffraction.angles": _angles,
    "diffraction.exactFootprint": _never("Gaussian footprints; on: ellipses, integrated across the scratch"),
    "diffraction.paperFootprint": _never("Gaussian footprints; on: ellipses by Velinov 2018 Eq. 15 and 16, mended"),
    "diffraction.pointFootprint": _never("Gaussian footprints; on: the sample's point alone, nothing antialiases"),
    "diffraction.closedForm": _never("lights in slices; on: the slice xi_1 = 0 alone (Velinov 2018 Eq. 27)"),
    "diffraction.paperLights": _never("exact sine integral; on: Velinov 2018 Eq. 27 with Eq. 29"),
}
"""Effect -> its rule."""
