"""Layers that are laid out groove by groove -> device arrays: one pattern and grid for each material and surface."""

from dataclasses import dataclass, field, replace
from typing import Any

import numpy as np
import warp as wp

from ..plan import EffectPlan
from ..plan.grooves import FAR, NEAR, GrooveLayerPlan, GroovePlan
from ..plan.knobs import value
from ..plan.layers import conductor_index
from ..reflectance.base_device import CONDUCTOR, DIELECTRIC, SCHLICK, Base
from ..reflectance.grooves import Pattern
from ..reflectance.grooves.solid_device import GroovePath, Taper
from ..scene import Curves, Scene
from ..scratches.grid import StripGrid
from ..scratches.paths import Path, lay_out, repeated
from ..scratches.project import all_in_uv
from .geometry import PackedGeometry
from .groove_arrays_device import GrooveArrays, GrooveRecord
from .key import KernelKey

MOST_PATHS = 400_000
HELD = 16.0  # pieces under the widest footprint that is looked at at once
_INHERITS = -1.0  # roughness of facets that are as rough as the surface

Array = np.ndarray[Any, Any]


@dataclass(frozen=True, eq=False)
class PackedGrooves:
    """Device arrays; ``numbers``: what of them there is and what it takes, for ``Film.stats``: pieces and paths of
    grooves (a set that repeats is one), cells of grids, bytes of paths, of cross-sections, of grids, and of all."""

    arrays: GrooveArrays
    numbers: dict[str, int] = field(default_factory=dict)


def _base(own: Any) -> Base:
    """What facets are made of, from a ``ScratchSurface`` or "mirror"."""
    b: Any = Base()
    b.alpha_x = b.alpha_y = _INHERITS
    b.clearcoat_alpha, b.ior, b.specular = 1.0, 1.5, 1.0
    b.f90 = wp.vec3(1.0, 1.0, 1.0)
    if own == "mirror":
        b.fresnel, b.f0 = int(SCHLICK), wp.vec3(1.0, 1.0, 1.0)
    elif own.base == "conductor":
        eta, k = conductor_index(own)
        b.fresnel, b.eta, b.k = int(CONDUCTOR), wp.vec3(*eta), wp.vec3(*k)
    elif own.base == "dielectric":
        b.fresnel, b.ior, b.diffuse = int(DIELECTRIC), own.ior, wp.vec3(*own.color)
    else:
        b.specular, b.diffuse = 0.0, wp.vec3(*own.color)
    return b


def _section(plan: GrooveLayerPlan, path: Path) -> Array:
    """The cross-section of a path [um], its middle at x = 0."""
    layer = plan.layer
    deep = path.depth / layer.depth * layer.width if layer.depth > 0.0 else path.width
    return (plan.section_at(path.part) - (0.5, 0.0)) * (path.width, deep)


