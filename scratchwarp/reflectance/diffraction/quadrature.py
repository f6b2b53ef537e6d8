"""The reference of ``radiance``: quadrature over xi_1 and psi in NumPy, sharing no formula with the device functions.

Edges are cut by quadratic equations, what is inside is found by counting crossings in the polygon's own plane, the lobe
is integrated numerically and finite scratches by their defining integral. Relative error 1e-7 or better; slow.
"""

import numpy as np

from .light import DomeLight, Light, SphereLight
from .scratch import Scratch

_NODES, _WEIGHTS = np.polynomial.legendre.leggauss(16)
_HALF_PI = 0.5 * np.pi
_REACH = 7.0  # of the Gaussian over xi_1: e^{-49}
_WIDTHS = 6.0  # of the Gaussian over the plane, where the ends are integrated


def quadrature(
    light: Light, omega_o: np.ndarray, s: Scratch, waves: np.ndarray, dependent: bool, shape: tuple[int, ...]
) -> np.ndarray:
    """``radiance`` over arrays already checked, ``waves`` in micrometres."""
    wo = np.broadcast_to(omega_o, (*shape, 3)).reshape(-1, 3)
    wave = np.broadcast_to(waves, shape).reshape(-1)
    names = ("width", "depth", "azimuth", "offset", "coherence_radius", "depth_spread", "roughness")
    values = {name: np.broadcast_to(getattr(s, name), shape).reshape(-1) for name in names}
    ends = None if s.ends is None else np.broadcast_to(s.ends, (*shape, 2)).reshape(-1, 2)
    geometry: np.ndarray = np.zeros((len(wave), 0))
    if isinstance(light, SphereLight):
        radius = np.broadcast_to(light.radius, shape)[..., None]
        spheres = np.concatenate((np.broadcast_to(light.center, (*shape, 3)), radius), axis=-1)
        geometry = spheres.reshape(-1, 4)
    elif not isinstance(light, DomeLight):
        corners = light.vertices.shape[-2]
        geometry = np.broadcast_to(light.vertices, (*shape, corners, 3)).reshape(-1, corners, 3)
    out = np.zeros(len(wave))
    for i in range(len(wave)):
        one = {name: float(value[i]) for name, value in values.items()}
        c, d = np.cos(one["azimuth"]), np.sin(one["azimuth"])
        turn = np.array([[c, d, 0.0], [-d, c, 0.0], [0.0, 0.0, 1.0]])
        if wo[i, 2] <= 0.0:
            continue
        lobe = _Lobe(one, s.facets, turn @ wo[i], wave[i], dependent, None if ends is None else ends[i])
        if isinstance(light, DomeLight):
            out[i] = lobe.under_dome(light.values, turn)
            continue
        region = _Cap(turn @ geometry[i, :3], geometry[i, 3]) if geometry.ndim == 2 else _Outline(geometry[i] @ turn.T)
        out[i] = lobe.under(region)
    return out.reshape(shape)


