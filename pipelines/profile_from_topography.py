"""Take a cross-section out of a measured height map of a scratched or ground surface.

The map is levelled (its best plane or paraboloid removed), its waviness filtered out, the direction of its grooves
found (that of the straight line along which the mean height stands out most), averaged along it, and the groove that
stands out most cut out between its shoulders; or the whole mean profile is kept as one period.
"""

import zipfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from scratchwarp.scene import check_archive

_COARSE = np.radians(np.arange(0.0, 180.0, 1.5))
IMAGES = (".png", ".tif", ".tiff", ".exr", ".jpg", ".jpeg", ".hdr")
# A groove reaches out to where this share of its depth is regained, and its rims this share of that distance further.
_REGAINED = 0.7
_RIM = 0.75


@dataclass(frozen=True)
class Topography:
    """Heights ``[rows, columns]`` and the distance of neighbouring columns (x) and rows (y); all in micrometres."""

    height: np.ndarray
    dx: float
    dy: float


@dataclass(frozen=True)
class Section:
    """A cross-section in micrometres: ``x`` ascending, ``z`` with 0 on the line through its two ends; ``direction``
    of the grooves [rad] from the map's x axis; ``periodic``: one period of a repeating surface."""

    x: np.ndarray
    z: np.ndarray
    direction: float
    periodic: bool

    @property
    def width(self) -> float:
        """Distance between the ends [um]."""
        return float(self.x[-1] - self.x[0])

    @property
    def depth(self) -> float:
        """Depth of the lowest point below the line through the ends [um]."""
        return float(-self.z.min())

    @property
    def points(self) -> np.ndarray:
        """Normalised as a ScratchProfile wants them, ``[n, 2]``: x in widths over [0, 1], z in depths."""
        return np.stack(((self.x - self.x[0]) / self.width, self.z / self.depth), axis=1)


def load(path: Path | str, pitch: float | None = None, height: float | None = None) -> Topography:
    """A height map from NPZ (arrays height_m, dx_m, dy_m, in metres), NPY or delimited text (micrometres; ``pitch``
    [um] between samples is then needed), or an image (its red channel, ``height`` [um] from black to white). Raises
    ValueError on anything else, OSError where the file cannot be read."""
    path = Path(path)
    if not path.is_file():
        raise FileNotFoundError(f"{path}: no such file")
    try:
        return _load(path, pitch, height)
    except (ValueError, EOFError, zipfile.BadZipFile) as error:
        if str(path) in str(error):
            raise
        raise ValueError(f"{path}: holds no height map that can be read ({error})") from None


def _load(path: Path, pitch: float | None, height: float | None) -> Topography:
    if path.suffix.lower() in IMAGES:
        from scratchwarp.image import read_texture

        if pitch is None or height is None:
            needed = "pitch (micrometres between pixels)" if pitch is None else "height (micrometres to white)"
            raise ValueError(f"{path}: {needed} is needed for an image; pass --{needed.split()[0]}")
        return _checked(path, height * read_texture(str(path), "raw")[..., 0].astype(float), pitch, pitch)
    if path.suffix in (".npz", ".npy"):
        check_archive(path)
    if path.suffix == ".npz":
        with np.load(path, allow_pickle=False) as held:
            missing = {"height_m", "dx_m", "dy_m"} - set(held.files)
            if missing:
                raise ValueError(f"{path}: lacks {sorted(missing)[0]}; it must hold height_m, dx_m and dy_m")
            return _checked(
                path, 1e6 * held["height_m"].astype(float), 1e6 * float(held["dx_m"]), 1e6 * float(held["dy_m"])
            )
    heights = (
        np.load(path, allow_pickle=False) if path.suffix == ".npy" else np.loadtxt(path, delimiter=_delimiter(path))
    )
    if pitch is None:
        raise ValueError(f"{path}: pitch (micrometres between samples) is needed for this format; pass --pitch")
    return _checked(path, np.asarray(heights, float), pitch, pitch)


def _delimiter(path: Path) -> str | None:
    return "," if path.suffix == ".csv" else None


def _checked(path: Path, heights: np.ndarray, dx: float, dy: float) -> Topography:
    if heights.ndim != 2 or min(heights.shape) < 16:
        raise ValueError(f"{path}: a height map needs at least 16 x 16 samples, got shape {heights.shape}")
    if not (dx > 0.0 and dy > 0.0):
        raise ValueError(f"{path}: the pitch must be above 0 um, got {dx}, {dy}")
    bad = ~np.isfinite(heights)
    if bad.mean() > 0.5:
        raise ValueError(f"{path}: more than half of the heights are not finite")
    return Topography(np.where(bad, np.nan, heights), dx, dy)


