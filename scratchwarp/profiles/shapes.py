"""Named cross-sections over x in [0, 1], the surface at z = 0. A new shape is one function with ``@_register``.

Each function returns z(x) / depth as ``points`` (and arcs where smooth) for depth 1; depth scales it, as a scratch
layer's width and depth do, so "round" is half an ellipse (a semicircle at depth 0.5).
"""

import inspect
from collections.abc import Callable
from typing import Any

import numpy as np

from scratchwarp.profiles.profile import Profile

Outline = tuple[np.ndarray, np.ndarray | None]
_SHAPES: dict[str, Callable[..., Outline]] = {}


def _register(function: Callable[..., Outline]) -> Callable[..., Outline]:
    words = function.__name__.strip("_").split("_")
    _SHAPES[words[0] + "".join(word.capitalize() for word in words[1:])] = function
    return function


def shape_names() -> tuple[str, ...]:
    """The names that ``shape`` knows."""
    return tuple(_SHAPES)


def shape(
    name: str,
    depth: float = 0.5,
    *,
    rim: float = 0.0,
    rim_width: float = 0.25,
    isolated: bool = False,
    **parameters: Any,
) -> Profile:
    """A named profile of width 1 and the given ``depth`` (in widths, >= 0; 0 is flat ground).

    ``name``: flat, vGroove, rectangle, trapezoid (``floor``: width of its floor, 0.5), round (half an ellipse),
    quartic (z = -d (1 - (2x - 1)^2)^2), gaussian (``sigma``: standard deviation in widths, 1/6; its ends are lowered
    to 0), sine (one period). ``segments``: arcs of the smooth ones, 64. ``rim`` >= 0: height in depths of a ridge of
    displaced material on either side, each taking ``rim_width`` of the width. Raises ValueError on an unknown name or
    parameter, or values out of range.
    """
    if name not in _SHAPES:
        raise ValueError(f"name must be one of {shape_names()}, got {name!r}")
    for key, value in (("depth", depth), ("rim", rim), ("rim_width", rim_width)):
        if not (isinstance(value, int | float | np.number) and np.isfinite(value) and value >= 0.0):
            raise ValueError(f"{key} must be finite and at least 0, got {value!r}")
    if not 0.0 < rim_width < 0.5:
        raise ValueError(f"rim_width must lie between 0 and 0.5, got {rim_width}")
    known = [key for key in inspect.signature(_SHAPES[name]).parameters]
    unknown = sorted(set(parameters) - set(known))
    if unknown:
        raise ValueError(f"{unknown[0]} is not a parameter of {name!r}, which has {known}")
    if depth == 0.0:
        return Profile(np.array([[0.0, 0.0], [1.0, 0.0]]), isolated)
    points, controls = _SHAPES[name](**parameters)
    if rim > 0.0:
        points, controls = _with_rim(points, controls, rim, rim_width)
    size = np.array((1.0, depth))
    return Profile(points * size, isolated, None if controls is None else controls * size)


def smooth(
    function: Callable[[np.ndarray], np.ndarray], slope: Callable[[np.ndarray], np.ndarray], x: np.ndarray
) -> Outline:
    """Arcs through z = ``function(x)`` at ascending ``x``, tangent to it there: the middle points are where
    neighbouring tangents meet. An arc across an inflection has no such point and is cut in two at its middle.
    Position error O(h^3), normals O(h^2)."""
    z, m = function(x), slope(x)
    h, chord = np.diff(x), np.diff(z) / np.diff(x)
    inflected = (m[:-1] - chord) * (m[1:] - chord) > 0.0
    after = np.flatnonzero(inflected)
    middle_slope = 2.0 * chord[after] - 0.5 * (m[after] + m[after + 1])
    middle_z = z[after] + 0.25 * h[after] * (m[after] + middle_slope)
    x = np.insert(x, after + 1, x[after] + 0.5 * h[after])
    z, m = np.insert(z, after + 1, middle_z), np.insert(m, after + 1, middle_slope)
    h, turn = np.diff(x), m[:-1] - m[1:]
    straight = np.abs(turn) < 1e-12
    along = np.where(straight, 0.5 * h, (np.diff(z) - m[1:] * h) / np.where(straight, 1.0, turn))
    height = np.where(straight, 0.5 * (z[:-1] + z[1:]), z[:-1] + m[:-1] * along)
    return np.stack((x, z), axis=1), np.stack((x[:-1] + np.clip(along, 0.0, h), height), axis=1)