class _Joined:
    """Arrays of several patterns, one after the other."""

    def __init__(self) -> None:
        self.paths: list[Array] = []
        self.points: list[Array] = []
        self.vertices: list[Array] = []
        self.starts: list[Array] = []
        self.items: list[Array] = []
        self.own: list[Array] = []
        self.tapers: list[Array] = []
        self.records: list[Any] = []
        self.steps: list[list[float]] = []
        self.count = self.cells = self.grid = self.laid = 0

    def add(self, pattern: Pattern, grid: StripGrid, own: Array, scale: Array, width: float, plan: GroovePlan) -> int:
        """Number of a pattern; ``own``: the material of each of its paths."""
        paths, given = pattern.stored.copy(), pattern.grooves
        r: Any = GrooveRecord()
        r.scale, r.width = wp.vec2d(*scale), wp.float64(width)
        for name in ("bottom", "top", "skin", "mixed", "wide", "path_count", "sets"):
            setattr(r, name, getattr(given, name))
        for name in ("origin", "cell", "columns", "rows", "halved"):
            setattr(r, name, getattr(grid.data, name))
        r.first_path, r.first_step, r.first = _total(self.paths), len(self.steps), _total(self.starts)
        r.handover = int(plan.handover) + int(plan.waved)
        r.smooth, r.most = plan.smooth, wp.float64(pattern.widest(HELD))
        paths["number"] += self.laid
        paths["taper"] += np.where(paths["taper"] >= 0, _total(self.tapers), 0)
        paths["section"] += _total(self.vertices)
        paths["point"] += _total(self.points)
        self.steps += pattern.repeats.tolist()
        # entries are counted in halves of an item where they are short
        self.starts.append(grid.data.starts.numpy() + _total(self.items) * (2 if grid.data.halved else 1))
        self.items.append(grid.data.items.numpy())
        self.paths.append(paths)
        self.points.append(given.points.numpy().reshape(-1, 2))
        self.vertices.append(given.vertices.numpy().reshape(-1, 2))
        self.tapers.append(given.tapers.numpy())
        self.own.append(own.astype(np.int32))
        self.records.append(r)
        self.count += len(pattern.table) + len(pattern.sets)
        self.cells += grid.shape[0] * grid.shape[1]
        self.grid += grid.memory
        self.laid += pattern.count
        return len(self.records) - 1

    def pack(self, arrays: Any, device: str) -> dict[str, int]:
        """Write everything to the device; what it takes."""
        paths, points, vertices = (np.concatenate(x) for x in (self.paths, self.points, self.vertices))
        starts, items = np.concatenate(self.starts).astype(np.int32), np.concatenate(self.items).astype(np.int32)
        own, tapers = np.concatenate(self.own), np.concatenate(self.tapers)
        steps = np.array(self.steps).reshape(-1, 3)
        arrays.paths = wp.array(paths, dtype=GroovePath, device=device)
        arrays.points = wp.array(points, dtype=wp.vec2d, device=device)
        arrays.vertices = wp.array(vertices, dtype=wp.vec2d, device=device)
        arrays.tapers = wp.array(tapers, dtype=Taper, device=device)
        arrays.steps = wp.array(steps, dtype=wp.vec3d, device=device)
        arrays.starts = wp.array(starts, dtype=int, device=device)
        arrays.items = wp.array(items, dtype=int, device=device)
        arrays.own = wp.array(own, dtype=int, device=device)
        arrays.records = wp.array(self.records, dtype=GrooveRecord, device=device)
        described: Any = GrooveRecord
        records = np.dtype(described.numpy_dtype()).itemsize * len(self.records)
        laid = (paths, points, tapers, steps, own)
        parts = {
            "groove_pieces": self.count,
            "groove_paths": len(paths),
            "groove_cells": self.cells,
            "groove_path_bytes": sum(x.nbytes for x in laid) + records,
            "groove_section_bytes": vertices.nbytes,
            "groove_grid_bytes": starts.nbytes + items.nbytes,
        }
        return {**parts, "groove_bytes": sum(n for name, n in parts.items() if name.endswith("bytes"))}


def _total(arrays: list[Array]) -> int:
    return sum(len(x) for x in arrays)


def _handed(shape: PackedGeometry) -> Array:
    """-1 for triangles whose mapping is mirrored."""
    g = shape.arrays
    p = g.points.numpy().reshape(-1, 3, 3).astype(float)
    normal = np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0])
    turned = np.cross(g.dpdu.numpy().astype(float), g.dpdv.numpy().astype(float))
    return np.where((normal * turned).sum(1) < 0.0, -1.0, 1.0)