def _composite(edges: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Nodes and weights of 16 each between the last axis' edges."""
    half = 0.5 * np.diff(edges, axis=-1)[..., None]
    middle = 0.5 * (edges[..., 1:] + edges[..., :-1])[..., None]
    flat = (*edges.shape[:-1], -1)
    return (middle + half * _NODES).reshape(flat), (half * _WEIGHTS).reshape(flat)


class _Cap:
    """Directions within asin(radius / distance) of a centre."""

    def __init__(self, center: np.ndarray, radius: float) -> None:
        distance = float(np.linalg.norm(center))
        self.full = radius >= distance and radius > 0.0
        self.axis = center / distance if distance > 0.0 else np.array([0.0, 0.0, 1.0])
        self.angle = np.pi if self.full else float(np.arcsin(radius / distance)) if distance > 0.0 else 0.0

    def corners(self) -> np.ndarray:
        """Where the region changes its course in u."""
        if self.full:
            return np.array([-1.0, 1.0])
        from_u = np.arccos(np.clip(self.axis[0], -1.0, 1.0))
        found = [np.cos(from_u - self.angle), np.cos(from_u + self.angle)]
        found += [1.0] if from_u < self.angle else []
        found += [-1.0] if from_u + self.angle > np.pi else []
        # its rim on the horizon: foot + t tangent, |.| = 1
        flat = self.axis[:2]
        length2 = flat @ flat
        if length2 > np.cos(self.angle) ** 2:
            foot = np.cos(self.angle) * flat / length2
            rest = np.sqrt((1.0 - foot @ foot) / length2)
            found += [foot[0] - rest * flat[1], foot[0] + rest * flat[1]]
        return np.array(found)

    def intervals(self, u: np.ndarray) -> np.ndarray:
        """psi from and to, ``[n, 3, 2]``, NaN where there is none."""
        out = np.full((len(u), 3, 2), np.nan)
        if self.full:
            out[:, 0] = -_HALF_PI, _HALF_PI
            return out
        s = np.sqrt(np.maximum(1.0 - u * u, 0.0))
        across = s * np.hypot(self.axis[1], self.axis[2])
        level = np.cos(self.angle) - u * self.axis[0]
        with np.errstate(invalid="ignore", divide="ignore"):
            half = np.where(level <= -across, np.pi, np.arccos(level / across))
        middle = np.arctan2(self.axis[1], self.axis[2])
        for turn in range(3):
            lo = np.maximum(middle - half + (turn - 1) * 2.0 * np.pi, -_HALF_PI)
            hi = np.minimum(middle + half + (turn - 1) * 2.0 * np.pi, _HALF_PI)
            out[:, turn] = np.where((lo < hi)[:, None], np.stack((lo, hi), axis=1), np.nan)
        return out


class _Outline:
    """Directions that pass through a polygon, which is cut off below the horizon first."""

    def __init__(self, points: np.ndarray) -> None:
        after = np.roll(points, -1, axis=0)
        kept = []
        for a, b in zip(points, after, strict=True):
            if a[2] > 0.0:
                kept.append(a)
            if (a[2] > 0.0) != (b[2] > 0.0):
                crossing = a + (b - a) * a[2] / (a[2] - b[2])
                kept.append(np.array([crossing[0], crossing[1], 0.0]))
        self.a = np.array(kept).reshape(-1, 3)
        self.d = np.roll(self.a, -1, axis=0) - self.a
        self.normal = np.cross(points - points[0], after - points[0]).sum(axis=0)
        size = np.abs(points - points[0]).max(initial=0.0)
        length = np.linalg.norm(self.normal)
        self.height = float(self.normal @ points[0])
        self.nothing = (
            len(kept) < 3
            or length <= 1e-13 * size * size
            or abs(self.height) <= 1e-13 * length * np.abs(points).max(initial=0.0)
        )

    def corners(self) -> np.ndarray:
        """Where the region changes its course in u: corners, and points of edges where u turns."""
        if self.nothing:
            return np.zeros(0)
        a, d = self.a, self.d
        aa, ad, dd = (np.einsum("ij,ij->i", x, y) for x, y in ((a, a), (a, d), (d, d)))
        with np.errstate(invalid="ignore", divide="ignore"):
            t = (a[:, 0] * ad - d[:, 0] * aa) / (d[:, 0] * ad - a[:, 0] * dd)
        between = (t > 0.0) & (t < 1.0)
        turning = a[between] + t[between, None] * d[between]
        points = np.concatenate((a, turning))
        return points[:, 0] / np.linalg.norm(points, axis=1)

    def intervals(self, u: np.ndarray) -> np.ndarray:
        """psi from and to, ``[n, m, 2]``, NaN where there is none."""
        a, d = self.a, self.d
        aa, ad, dd = (np.einsum("ij,ij->i", x, y) for x, y in ((a, a), (a, d), (d, d)))
        w = (u * u)[:, None]
        qa, qb, qc = d[:, 0] ** 2 - w * dd, a[:, 0] * d[:, 0] - w * ad, a[:, 0] ** 2 - w * aa
        with np.errstate(invalid="ignore", divide="ignore"):
            root = np.sqrt(qb * qb - qa * qc)
            q = -(qb + np.copysign(root, qb))
            t = np.stack((q / qa, qc / q), axis=-1)
            points = a[None, :, None] + t[..., None] * d[None, :, None]
            good = (t >= 0.0) & (t <= 1.0) & (points[..., 0] * u[:, None, None] >= 0.0)
            psi = np.where(good, np.arctan2(points[..., 1], points[..., 2]), np.nan).reshape(len(u), -1)
        ends = np.full((len(u), 1), _HALF_PI)
        psi = np.sort(np.concatenate((-ends, np.clip(psi, -_HALF_PI, _HALF_PI), ends), axis=1), axis=1)
        spans = np.stack((psi[:, :-1], psi[:, 1:]), axis=-1)
        middle = spans.mean(axis=-1)
        s = np.sqrt(np.maximum(1.0 - u * u, 0.0))[:, None]
        w3 = np.stack((np.broadcast_to(u[:, None], middle.shape), s * np.sin(middle), s * np.cos(middle)), axis=-1)
        return np.where(self._inside(w3)[..., None], spans, np.nan)

    def _inside(self, w: np.ndarray) -> np.ndarray:
        """Whether directions pass through: crossings counted in the plane of the two coordinates that suit it best."""
        with np.errstate(invalid="ignore", divide="ignore"):
            reach = self.height / (w @ self.normal)
        hit = w * reach[..., None]
        drop = int(np.argmax(np.abs(self.normal)))
        x, y = [i for i in range(3) if i != drop]
        inside = np.zeros(w.shape[:-1], bool)
        for a, d in zip(self.a, self.d, strict=True):
            over = (a[y] > hit[..., y]) != (a[y] + d[y] > hit[..., y])
            with np.errstate(invalid="ignore", divide="ignore"):
                at = a[x] + d[x] * (hit[..., y] - a[y]) / d[y]
            inside ^= over & (hit[..., x] < at)
        return inside & (reach > 0.0)


class _Lobe:
    """|S|^2 / (A_C lambda^2) of one scratch at one wavelength [um], in its own frame."""

    def __init__(
        self,
        one: dict[str, float],
        facets: np.ndarray,
        omega_o: np.ndarray,
        wave: float,
        dependent: bool,
        ends: np.ndarray | None,
    ) -> None:
        self.one, self.facets, self.omega_o, self.k, self.dependent = one, facets, omega_o, 2 * np.pi / wave, dependent
        self.wave, self.sigma = wave, one["coherence_radius"]
        self.ends = None
        if ends is not None:
            self.ends = np.clip(ends, -_WIDTHS * self.sigma, _WIDTHS * self.sigma)

    def along(self, xi1: np.ndarray) -> np.ndarray:
        """|eta|^2 / (2 A_C) at s_b = 0."""
        if self.ends is None:
            return np.exp(-((self.sigma * self.k * xi1) ** 2))
        length = self.ends[1] - self.ends[0]
        if length <= 0.0:
            return np.zeros_like(xi1)
        fringes = length * np.abs(xi1).max() / self.wave
        panels = int(np.ceil(length / self.sigma + fringes / 1.5)) + 1
        x, weight = _composite(np.linspace(self.ends[0], self.ends[1], panels + 1))
        weight = weight * np.exp(-0.5 * (x / self.sigma) ** 2)
        field = np.concatenate([np.exp(-1j * self.k * part[:, None] * x) @ weight for part in _chunks(xi1, len(x))])
        return np.abs(field) ** 2 / (2.0 * np.pi * self.sigma**2)

    def across(self, xi2: np.ndarray, height: np.ndarray) -> np.ndarray:
        """|W D|^2 / lambda^2."""
        one, k = self.one, self.k
        g = self.omega_o[2] + height if self.dependent else np.full_like(xi2, 2.0)
        if len(self.facets) == 0:
            rough = np.exp(-((k * g * one["roughness"]) ** 2))
            blur = np.sqrt(rough) * np.exp(-0.5 * (k * g * one["depth_spread"]) ** 2)
            wide = one["width"] / self.wave * np.sinc(one["width"] * xi2 / self.wave)
            return wide**2 * (1.0 + rough - 2.0 * blur * np.cos(k * g * one["depth"]))
        total = np.zeros(xi2.shape, complex)
        for v, h, d, r in self.facets * [one["width"], one["depth"], one["width"], one["depth"]]:
            bounced = np.exp(-1j * k * g * h) * np.sinc((xi2 * d + g * r) / self.wave)
            total += d * np.exp(-1j * k * xi2 * v) * (np.sinc(xi2 * d / self.wave) - bounced)
        return np.abs(total) ** 2 / self.wave**2

    def under(self, region: _Cap | _Outline) -> float:
        """Integral over the region."""
        corners = region.corners()
        if len(corners) == 0:
            return 0.0
        lo, hi = corners.min(), corners.max()
        if isinstance(region, _Cap) and region.angle == 0.0:
            return 0.0
        if self.ends is None:
            reach = _REACH / (self.sigma * self.k)
            lo, hi = max(lo, -self.omega_o[0] - reach), min(hi, -self.omega_o[0] + reach)
        if not lo < hi:
            return 0.0
        edges = np.unique(np.concatenate(([lo, hi], corners[(corners > lo) & (corners < hi)])))
        total = 0.0
        for left, right in zip(edges[:-1], edges[1:], strict=True):
            width = right - left
            if self.ends is None:
                pieces = 2 + int(np.ceil(width * self.sigma * self.k / 2.0))
            else:
                pieces = 4 + int(np.ceil(width * (self.ends[1] - self.ends[0] + self.sigma) / self.wave))
            # u = middle - half cos tau takes the square roots out of both ends
            tau, weight = _composite(np.linspace(0.0, np.pi, pieces + 1))
            u = 0.5 * (left + right) - 0.5 * width * np.cos(tau)
            weight = weight * 0.5 * width * np.sin(tau)
            total += float(weight @ (self.along(u + self.omega_o[0]) * self._slices(region, u)))
        return 2.0 * np.exp(-((self.one["offset"] / self.sigma) ** 2)) * total

    def under_dome(self, values: np.ndarray, turn: np.ndarray) -> float:
        """Integral over the half sphere times ``values``; cells by midpoints of psi, 1e-4 of them."""
        reach = min(_REACH / (self.sigma * self.k), 1.0) if self.ends is None else 1.0
        x, weight = _composite(np.linspace(-reach, reach, 3 if self.ends is None else 200))
        x = np.where(np.abs(x - self.omega_o[0]) < 1.0, x, np.nan)
        psi = np.pi * ((np.arange(20000) + 0.5) / 20000 - 0.5)
        along, total = self.along(np.nan_to_num(x)), 0.0
        for xi1, part in zip(x, weight * along, strict=True):
            if np.isnan(xi1) or part == 0.0:
                continue
            u = xi1 - self.omega_o[0]
            s = np.sqrt(1.0 - u * u)
            height = s * np.cos(psi)
            w = np.stack((np.full_like(psi, u), s * np.sin(psi), height), axis=-1) @ turn
            rows = np.minimum((np.arccos(w[:, 2]) / np.pi * values.shape[0]).astype(int), values.shape[0] - 1)
            turns = np.arctan2(w[:, 1], w[:, 0]) / (2.0 * np.pi) % 1.0
            columns = np.minimum((turns * values.shape[1]).astype(int), values.shape[1] - 1)
            seen = values[rows, columns] * height * self.across(self.omega_o[1] + s * np.sin(psi), height)
            total += float(part * seen.sum() * np.pi / 20000)
        return 2.0 * np.exp(-((self.one["offset"] / self.sigma) ** 2)) * total

    def _slices(self, region: _Cap | _Outline, u: np.ndarray) -> np.ndarray:
        """Integral over xi_2 at each u."""
        spans = region.intervals(u)
        row, column = np.nonzero(~np.isnan(spans[..., 0]))
        lo, hi = spans[row, column].T
        s = np.sqrt(np.maximum(1.0 - u[row] ** 2, 0.0))
        if len(row) == 0:
            return np.zeros(len(u))
        cycles = (self.one["width"] + self.one["depth"]) / self.wave * np.max(s * (hi - lo), initial=0.0)
        panels = int(np.ceil(cycles / 2.0)) + 1
        out = np.zeros(len(u))
        for part in _chunks(np.arange(len(row)), panels * 16):
            share = np.linspace(0.0, 1.0, panels + 1)
            psi, weight = _composite(lo[part, None] + (hi - lo)[part, None] * share)
            height = s[part, None] * np.cos(psi)
            value = self.across(self.omega_o[1] + s[part, None] * np.sin(psi), height)
            np.add.at(out, row[part], (weight * height * value).sum(axis=1))
        return out


def _chunks(values: np.ndarray, columns: int) -> list[np.ndarray]:
    """``values`` in parts whose tables of so many columns hold at most a million numbers."""
    return np.array_split(values, max(1, int(np.ceil(len(values) * columns / 1e6))))
