"""Highlights in triangles, by Newton's method.

Over a triangle the half vector and the shading normal change smoothly. Where their slopes agree lies a highlight; how
the difference of slopes changes across the image tells its size, with the roughness of the surface and half the angle
of the light's radius. Where slopes hardly change in one direction, as along a rim, a highlight is a ridge that fades
over many triangles: in each of these the places on it count that are nearest its corners.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np

from .camera_device import CameraData

Array = np.ndarray[Any, Any]

LARGEST = 0.1
"""Highlights larger than so much of a pixel are met by samples as they come."""
WIDEST = 0.1
"""Lights of larger radii, over distances, are mirrored in highlights that samples meet as they come."""
_CHUNK = 1 << 17
_STEP = 1e-4
_STARTS = ((0.2, 0.2), (0.6, 0.2), (0.2, 0.6))


@dataclass(frozen=True, eq=False)
class Lamp:
    """A light as a sphere: center [m] and radius [m], or a direction and half the angle; ``power``: radiance, or
    irradiance at once (``point``), as a luminance."""

    center: Array
    radius: float
    distant: bool
    point: bool
    power: float

    def toward(self, p: Array) -> tuple[Array, Array]:
        """Unit directions from points [..., 3], and the sines of half the angles [...]."""
        if self.distant:
            sine = np.full(p.shape[:-1], np.sin(self.radius))
            return np.broadcast_to(self.center, p.shape), sine
        way = self.center - p
        far = np.maximum(np.linalg.norm(way, axis=-1), 1e-30)
        return way / far[..., None], np.minimum(self.radius / far, 1.0)


@dataclass(frozen=True, eq=False)
class Found:
    """Highlights: ``at`` [n, 2] in the image; ``a``, ``b`` [n, 2], see ``Highlight``; ``flux`` [n], to compare;
    ``reach`` [n]: how many times their size it is to where they are dim; ``span`` [n, 2]: the part of a ridge that is
    in the triangle, in units of b; points and the ends of their rays [n, 3]."""

    at: Array
    a: Array
    b: Array
    flux: Array
    reach: Array
    span: Array
    point: Array
    eye: Array
    lamp: Array

    def chosen(self, which: Array) -> "Found":
        """Those of a mask or of indices."""
        return Found(**{name: value[which] for name, value in vars(self).items()})


def joined(parts: list[Found]) -> Found:
    """All of them together."""
    return Found(**{name: np.concatenate([getattr(part, name) for part in parts]) for name in Found.__annotations__})


class View:
    """The camera as NumPy sees it."""

    def __init__(self, c: CameraData, orthographic: bool) -> None:
        for name in ("position", "right", "up", "back"):
            setattr(self, name, np.array(getattr(c, name), np.float64))
        self.c, self.orthographic = c, orthographic

    position: Array
    right: Array
    up: Array
    back: Array

    def toward(self, p: Array) -> Array:
        """Unit directions to the camera from points [..., 3]."""
        if self.orthographic:
            return np.broadcast_to(self.back, p.shape)
        way = self.position - p
        return way / np.maximum(np.linalg.norm(way, axis=-1, keepdims=True), 1e-30)

    def image(self, p: Array) -> Array:
        """Where points are in the image [pixels]; not a number behind the camera."""
        d = p - self.position
        deep = -d @ self.back
        scale = 1.0 if self.orthographic else 1.0 / np.where(deep > 0.0, deep, np.nan)
        x, y = d @ self.right * scale, d @ self.up * scale
        there = np.stack([(x - self.c.left) / self.c.pixel_x, (self.c.top - y) / self.c.pixel_y], axis=-1)
        return np.where((deep > self.c.near)[..., None], there, np.nan)


def _dot(a: Array, b: Array) -> Array:
    return (a * b).sum(axis=-1, keepdims=True)


def _unit(v: Array) -> Array:
    return v / np.maximum(np.linalg.norm(v, axis=-1, keepdims=True), 1e-30)


def _axes(n: Array) -> tuple[Array, Array]:
    """Two unit vectors [m, 3] across unit ones."""
    least = np.eye(3)[np.abs(n).argmin(axis=1)]
    x = _unit(np.cross(n, least))
    return x, np.cross(n, x)


def _mixed(values: Array, b: Array) -> Array:
    """Values [m, 3, k] at the corners, at barycentric coordinates [m, 2] of the second and third."""
    return values[:, 0] + b[:, :1] * (values[:, 1] - values[:, 0]) + b[:, 1:] * (values[:, 2] - values[:, 0])


def _off(p: Array, normal: Array, n: Array, x: Array, y: Array, lamp: Lamp, view: View) -> Array:
    """Slope of the half vector less that of the shading normal, in the frame (x, y, n), [m, 2]."""
    h = _unit(lamp.toward(p)[0] + view.toward(p))
    up, across = _dot(normal, n), _dot(h, n)
    up, across = (np.where(v > 0.05, v, np.nan) for v in (up, across))
    return np.concatenate([_dot(h, x) / across - _dot(normal, x) / up, _dot(h, y) / across - _dot(normal, y) / up], 1)


def _inverse(m: Array) -> tuple[Array, Array]:
    """Inverses of matrices [m, 2, 2] and their determinants [m]."""
    det = m[:, 0, 0] * m[:, 1, 1] - m[:, 0, 1] * m[:, 1, 0]
    flipped = np.stack([m[:, 1, 1], -m[:, 0, 1], -m[:, 1, 0], m[:, 0, 0]], axis=1).reshape(-1, 2, 2)
    return flipped / np.where(det != 0.0, det, np.nan)[:, None, None], det


def find(corners: Array, normals: Array, alpha: Array, lamp: Lamp, view: View) -> Found:
    """Highlights of one light in triangles [m, 3, 3] with shading normals [m, 3, 3] and GGX alpha [m]."""
    parts = [
        _found(corners[i : i + _CHUNK], normals[i : i + _CHUNK], alpha[i : i + _CHUNK], lamp, view)
        for i in range(0, len(corners), _CHUNK)
    ]
    return joined(parts)


def _found(corners: Array, normals: Array, alpha: Array, lamp: Lamp, view: View) -> Found:
    with np.errstate(invalid="ignore", divide="ignore", over="ignore"):
        corners, normals = corners.astype(np.float64), normals.astype(np.float64)
        middle = corners.mean(axis=1)
        n = _unit(normals.mean(axis=1))
        # either side may be looked at
        side = np.where(_dot(n, view.toward(middle)) < 0.0, -1.0, 1.0)
        n, normals = side * n, side[:, :, None] * normals
        x, y = _axes(n)
        d = np.stack([_off(corners[:, k], normals[:, k], n, x, y, lamp, view) for k in range(3)], axis=1)
        width = np.sqrt(alpha**2 + 0.25 * lamp.toward(middle)[1] ** 2)
        center = d.mean(axis=1)
        apart = np.linalg.norm(d - center[:, None], axis=2).max(axis=1)
        near = np.linalg.norm(center, axis=1) - 1.5 * apart < _dimmest(width)
        patch = Patch(lamp, view, *(v[near] for v in (corners, normals, n, x, y, alpha)))
        d = d[near]
        edges = np.stack([d[:, 1] - d[:, 0], d[:, 2] - d[:, 0]], axis=2)
        b = -np.einsum("mij,mj->mi", _inverse(edges)[0], d[:, 0])
        b = np.where((b > -0.5) & (b < 1.5), b, 1.0 / 3.0)
        for _ in range(4):
            off, change = patch.slopes(b)
            b = np.clip(b - np.einsum("mij,mj->mi", _inverse(change)[0], off), -1.0, 2.0)
        spots, inside = patch.spots(b)
        ridge = patch.chosen(~inside)
        parts = [spots]
        for start in _STARTS:
            parts.append(ridge.spots(ridge.onto(np.full((len(ridge.corners), 2), start), 4))[0])
        return joined(parts)


def _dimmest(width: Array) -> Array:
    """Slope from the middle of a highlight of ``width`` at which it is as bright as a surface of albedo 0.1."""
    return width * np.sqrt(np.maximum(np.sqrt(2.5) / width - 1.0, 0.0))


@dataclass(frozen=True, eq=False)
class Patch:
    """Triangles whose mean normals ``n`` face the viewer, with axes x, y across these."""

    lamp: Lamp
    view: View
    corners: Array
    normals: Array
    n: Array
    x: Array
    y: Array
    alpha: Array

    def chosen(self, which: Array) -> "Patch":
        """Those of a mask."""
        return Patch(self.lamp, self.view, *(v[which] for v in list(vars(self).values())[2:]))

    def slopes(self, b: Array) -> tuple[Array, Array]:
        """(``_off`` at barycentric coordinates [m, 2], its derivatives by both [m, 2, 2])."""

        def off(at: Array) -> Array:
            p, normal = _mixed(self.corners, at), _mixed(self.normals, at)
            return _off(p, normal, self.n, self.x, self.y, self.lamp, self.view)

        here = off(b)
        return here, np.stack([(off(b + _STEP * np.eye(2)[k]) - here) / _STEP for k in range(2)], axis=2)

    def moved(self, b: Array) -> Array:
        """Derivatives [m, 2, 2] of places in the image by barycentric coordinates."""
        p = self.view.image(_mixed(self.corners, b))
        ahead = [self.view.image(_mixed(self.corners, b + _STEP * np.eye(2)[k])) - p for k in range(2)]
        return np.stack(ahead, axis=2) / _STEP

    def across(self, b: Array, change: Array) -> tuple[Array, Array, Array, Array, Array]:
        """(direction [m, 2] in which slopes change most, and in which least, how much they change a pixel in either,
        the step [m, 2] of ``b`` that is a pixel the first way)."""
        back = _inverse(self.moved(b))[0]
        matrix = np.einsum("mij,mjk->mik", change, back)
        bad = ~np.isfinite(matrix).all(axis=(1, 2))
        u, sizes, v = np.linalg.svd(np.where(bad[:, None, None], np.eye(2), matrix))
        step = np.einsum("mij,mj->mi", back, v[:, 0])
        return u[:, :, 0], u[:, :, 1], np.where(bad, np.nan, sizes[:, 0]), sizes[:, 1], step

    def onto(self, b: Array, rounds: int) -> Array:
        """The places next to ``b`` where slopes agree in the direction in which they change most."""
        for _ in range(rounds):
            off, change = self.slopes(b)
            across, _, strong, _, step = self.across(b, change)
            b = np.clip(b - ((off * across).sum(axis=1) / strong)[:, None] * step, -1.0, 2.0)
        return b

    def spots(self, b: Array) -> tuple[Found, Array]:
        """(highlights around points of the triangles, which triangles they belong to): where slopes agree in the
        direction in which they change most, nearly."""
        n = _unit(_mixed(self.normals, b))
        x, y = _axes(n)
        there = Patch(self.lamp, self.view, self.corners, self.normals, n, x, y, self.alpha)
        off, change = there.slopes(b)
        p = _mixed(self.corners, b)
        toward, sine = self.lamp.toward(p)
        width = np.sqrt(self.alpha**2 + 0.25 * sine**2)
        across, along, strong, weak, step = there.across(b, change)
        left = np.abs((off * along).sum(axis=1))
        wide = np.hypot(width, left)
        corners = np.stack([self.view.image(self.corners[:, k]) for k in range(3)], axis=1)
        moved = np.einsum("mij,mj->mi", self.moved(b), step)
        v = _unit(moved)
        aside = np.stack([-v[:, 1], v[:, 0]], axis=1)
        extent = 0.5 * np.ptp(np.einsum("mkj,mj->mk", corners, aside), axis=1)
        thin, long = wide / strong, np.minimum(wide / np.maximum(weak, 1e-30), np.maximum(0.5 * extent, wide / strong))
        slack = np.minimum(3.0 * np.abs(step).max(axis=1) * thin, 0.5) + 1e-3
        inside = (b.min(axis=1) > -slack) & (b.sum(axis=1) < 1.0 + slack)
        inside &= np.abs((off * across).sum(axis=1)) < 0.3 * wide
        area = thin * long
        good = inside & (_dot(n, toward) > 0.0)[:, 0] & (_dot(n, self.view.toward(p)) > 0.0)[:, 0] & (sine <= WIDEST)
        good &= (left < _dimmest(width)) & (np.pi * area < LARGEST) & (area > 0.0)
        arriving = self.lamp.power * (1.0 if self.lamp.point else 1.0 * sine**2)
        flux = arriving * area / width**2 / (wide / width) ** 4
        # where the line along a ridge crosses the edges
        rest = corners - self.view.image(p)[:, None]
        ahead = np.einsum("mkj,mj->mk", rest, aside) / long[:, None]
        beside = np.einsum("mkj,mj->mk", rest, v)
        after, other = np.roll(ahead, -1, axis=1), np.roll(beside, -1, axis=1)
        crossed = np.where(beside * other < 0.0, (ahead * other - after * beside) / (other - beside), np.nan)
        span = np.stack([np.fmin.reduce(crossed, axis=1), np.fmax.reduce(crossed, axis=1)], axis=1)
        span = np.where(np.isfinite(span), span, (-1.0, 1.0))
        # off the surface by as much as it may be coarse
        size = np.linalg.norm(self.corners[:, 1] - self.corners[:, 0], axis=1)
        lifted = p + (1e-3 * size)[:, None] * n
        eye = lifted + 1e5 * self.view.back if self.view.orthographic else np.broadcast_to(self.view.position, p.shape)
        end = lifted + 1e5 * toward if self.lamp.distant else self.lamp.center - toward * self.lamp.radius
        dim = np.sqrt(np.maximum(_dimmest(width) ** 2 - left**2, 0.0)) / wide
        made = (self.view.image(p), thin[:, None] * v, long[:, None] * aside, flux, dim, span, lifted, eye, end)
        return Found(*(value[good] for value in made)), inside & (left < 0.5 * width)
