"""Layers that diffract -> device arrays: scratches cut to the triangles, wavelengths, reflectances."""

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
import warp as wp

from ..optics import spectra
from ..plan import EffectPlan
from ..plan.waves import REGULAR, WaveLayerPlan, is_grating, reflectances
from ..reflectance.diffraction.color import spectral_samples
from ..scene import Scene, Wave
from ..scratches.generate import random_scratches
from ..scratches.segments import SegmentSet, Stroke, build
from .geometry import PackedGeometry
from .glint_arrays_device import BandData, GlintArrays, Spectrum, WaveLayer, WaveMaterial
from .key import KernelKey

COSINES = 33
SHARES = 1024
"""Depths at which the mean |D|^2 of a layer is tabulated."""


@dataclass(frozen=True, eq=False)
class PackedGlints:
    """Device arrays, what must stay alive with them, and how many pieces of scratches there are."""

    arrays: GlintArrays
    segments: SegmentSet | None

    @property
    def count(self) -> int:
        """Pieces of scratches."""
        return self.segments.count if self.segments is not None else 0


def wavelengths_of(wave: Wave) -> tuple[np.ndarray, np.ndarray]:
    """Wavelengths [um], the longest last, and linear Rec.709 of each; they add up to (1, 1, 1)."""
    if wave.sampling == "rgb":
        at, weights = spectral_samples("rgb")
    else:
        first, last = wave.wavelength_range
        n = max(wave.samples, 1)
        at = 1.0 / (1.0 / first - (np.arange(n) + 0.5) * ((1.0 / first - 1.0 / last) / n))
        _, weights = spectral_samples(at) if n > 1 else spectral_samples(1)
        if (first, last) == (380.0, 780.0):
            at, weights = spectral_samples(n)
    order = np.argsort(at)
    return at[order] * 1e-3, weights[order]


def _strokes(
    scene: Scene, plan: EffectPlan, key: KernelKey, shape: PackedGeometry, numbers: dict[tuple[int, int], int]
) -> list[Stroke]:
    made: list[Stroke] = []
    material, instance = shape.arrays.material.numpy(), shape.arrays.instance.numpy()
    uv = shape.arrays.uvs.numpy().reshape(-1, 3, 2)
    scales = shape.arrays.pattern_scale.numpy()
    for (m, k), number in numbers.items():
        wave = plan.waves[m]
        assert wave is not None
        layer = wave.layers[k].layer
        if layer.distribution in REGULAR or not key.glint_segments:
            continue
        taken = material == m
        if layer.distribution == "curves":
            made += [Stroke(scene.curves[c], number, taken) for c in layer.curves]
            continue
        for i in np.unique(instance[taken]):
            own = taken & (instance == i)
            low, high = uv[own].min((0, 1)), uv[own].max((0, 1))
            scale = (1.0, 1.0) if layer.space == "uv" else tuple(scales[i])
            laid = random_scratches(layer, tuple(low.tolist()), tuple(high.tolist()), scale)
            made.append(Stroke(laid, number, own))
    return made


def _bands(plan: EffectPlan, numbers: dict[tuple[int, int], int]) -> list[tuple[int, Any]]:
    """(material, record) of every regular pattern."""
    made: list[tuple[int, Any]] = []
    for (m, k), number in numbers.items():
        wave = plan.waves[m]
        assert wave is not None
        layer = wave.layers[k].layer
        if layer.distribution not in REGULAR or layer.pitch <= 0.0:
            continue
        sets = [(layer.angle, layer.offset[1])]
        if layer.distribution == "crosshatch":
            sets.append((layer.angle + layer.cross_angle, layer.offset[0]))
        for angle, offset in sets:
            band: Any = BandData()
            band.kind = {"concentric": 1, "spiral": 2}.get(layer.distribution, 0)
            band.layer, band.uv_space = number, int(layer.space == "uv")
            band.coherent = int(is_grating(wave.wave, layer))
            band.cos_a, band.sin_a = math.cos(angle), math.sin(angle)
            band.width, band.depth, band.pitch = layer.width, layer.depth, layer.pitch
            band.offset, band.center = offset, wp.vec2d(*layer.center)
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


def _shares(plan: WaveLayerPlan, deepest: float, wave: Wave) -> np.ndarray:
    """Linear Rec.709 of the mean |D|^2 of depths from 0 to ``deepest`` [um], shape [SHARES, 3]."""
    at, weights = wavelengths_of(wave)
    k = 2.0 * np.pi * 2.0 / at
    depth = np.linspace(0.0, deepest, SHARES)[:, None]
    rough = np.exp(-0.5 * (k * wave.roughness) ** 2)
    return np.maximum((1.0 + rough**2 - 2.0 * rough * np.cos(k * depth)) @ weights, 0.0)


def _layer_deepest(plan: WaveLayerPlan, scene: Scene, segments: SegmentSet | None, number: int) -> float:
    deepest = 0.0 if plan.layer.space == "uv" else plan.layer.depth * (1.0 + plan.layer.depth_variation)
    if segments is not None and segments.count:
        rows = segments.segments.numpy()
        own = rows["depth"][rows["layer"] == number]
        deepest = max(deepest, float(own.max(initial=0.0)))
    return max(deepest, 1e-3)


def pack(scene: Scene, plan: EffectPlan, key: KernelKey, shape: PackedGeometry, device: str = "cpu") -> PackedGlints:
    """What the plan's diffracting layers need; empty arrays where nothing diffracts."""
    arrays: Any = GlintArrays()
    if not key.glints or shape.mesh is None:
        return PackedGlints(arrays, None)
    diffracting = [(m, w) for m, w in enumerate(plan.waves) if w is not None]
    numbers = {(m, k): 0 for m, w in diffracting for k in range(len(w.layers))}
    numbers = {pair: number for number, pair in enumerate(numbers)}
    strokes = _strokes(scene, plan, key, shape, numbers)
    segments = None
    if strokes:
        g = shape.arrays
        segments = build(strokes, g.points, g.uvs, g.dpdu, g.dpdv, shape.mesh, device=device)
        arrays.segments, arrays.starts = segments.segments, segments.starts
        arrays.bvh = segments.bvh.id if segments.bvh is not None else 0
    which = np.full(max(len(scene.materials), 1), -1, np.int32)
    bands = _bands(plan, numbers) if key.glint_bands else []
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
        record.bands = sum(material == m for material, _ in bands)
        record.first_band = next((n for n, (material, _) in enumerate(bands) if material == m), 0)
        waves.append(record)
        lams.append(at)
        colors.append(weights)
    layers: list[Any] = []
    shares: list[np.ndarray] = []
    reflect: list[np.ndarray] = []
    most = max(len(at) for at in lams)
    spectral = np.ones((len(numbers), COSINES, most), np.float32)
    for (m, k), number in numbers.items():
        w = plan.waves[m]
        assert w is not None
        own = w.layers[k]
        row: Any = WaveLayer()
        row.wave, row.reflect, row.per_wavelength = int(which[m]), number, int(own.index is not None)
        row.roughness = w.wave.roughness
        if own.layer.distribution in REGULAR:
            row.depth_spread = own.layer.depth * own.layer.depth_variation / math.sqrt(3.0)
        deepest = _layer_deepest(own, scene, segments, number)
        row.share, row.share_count, row.share_step = len(shares) * SHARES, SHARES, deepest / (SHARES - 1)
        shares.append(_shares(own, deepest, w.wave))
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
    arrays.shares = floats(np.concatenate(shares), wp.vec3)
    return PackedGlints(arrays, segments)
