"""Moves of the camera and of lights by the mouse: about the middle of the scene, and nearer."""

from dataclasses import dataclass

import numpy as np

from scratchwarp.scene import Scene
from scratchwarp.stage import LiveStage

_MOST = 1e4


@dataclass(frozen=True)
class Move:
    """``right``, ``up``: radians about the middle of the scene, as the picture shows it; ``across``, ``along``: shares
    of the picture's width and height by which the camera is shifted; ``nearer``: the distance to the middle is divided
    by this. ValueError on what is not finite or far out of range."""

    right: float = 0.0
    up: float = 0.0
    across: float = 0.0
    along: float = 0.0
    nearer: float = 1.0

    def __post_init__(self) -> None:
        for name, value in vars(self).items():
            if isinstance(value, bool) or not isinstance(value, int | float) or not abs(value) < _MOST:
                raise ValueError(f"{name} is {value!r}, expected a number")
        if not self.nearer > 1 / _MOST:
            raise ValueError(f"nearer is {self.nearer!r}, expected a number above 0")

    def then(self, other: "Move") -> "Move":
        """This move and another one after it."""
        return Move(
            self.right + other.right,
            self.up + other.up,
            self.across + other.across,
            self.along + other.along,
            min(max(self.nearer * other.nearer, 2 / _MOST), 0.5 * _MOST),
        )


def moved(live: LiveStage, prim: str, move: Move) -> np.ndarray:
    """The matrix [4, 4] of a light, or of the camera for "", after a move."""
    scene = live.scene
    low, high = scene.bounds()
    middle = 0.5 * (low + high)
    if prim == "":
        return _camera(scene, middle, move)
    matrix, seen = live.matrix(prim), scene.camera.transform
    turn = _about(seen[:3, 1], move.right) @ _about(seen[:3, 0], -move.up)
    matrix[:3, :3] = turn @ matrix[:3, :3]
    matrix[:3, 3] = middle + turn @ (matrix[:3, 3] - middle) / move.nearer
    return matrix


def _camera(scene: Scene, middle: np.ndarray, move: Move) -> np.ndarray:
    matrix = np.array(scene.camera.transform)
    turn = _about(scene.up, -move.right)
    right = turn @ matrix[:3, 0]
    tilt = _about(right, move.up)
    # not over the pole: looking along the up axis the picture would turn over
    if abs(float((tilt @ turn @ matrix[:3, 2]) @ scene.up)) < 0.995:
        turn = tilt @ turn
    matrix[:3, :3] = turn @ matrix[:3, :3]
    offset = turn @ (matrix[:3, 3] - middle) / move.nearer
    left, side, bottom, top = scene.camera.window(4, 3)
    reach = float(np.linalg.norm(offset)) if scene.camera.projection == "perspective" else 1.0
    shift = -move.across * (side - left) * reach * matrix[:3, 0] + move.along * (top - bottom) * reach * matrix[:3, 1]
    matrix[:3, 3] = middle + offset + shift
    return matrix


def _about(axis: np.ndarray, angle: float) -> np.ndarray:
    """Rotation [3, 3] by ``angle`` counter-clockwise about an axis."""
    x, y, z = axis / np.linalg.norm(axis)
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross
