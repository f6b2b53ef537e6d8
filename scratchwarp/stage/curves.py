"""ScratchCurvesAPI on BasisCurves: explicit scratches."""

from collections.abc import Sequence

import numpy as np
from pxr import Sdf, Usd, UsdGeom

from scratchwarp.scene import Curves, StageError

from .curve_basis import CurveKind, polylines
from .reading import Reading

_MICROMETRES = 1e6  # in a metre


class CurveSets:
    """Sets of scratches read so far, each once; ``records`` become ``Scene.curves``."""

    def __init__(self, reading: Reading, origin: np.ndarray) -> None:
        self.records: list[Curves] = []
        self._reading, self._origin = reading, origin
        self._known: dict[tuple, int] = {}

    def indices(
        self, where: str, targets: Sequence[Sdf.Path], width: float, depth: float, space: str
    ) -> tuple[int, ...]:
        """Indices of the sets that a layer's relationship names; ``width`` and ``depth`` of the layer stand in for
        what the curves leave out."""
        found = []
        for target in targets:
            key = (target, width, depth, space)
            if key not in self._known:
                prim = self._reading.stage.GetPrimAtPath(target)
                record = self._read(where, target, prim, width, depth, space)
                if record is None:
                    continue
                self._known[key] = len(self.records)
                self.records.append(record)
            found.append(self._known[key])
        return tuple(found)

    def _read(
        self, where: str, target: Sdf.Path, prim: Usd.Prim, width: float, depth: float, space: str
    ) -> Curves | None:
        if not prim or not prim.IsA(UsdGeom.BasisCurves):
            self._reading.warn(where, f"its curves {target} are no BasisCurves; they are ignored")
            return None
        if "ScratchCurvesAPI" not in prim.GetAppliedSchemas():
            self._reading.warn(where, f"its curves {target} lack ScratchCurvesAPI; they are read as object space")
        return read_curves(self._reading, prim, self._origin, width, depth, space)


def read_curves(
    reading: Reading, prim: Usd.Prim, origin: np.ndarray, width: float, depth: float, space: str
) -> Curves | None:
    """Read all curves of one BasisCurves prim as polylines, in metres about ``origin`` or in uv.

    Widths: ``primvars:scratch:width`` [um], else ``widths`` (diameters in object space, which the prim's transform
    scales by the cube root of its determinant; uv fractions in space uv), else the layer's. Depths:
    ``primvars:scratch:depth`` [um], else the layer's. ``width``, ``depth`` and ``space`` are the layer's.

    None, with a warning, without curves; StageError on points that are not finite.
    """
    path = str(prim.GetPath())
    points = reading.numbers(prim.GetAttribute("points"), 3)
    counts = reading.numbers(prim.GetAttribute("curveVertexCounts"), whole=True)
    if not len(points) or counts.sum() != len(points) or counts.min(initial=1) < 1:
        reading.warn(path, f"curveVertexCounts add up to {counts.sum()}, points has {len(points)}; it is left out")
        return None
    finite = np.isfinite(points).all(1)
    if not finite.all():
        first = int(np.argmin(finite))
        raise StageError(f"{path}: points[{first}] is {tuple(points[first].tolist())}; every coordinate must be finite")
    reading.budget.take(400.0 * len(points), f"{reading.path}: {path}", f"curves of {len(points)} points")
    in_uv = str(reading.value(prim, "scratch:curves:space", "object")) == "uv"
    matrix = reading.world(prim) * reading.metres
    matrix[:3, 3] -= origin
    kind = CurveKind(*(str(reading.value(prim, name)) for name in ("type", "basis", "wrap")))

    layer_unit = "uv" if space == "uv" else "um"
    width_unit = depth_unit = "um"
    widths = _scalar(reading, prim, "primvars:scratch:width", kind, counts)
    if widths is None:
        widths = _scalar(reading, prim, "widths", kind, counts)
        width_unit = "uv" if in_uv else "um"
        if widths is not None and not in_uv:
            widths = widths * float(np.cbrt(abs(np.linalg.det(matrix[:3, :3])))) * _MICROMETRES
    if widths is None:
        reading.warn(path, "has no widths; the layer's width is used")
        widths, width_unit = np.full(len(points), width), layer_unit
    depths = _scalar(reading, prim, "primvars:scratch:depth", kind, counts)
    if depths is None:
        depths, depth_unit = np.full(len(points), depth), layer_unit

    # Sizes given at the points follow the basis, those given at the ends of segments are blended linearly.
    sizes = {"widths": widths, "depths": depths}
    order = sorted(sizes, key=lambda name: len(sizes[name]) != len(points))
    at_points = [sizes[n][:, None] for n in order if len(sizes[n]) == len(points)]
    at_ends = [sizes[n][:, None] for n in order if len(sizes[n]) != len(points)]
    ends = np.concatenate([np.empty((int(kind.varying(counts).sum()), 0)), *at_ends], axis=1)
    lines, lengths = polylines(kind, counts, np.concatenate([points, *at_points], axis=1), ends)
    if not lengths.all():
        reading.warn(path, f"curves with too few points for their type ({kind.type} {kind.basis}) are left out")
    placed = lines[:, :3] if in_uv else lines[:, :3] @ matrix[:3, :3].T + matrix[:3, 3]
    return Curves(
        path=path,
        points=placed,
        counts=lengths[lengths > 0],
        **{name: np.maximum(lines[:, 3 + i], 0.0) for i, name in enumerate(order)},
        space="uv" if in_uv else "object",
        width_unit=width_unit,
        depth_unit=depth_unit,
    )


def _scalar(reading: Reading, prim: Usd.Prim, name: str, kind: CurveKind, counts: np.ndarray) -> np.ndarray | None:
    """A size at every point [n], or at every segment end where it is authored so; None where it has no usable value."""
    attribute = prim.GetAttribute(name)
    if not attribute or not attribute.HasValue():
        return None
    values = reading.numbers(attribute)
    if not len(values):
        return None
    if not np.isfinite(values).all():
        reading.warn(attribute.GetPath(), "holds values that are not finite; it is ignored")
        return None
    total = int(counts.sum())
    if len(values) == 1:
        return np.full(total, values[0])
    if len(values) == len(counts):
        return np.repeat(values, counts)
    if len(values) in (total, int(kind.varying(counts).sum())):
        return values
    reading.warn(attribute.GetPath(), f"has {len(values)} values, which fits neither curves nor points; it is ignored")
    return None