def levelled(topography: Topography, degree: int = 2) -> Topography:
    """The map less its best polynomial of the given degree in x and y (1 a plane, 2 a paraboloid), by least squares
    over finite heights, twice: the second time without what lies more than 3 standard deviations off. Missing heights
    become 0."""
    rows, columns = topography.height.shape
    y, x = np.meshgrid(np.linspace(-1, 1, rows), np.linspace(-1, 1, columns), indexing="ij")
    terms = np.stack([x**i * y**j for i in range(degree + 1) for j in range(degree + 1 - i)], axis=-1)
    keep = np.isfinite(topography.height)
    rest = np.zeros_like(topography.height)
    for _ in range(2):
        fit, *_ = np.linalg.lstsq(terms[keep], topography.height[keep], rcond=None)
        rest = topography.height - terms @ fit
        keep = np.isfinite(rest) & (np.abs(rest) < 3.0 * np.nanstd(rest))
    return Topography(np.nan_to_num(rest), topography.dx, topography.dy)


def mean_profile(topography: Topography, direction: float) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """``(x, z, count)``: heights averaged along lines at ``direction`` [rad from the map's x axis], over steps of the
    finer pitch across them; ``count`` samples went into each. x runs to the left of the direction [um]."""
    rows, columns = topography.height.shape
    y, x = np.meshgrid(
        (np.arange(rows) - 0.5 * (rows - 1)) * topography.dy,
        (np.arange(columns) - 0.5 * (columns - 1)) * topography.dx,
        indexing="ij",
    )
    across = (-np.sin(direction) * x + np.cos(direction) * y).ravel()
    step = min(topography.dx, topography.dy)
    place = across / step
    place = place - place.min()
    low = place.astype(int)
    share = place - low
    bins = int(low.max()) + 2
    count = np.bincount(low, 1.0 - share, bins) + np.bincount(low + 1, share, bins)
    heights = topography.height.ravel()
    total = np.bincount(low, (1.0 - share) * heights, bins) + np.bincount(low + 1, share * heights, bins)
    z = np.divide(total, count, out=np.zeros(bins), where=count > 0.0)
    return np.arange(bins) * step + float(across.min()), z, count