def pack(scene: Scene, plan: EffectPlan, key: KernelKey, shape: PackedGeometry, device: str = "cpu") -> PackedGrooves:
    """What the plan's grooves need; empty arrays where nothing is laid out. Raises ValueError where that would be more
    than ``MOST_PATHS`` paths."""
    arrays: Any = GrooveArrays()
    if not key.grooves or shape.mesh is None:
        return PackedGrooves(arrays)
    g = shape.arrays
    material, instance = g.material.numpy(), g.instance.numpy()
    uv = g.uvs.numpy().reshape(-1, 3, 2).astype(float)
    scales, handed = g.pattern_scale.numpy(), _handed(shape)
    of_face = np.full(len(material), -1, np.int32)
    joined = _Joined()
    knobs = plan.settings.knobs
    rule = str(value(knobs, "grooves.cells"))
    known: dict[tuple[float, ...], int] = {}
    bases: list[Any] = []
    for m, groove in enumerate(plan.grooves):
        if groove is None:
            continue
        if groove.tapers and not key.groove_tapers:
            groove = _even(groove)
        numbers = []
        for own in groove.layers:
            numbers.append(len(bases) if own.own is not None else -1)
            bases += [_base(own.own)] if own.own is not None else []
        for i in np.unique(instance[material == m]):
            for hand in (1.0, -1.0):
                faces = (material == m) & (instance == i) & (handed == hand)
                if not faces.any():
                    continue
                low, high = uv[faces].min((0, 1)), uv[faces].max((0, 1))
                asked = (m, hand, *np.round(np.concatenate([scales[i], low, high]), 9).tolist())
                sets = [[scene.curves[c] for c in own.layer.curves] for own in groove.layers]
                if any(c.space == "object" for own in sets for c in own):
                    asked = (*asked, float(i))  # they lie where this surface is
                if asked not in known:
                    sets = [all_in_uv(own, shape.mesh, uv, faces, scales[i]) for own in sets]
                    box = low, high, scales[i], hand
                    known[asked] = _pattern(groove, numbers, box, sets, rule, joined, key.groove_tapers)
                of_face[faces] = known[asked]
    arrays.of_face = wp.array(of_face, dtype=int, device=device)
    taken = joined.pack(arrays, device) if joined.records else {}
    arrays.bases = wp.array(bases or [Base()], dtype=Base, device=device)
    lines = int(value(knobs, "grooves.lines"))
    arrays.slices = max(min(4, lines), -(-lines // (plan.settings.spp or 1)))
    arrays.bounces, arrays.near, arrays.far = int(value(knobs, "grooves.bounces")), NEAR, FAR
    return PackedGrooves(arrays, taken)


def _even(groove: GroovePlan) -> GroovePlan:
    """The same with sizes that differ from groove to groove alone."""
    layers = tuple(replace(own, layer=replace(own.layer, variation_length=0.0)) for own in groove.layers)
    return replace(groove, layers=layers)


def _pattern(
    groove: GroovePlan, numbers: list[int], box: tuple[Array, Array, Array, float], curves: list[list[Curves]],
    rule: str, joined: _Joined, tapers: bool,
) -> int:  # fmt: skip
    """Number of the pattern of a material over a part of a surface, -1 where it has no groove.

    ``box``: uv from and to, micrometres a unit of u and of v, -1 for a mirrored mapping; ``rule``: for cells;
    ``tapers``: sizes along a path count.
    """
    low, high, scale, hand = box
    paths: list[Path] = []
    sections: list[Array] = []
    own: list[int] = []
    steps: list[tuple[float, ...]] = []
    rings: list[tuple[float, int] | None] = []
    for plan, number, own_curves in zip(groove.layers, numbers, curves, strict=True):
        regular = repeated(plan.layer, low, high, scale, hand)
        if regular is not None:
            laid = [path for path, _, _ in regular]
            steps += [(*step, count) for _, step, count in regular if len(step) == 2]
            steps += [(0.0, 0.0, 1.0) for _, step, _ in regular if len(step) == 1]
            rings += [(float(step[0]), count) if len(step) == 1 else None for _, step, count in regular]
        else:
            laid = lay_out(plan.layer, low, high, scale, hand, own_curves, MOST_PATHS - joined.laid - len(paths))
            steps += [(0.0, 0.0, 1.0)] * len(laid)
            rings += [None] * len(laid)
        paths += laid
        drawn: dict[tuple[float, float, float], Array] = {}  # grooves of one size and shape share a section
        for path in laid:
            size = path.width, path.depth, path.part
            if size not in drawn:
                drawn[size] = _section(plan, path)
            sections.append(drawn[size])
        own += [number] * len(laid)
        if joined.laid + len(paths) > MOST_PATHS:
            raise ValueError(
                f"{plan.layer.label}: with it {joined.laid + len(paths)} grooves are laid out, more than {MOST_PATHS}; "
                "set its model to table, or make them longer or wider"
            )
    ends = [dict(plan.layer.extra).get("ends", "cap") for plan in groove.layers]
    scales = [path.scales if tapers else None for path in paths]
    shape = "mitre" if "mitre" in ends else "cap"
    pattern = Pattern([path.points for path in paths], sections, shape, scales, steps, rings)
    if not pattern.size:
        return -1
    width = float(np.mean([path.width for path in paths]))
    grid = pattern.grid_by(rule)
    return joined.add(pattern, grid, np.array(own), scale * np.array([1.0, hand]), width, groove)
