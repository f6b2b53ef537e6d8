"""Layers that diffract -> device arrays: scratches cut to the triangles, wavelengths, reflectances."""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
import warp as wp

from ..optics import spectra
from ..plan import EffectPlan
from ..plan.knobs import value
from ..plan.waves import REGULAR, WaveLayerPlan, is_grating, looks_up, looks_up_points, reflectances
from ..reflectance.diffraction.arrays import rules
from ..reflectance.diffraction.color import spectral_samples
from ..scene import Curves, Scene
from ..scratches.along import dealt, varied
from ..scratches.generate import random_scratches
from ..scratches.segments import SegmentSet, Stroke, build, foresee, surroundings
from .geometry import PackedGeometry
from .glint_arrays_device import BandData, GlintArrays, Spectrum, WaveLayer, WaveMaterial
from .glint_crowds import Crowds
from .glint_energy_device import BINS
from .glint_fringes import fringes
from .glint_maps import GlintMaps, directions
from .glint_tables import SHARES, bin_width, depth_shares, lobe_table, wavelengths_of, wide_table
from .key import KernelKey

COSINES = 33
SHOWN = 100_000
_SIZES = ("depth", "width")


@dataclass(frozen=True, eq=False)
class PackedGlints:
    """Device arrays, what must stay alive with them, and how many pieces of scratches there are."""

    arrays: GlintArrays
    segments: SegmentSet | None

    @property
    def count(self) -> int:
        """Pieces of scratches."""
        return self.segments.count if self.segments is not None else 0


# material, layer, cross-section
Numbered = tuple[int, int, int]


def _strokes(
    scene: Scene, plan: EffectPlan, key: KernelKey, shape: PackedGeometry, numbers: dict[Numbered, int], device: str
) -> list[Stroke]:
    made: list[Stroke] = []
    g, mesh = shape.arrays, shape.mesh
    assert mesh is not None
    surface = (g.points, g.uvs, g.dpdu, g.dpdv, mesh, device)
    material, instance = shape.arrays.material.numpy(), shape.arrays.instance.numpy()
    uv = shape.arrays.uvs.numpy().reshape(-1, 3, 2)
    scales = shape.arrays.pattern_scale.numpy()
    for m, wave in enumerate(plan.waves):
        for k, own_plan in enumerate(wave.layers if wave is not None else ()):
            layer, parts = own_plan.layer, len(own_plan.outlines)
            taken = material == m
            if layer.distribution in REGULAR or not key.glint_segments or not taken.any():
                continue
            laid: list[tuple[Curves, Any]] = []
            if layer.distribution == "curves":
                flat = scales[instance[taken][0]] if layer.space == "surface" else np.ones(2)
                for c in layer.curves:
                    curves = scene.curves[c]
                    scale = np.full(3, 1e6) if curves.space == "object" else np.array([*flat, 1.0])
                    laid.append((varied(curves, layer, scale, False), taken))
            else:
                for i in np.unique(instance[taken]):
                    own = taken & (instance == i)
                    low, high = uv[own].min((0, 1)), uv[own].max((0, 1))
                    unit = (1.0, 1.0) if layer.space == "uv" else tuple(scales[i])
                    field = directions(scene, plan, layer, shape.arrays, own)
                    ends = tuple(low.tolist()), tuple(high.tolist())

                    def look(few: Curves, every: int, own: Any = own, number: int = numbers[m, k, 0]) -> None:
                        foresee(Stroke(few, number, own), every, *surface)

                    laid.append((random_scratches(layer, *ends, unit, field, True, look), own))
            for curves, own in laid:
                for v, part in enumerate(dealt(curves, layer, parts)):
                    made.append(Stroke(part, numbers[m, k, v], own))
    return made


# of a uniform spread over [-1, 1]: nodes, and weights that add up to 1
_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(6)
_SPREAD = tuple(zip(_NODES.tolist(), (0.5 * _WEIGHTS).tolist(), strict=True))