@_register
def flat() -> Outline:
    """No groove at all."""
    return np.array([[0.0, 0.0], [1.0, 0.0]]), None


@_register
def v_groove(apex: float = 0.5) -> Outline:
    """Two flat facets that meet at depth 1, at x = ``apex`` in [0, 1]."""
    return np.array([[0.0, 0.0], [_share("apex", apex), -1.0], [1.0, 0.0]]), None


@_register
def rectangle() -> Outline:
    """Vertical walls and a flat floor."""
    return np.array([[0.0, 0.0], [0.0, -1.0], [1.0, -1.0], [1.0, 0.0]]), None


@_register
def trapezoid(floor: float = 0.5, apex: float = 0.5) -> Outline:
    """Sloping walls and a flat floor of width ``floor`` in [0, 1]; the left wall takes the share ``apex`` of the
    rest."""
    left = _share("apex", apex) * (1.0 - _share("floor", floor))
    return np.array([[0.0, 0.0], [left, -1.0], [left + floor, -1.0], [1.0, 0.0]]), None


def _share(name: str, value: float) -> float:
    if not 0.0 <= value <= 1.0:
        raise ValueError(f"{name} must lie in [0, 1], got {value}")
    return value


def _count(segments: int) -> int:
    if int(segments) != segments or segments < 4:
        raise ValueError(f"segments must be a whole number of at least 4, got {segments}")
    return int(segments)


@_register
def _round(segments: int = 64) -> Outline:
    """Half an ellipse; every arc spans the same angle of its circle. Vertical at both ends."""
    angle = np.linspace(0.0, np.pi, _count(segments) + 1)
    half = np.pi / (2 * segments)
    points = np.stack((0.5 - 0.5 * np.cos(angle), -np.sin(angle)), axis=1)
    points[[0, -1]] = [[0.0, 0.0], [1.0, 0.0]]
    middle = 0.5 * (angle[:-1] + angle[1:])
    return points, np.stack((0.5 - 0.5 * np.cos(middle) / np.cos(half), -np.sin(middle) / np.cos(half)), axis=1)


@_register
def quartic(segments: int = 64) -> Outline:
    """-(1 - (2x - 1)^2)^2."""
    x = np.linspace(0.0, 1.0, _count(segments) + 1)
    return smooth(lambda x: -((1 - (2 * x - 1) ** 2) ** 2), lambda x: 8 * (2 * x - 1) * (1 - (2 * x - 1) ** 2), x)


@_register
def gaussian(sigma: float = 1 / 6, segments: int = 64) -> Outline:
    """A bell upside down, shifted and stretched to run from 0 over -1 to 0."""
    if not (np.isfinite(sigma) and sigma > 0.0):
        raise ValueError(f"sigma must be finite and above 0, got {sigma}")
    x = np.linspace(0.0, 1.0, _count(segments) + 1)
    end = np.exp(-0.125 / sigma**2)

    def bell(x: np.ndarray) -> np.ndarray:
        return np.exp(-0.5 * ((x - 0.5) / sigma) ** 2)

    return smooth(lambda x: (end - bell(x)) / (1 - end), lambda x: (x - 0.5) / sigma**2 * bell(x) / (1 - end), x)


@_register
def sine(segments: int = 64) -> Outline:
    """(cos(2 pi x) - 1) / 2."""
    x = np.linspace(0.0, 1.0, _count(segments) + 1)
    return smooth(lambda x: 0.5 * (np.cos(2 * np.pi * x) - 1), lambda x: -np.pi * np.sin(2 * np.pi * x), x)


def _with_rim(points: np.ndarray, controls: np.ndarray | None, rim: float, width: float) -> Outline:
    """The groove squeezed between two ridges z = rim sin^2(pi x / width)."""
    x = np.linspace(0.0, width, 17)
    ridge, arcs = smooth(
        lambda x: rim * np.sin(np.pi * x / width) ** 2, lambda x: rim * np.pi / width * np.sin(2 * np.pi * x / width), x
    )
    assert arcs is not None
    squeeze, shift = np.array((1 - 2 * width, 1.0)), np.array((width, 0.0))
    flat_middles = 0.5 * (points[:-1] + points[1:])
    middle = (flat_middles if controls is None else controls) * squeeze + shift
    right = np.array((1.0 - width, 0.0))
    groove = points * squeeze + shift
    return np.concatenate((ridge[:-1], groove, ridge[1:] + right)), np.concatenate((arcs, middle, arcs + right))