def without_waviness(topography: Topography, cutoff: float) -> Topography:
    """The map less its Gaussian mean of cutoff wavelength ``cutoff`` [um] (ISO 16610-61: half of a wave that long
    passes)."""
    rows, columns = topography.height.shape
    spread = cutoff * np.sqrt(np.log(2.0) / np.pi)
    reach = [int(np.ceil(3.0 * spread / step)) for step in (topography.dy, topography.dx)]
    padded = np.pad(
        topography.height, [(min(r, n - 1),) * 2 for r, n in zip(reach, (rows, columns), strict=True)], "reflect"
    )
    fy, fx = np.fft.fftfreq(padded.shape[0], topography.dy), np.fft.rfftfreq(padded.shape[1], topography.dx)
    passed = np.exp(-np.pi * spread**2 * (fy[:, None] ** 2 + fx[None, :] ** 2))
    mean = np.fft.irfft2(np.fft.rfft2(padded) * passed, padded.shape)
    top, left = ((full - own) // 2 for full, own in zip(padded.shape, (rows, columns), strict=True))
    return Topography(topography.height - mean[top : top + rows, left : left + columns], topography.dx, topography.dy)


def _clipped(topography: Topography, deviations: float) -> Topography:
    """Heights kept within so many robust standard deviations, so that a pit weighs no more than a line as long as it
    is wide."""
    height = topography.height
    limit = deviations * 1.4826 * float(np.median(np.abs(height - np.median(height))))
    kept = np.clip(height, -limit, limit) if limit > 0.0 else height
    return Topography(kept, topography.dx, topography.dy)


def groove_direction(topography: Topography) -> float:
    """Direction of the grooves [rad, in [0, pi)] from the map's x axis: that of the straight line along which the
    mean height stands out most (mean squared times samples). Heights beyond 4
    robust standard deviations are clipped, so that a pit is no line. A search by 1.5 degrees on a thinned map, then
    finer around the best few."""
    clipped = _clipped(topography, 4.0)
    height = clipped.height
    thin = max(1, min(height.shape) // 192)
    blocks = height[: height.shape[0] // thin * thin, : height.shape[1] // thin * thin]
    means = blocks.reshape(blocks.shape[0] // thin, thin, -1, thin).mean(axis=(1, 3))
    coarse = Topography(means, topography.dx * thin, topography.dy * thin)

    def outstanding(target: Topography, direction: float) -> tuple[float, float]:
        """How much the best line stands out, and all lines near it together: the second has the sharper maximum."""
        _, z, count = mean_profile(target, direction)
        score = np.where(count >= 0.25 * count.max(), count * z**2, 0.0)
        best = int(np.argmax(score))
        reach = len(score) // 20 + 1
        return float(score[best]), float((score[max(0, best - reach) : best + reach + 1] ** 2).sum())

    scores = np.array([outstanding(coarse, a)[0] for a in _COARSE])
    best = max(_COARSE[np.argsort(scores)[-4:]], key=lambda a: outstanding(clipped, a)[0])
    for step in np.radians((0.5, 0.15, 0.05)):
        best = max((best + k * step for k in range(-4, 5)), key=lambda a: outstanding(clipped, a)[1])
    return float(best % np.pi)


def section(
    topography: Topography, direction: float | None = None, whole: bool = False, smooth: float = 0.0
) -> Section:
    """The cross-section of a levelled map. ``whole``: all of the mean profile, as one period; else the groove
    that stands out most, between its shoulders. ``smooth``: standard
    deviation [um] of a Gaussian laid over the mean profile first. Raises ValueError where the map is flat."""
    angle = groove_direction(topography) if direction is None else direction
    x, z, count = mean_profile(topography, angle)
    well = np.flatnonzero(count >= 0.25 * count.max())
    x, z, count = (values[well[0] : well[-1] + 1] for values in (x, z, count))
    if smooth > 0.0:
        z = _smoothed(z, smooth / (x[1] - x[0]))
    if not np.ptp(z) > 0.0:
        raise ValueError("the mean profile is flat: there is no groove to cut out")
    if not whole:
        _, line, samples = mean_profile(_clipped(topography, 4.0), angle)
        standing_out = (np.minimum(line, 0.0) ** 2 * samples)[well[0] : well[-1] + 1]
        left, right = _shoulders(z, standing_out)
        x, z = x[left : right + 1], z[left : right + 1]
    z = z - np.interp(x, x[[0, -1]], z[[0, -1]])
    if not z.min() < 0.0:
        raise ValueError("nothing lies below the line through the ends of the section; choose another direction")
    return Section(x, z, angle, whole)


def _smoothed(z: np.ndarray, sigma: float) -> np.ndarray:
    reach = int(np.ceil(3.0 * sigma))
    kernel = np.exp(-0.5 * (np.arange(-reach, reach + 1) / sigma) ** 2)
    return np.convolve(np.pad(z, reach, mode="edge"), kernel / kernel.sum(), mode="valid")


def _shoulders(z: np.ndarray, standing_out: np.ndarray) -> tuple[int, int]:
    """Indices left and right of the groove that stands out most: from its bottom out to where most of the depth is
    regained, and on to the highest point within a share of that distance (the crest of its rim, where it has one)."""
    margin = len(z) // 20 + 1
    bottom = int(np.argmax(standing_out[margin:-margin])) + margin
    bottom += int(np.argmin(z[bottom - 1 : bottom + 2])) - 1
    ends = []
    for side in (z[bottom::-1], z[bottom:]):
        regained = np.flatnonzero(side > (1.0 - _REGAINED) * z[bottom])
        edge = int(regained[0]) if regained.size else len(side) - 1
        reach = edge + 1 + int(np.ceil(_RIM * edge))
        ends.append(edge + int(np.argmax(side[edge:reach])))
    return bottom - ends[0], bottom + ends[1]


def thinned(found: Section, tolerance: float) -> Section:
    """Fewer points, none further than ``tolerance`` [um] in height from the polyline kept (Douglas and Peucker
    1973)."""
    keep = np.zeros(len(found.x), bool)
    keep[[0, -1]] = True
    stack = [(0, len(found.x) - 1)]
    while stack:
        a, b = stack.pop()
        if b - a < 2:
            continue
        off = np.abs(found.z[a : b + 1] - np.interp(found.x[a : b + 1], found.x[[a, b]], found.z[[a, b]]))
        far = a + int(np.argmax(off))
        if off[far - a] > tolerance:
            keep[far] = True
            stack += [(a, far), (far, b)]
    return Section(found.x[keep], found.z[keep], found.direction, found.periodic)


def write_points(found: Section, path: Path | str) -> None:
    """The section as points (x, z) in micrometres, one a line with a comma between; OSError where it cannot be
    written."""
    from scratchwarp.whole import whole

    with whole(Path(path)) as draft:
        np.savetxt(draft, np.stack((found.x - found.x[0], found.z), axis=1), delimiter=",", fmt="%.6g")