def _bands(plan: EffectPlan, numbers: dict[Numbered, int], mapped: GlintMaps) -> list[tuple[int, Any]]:
    """(material, record) of every regular pattern."""
    made: list[tuple[int, Any]] = []
    for (m, k, _), number in numbers.items():
        wave = plan.waves[m]
        assert wave is not None
        layer = wave.layers[k].layer
        if layer.distribution not in REGULAR or layer.pitch <= 0.0:
            continue
        sets = [(layer.angle, layer.offset[1])]
        if layer.distribution == "crosshatch":
            sets.append((layer.angle + layer.cross_angle, layer.offset[0]))
        for angle, offset in sets:
            straight = layer.distribution in ("linear", "crosshatch")
            maps = mapped.number(layer, angle if straight else None)
            for away, weight in _SPREAD if layer.width_variation > 0.0 else ((0.0, 1.0),):
                band: Any = BandData()
                band.kind = {"concentric": 1, "spiral": 2}.get(layer.distribution, 0)
                band.layer, band.uv_space = number, int(layer.space == "uv")
                band.coherent = int(is_grating(wave.wave, layer))
                band.cos_a, band.sin_a = math.cos(angle), math.sin(angle)
                band.cos_y, band.sin_y = band.cos_a, band.sin_a
                band.width = layer.width * (1.0 + away * layer.width_variation)
                band.depth, band.pitch = layer.depth, layer.pitch
                band.offset, band.center = offset, wp.vec2d(*layer.center)
                band.share, band.maps = weight / len(wave.layers[k].outlines), maps
                made.append((m, band))
    return made


def _spectrum(device: str) -> Spectrum:
    """The eye by wavelength, every nanometre over what it sees."""
    at = np.arange(380.0, 781.0)
    density = spectra.cmf(at)
    density /= density[1:-1].sum(0) + 0.5 * (density[0] + density[-1])
    white = spectra.rgb_to_xyz(np.ones(3))
    s: Any = Spectrum()
    s.first, s.step = 0.38, 1e-3
    colors = spectra.xyz_to_rgb(spectra.adapt(density, np.ones(3), white)) * 1e3
    s.colors = wp.array(colors.astype(np.float32), dtype=wp.vec3, device=device)
    return s


def _largest(plan: WaveLayerPlan, segments: SegmentSet | None, number: int, stretched: float) -> tuple[float, float]:
    """Greatest depth and width [um] of a layer; ``stretched``: micrometres of the uv square's side at most."""
    layer = plan.layer
    sizes = [layer.depth * (1.0 + layer.depth_variation), layer.width * (1.0 + layer.width_variation)]
    if layer.space == "uv":
        sizes = [size * stretched for size in sizes] if layer.distribution in REGULAR else [0.0, 0.0]
    if segments is not None and segments.count:
        rows = segments.segments.numpy()
        own = rows["layer"] == number
        sizes = [max(size, float(rows[name][own].max(initial=0.0))) for size, name in zip(sizes, _SIZES, strict=True)]
    return max(sizes[0], 1e-3), max(sizes[1], 1e-3)


def _shallowest(plan: WaveLayerPlan, segments: SegmentSet | None, number: int) -> float:
    """Least depth [um] of a layer."""
    layer = plan.layer
    if layer.distribution in REGULAR and layer.space != "uv":
        return layer.depth
    if segments is None or not segments.count:
        return 0.0
    rows = segments.segments.numpy()
    own = rows["depth"][rows["layer"] == number]
    return float(own.min()) if len(own) else 0.0


def pack(
    scene: Scene,
    plan: EffectPlan,
    key: KernelKey,
    shape: PackedGeometry,
    device: str = "cpu",
    progress: Callable[[int, int, str], None] | None = None,
) -> PackedGlints:
    """What the plan's diffracting layers need; empty arrays where nothing diffracts.

    ``progress``: called with (done, total, "scratches") while more than ``SHOWN`` of them are laid on the surface.
    """
    arrays: Any = GlintArrays()
    if not key.glints or shape.mesh is None:
        return PackedGlints(arrays, None)
    diffracting = [(m, w) for m, w in enumerate(plan.waves) if w is not None]
    numbers = {(m, k, v): 0 for m, w in diffracting for k, x in enumerate(w.layers) for v in range(len(x.outlines))}
    numbers = {pair: number for number, pair in enumerate(numbers)}
    strokes = _strokes(scene, plan, key, shape, numbers, device)
    crowds = Crowds(scene, plan, [m for m, _, _ in numbers]) if key.glint_crowds else None
    segments = None
    if key.glint_footprint in ("exact", "paper"):
        arrays.rules = rules((16,))
    arrays.slices = int(value(plan.settings.knobs, "diffraction.slices"))
    if key.glint_areas:
        at, weights = np.polynomial.legendre.leggauss(arrays.slices)
        nodes = np.stack([0.5 * (1.0 + at), 0.5 * weights], axis=1)
        arrays.nodes = wp.array(nodes.astype(np.float32), dtype=wp.vec2, device=device)
    if key.glint_fringes:
        arrays.fringes = wp.array(fringes(), dtype=wp.vec3, device=device)
    if strokes:
        g = shape.arrays
        shown = progress if sum(len(s.curves.counts) for s in strokes) > SHOWN else None
        steps = (lambda done, total: shown(done, total, "scratches")) if shown else None
        deal = crowds.deal if crowds is not None else None
        segments = build(strokes, g.points, g.uvs, g.dpdu, g.dpdv, shape.mesh, key.glint_hierarchy, device, steps, deal)
        if key.glint_lists:
            starts, around, reach = surroundings(g.points.numpy().reshape(-1, 3, 3))
            arrays.around_starts = wp.array(starts, dtype=int, device=device)
            arrays.around = wp.array(around, dtype=int, device=device)
            arrays.around_reach = wp.array(reach, dtype=float, device=device)
        arrays.segments, arrays.starts = segments.segments, segments.starts
        arrays.bvh = segments.bvh.id if segments.bvh is not None else 0
    which = np.full(max(len(scene.materials), 1), -1, np.int32)
    mapped = GlintMaps(key.glint_masks, key.glint_orientations)
    bands = _bands(plan, numbers, mapped) if key.glint_bands else []
    if bands:
        arrays.bands = wp.array([b for _, b in bands], dtype=BandData, device=device)
        if key.glint_gratings:
            arrays.spectrum = _spectrum(device)
    waves: list[Any] = []
    lams: list[np.ndarray] = []
    colors: list[np.ndarray] = []
    for number, (m, w) in enumerate(diffracting):
        which[m] = number
        record: Any = WaveMaterial()
        at, weights = wavelengths_of(w.wave)
        record.sigma, record.first, record.count = w.wave.coherence_radius, sum(len(x) for x in lams), len(at)
        record.longest = float(at[-1])
        record.coherent = int(w.wave.summation == "coherent")
        record.bin = bin_width(w.wave)
        record.bands = sum(material == m for material, _ in bands)
        record.first_band = next((n for n, (material, _) in enumerate(bands) if material == m), 0)
        if crowds is not None:
            record.first_group, record.groups, record.strands = crowds.of(m)
        waves.append(record)
        lams.append(at)
        colors.append(weights)
    layers: list[Any] = []
    shares: list[np.ndarray] = []
    reflect: list[np.ndarray] = []
    most = max(len(at) for at in lams)
    du, dv = shape.arrays.dpdu.numpy(), shape.arrays.dpdv.numpy()
    stretched = 1e6 * float(np.sqrt(max((du * du).sum(1).max(), (dv * dv).sum(1).max())))
    wides: list[np.ndarray] = []
    outlines: list[np.ndarray] = []
    lobes: list[np.ndarray] = []
    spectral = np.ones((len(numbers), COSINES, most), np.float32)
    for (m, k, v), number in numbers.items():
        w = plan.waves[m]
        assert w is not None
        cut = w.layers[k].outlines[v] if plan.on("diffraction.outlines") else None
        own = replace(w.layers[k], outline=cut, others=())
        row: Any = WaveLayer()
        row.wave, row.reflect, row.per_wavelength = int(which[m]), number, int(own.index is not None)
        row.roughness = w.wave.roughness
        row.maps = mapped.number(own.layer)
        spread = 0.0
        if own.layer.distribution in REGULAR:
            spread = own.layer.depth * own.layer.depth_variation / math.sqrt(3.0)
        row.depth_spread = spread
        deepest, widest = _largest(own, segments, number, stretched)
        row.share, row.share_count, row.share_step = len(shares) * SHARES, SHARES, deepest / (SHARES - 1)
        shares.append(depth_shares(deepest, w.wave.roughness, own.outline))
        row.angles = int(w.wave.phase == "angleDependent")
        row.fringes = int(key.glint_fringes and looks_up_points(w.wave, own))
        if own.outline is not None:
            row.outline, row.facets = sum(map(len, outlines)), len(own.outline)
            outlines.append(own.outline)
            shortest = float(lams[which[m]].min())
            if lobe := lobe_table(own.outline, 2.0 * widest / shortest, 2.0 * deepest / shortest, device):
                row.lobe, row.lobe_first, row.lobe_even = sum(x.size for x in lobes), lobe[1], int(lobe[1] > -0.1)
                row.lobe_depths, row.lobe_reaches = lobe[0].shape
                lobes.append(lobe[0])
        shallowest = _shallowest(own, segments, number)
        table = None
        if key.glint_lookup and looks_up(w.wave):
            table = wide_table(w.wave, (shallowest, deepest), 2.0 * widest, spread, own.outline)
        if table is not None:
            row.depth_first = shallowest
            row.wide = sum(x.size // 3 for x in wides)
            row.wide_depths, row.wide_reaches = table.shape[:2]
            row.depth_step = max(deepest - shallowest, 1e-6) / (table.shape[0] - 1)
            row.reach_step = 2.0 * widest / (table.shape[1] - 1)
            wides.append(table)
        color, by_wave = reflectances(own, np.linspace(0.0, 1.0, COSINES), lams[which[m]] * 1e3)
        reflect.append(color)
        spectral[number, :, : by_wave.shape[1]] = by_wave
        layers.append(row)

    def floats(values: Any, dtype: Any) -> Any:
        return wp.array(np.ascontiguousarray(values, np.float32), dtype=dtype, device=device)

    arrays.material = wp.array(which, dtype=int, device=device)
    arrays.waves = wp.array(waves, dtype=WaveMaterial, device=device)
    arrays.layers = wp.array(layers, dtype=WaveLayer, device=device)
    arrays.wavelengths = floats(np.concatenate(lams), float)
    arrays.colors = floats(np.concatenate(colors), wp.vec3)
    arrays.reflect = floats(np.stack(reflect), wp.vec3)
    arrays.spectral = floats(spectral, float)
    arrays.shares = floats(np.concatenate(shares), float)
    arrays.share_colors = floats(spectral_samples(BINS)[1], wp.vec3)
    if key.glint_masks or key.glint_orientations:
        arrays.maps = mapped.packed(scene, shape.arrays, device)
    if outlines:
        arrays.outlines = wp.array(np.concatenate(outlines), dtype=wp.vec4d, device=device)
    if lobes:
        arrays.lobes = floats(np.concatenate([x.ravel() for x in lobes]), float)
    if wides:
        arrays.wides = floats(np.concatenate([x.reshape(-1, 3) for x in wides]), wp.vec3)
    return PackedGlints(arrays, segments)
