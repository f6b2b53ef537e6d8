"""The camera to look through: the one asked for, the stage's, or one that frames the scene."""

from collections.abc import Iterator

import numpy as np
from pxr import Usd, UsdGeom, UsdUtils

from scratchwarp.scene import Camera, StageError

from .reading import Reading

_TENTH = 0.1  # camera lengths are in tenths of a scene unit


def find_camera(reading: Reading, wanted: str | None, from_settings: str | None) -> Usd.Prim | None:
    """The camera prim to use: ``wanted`` (path or name), the render settings', the primary camera, the first one.

    None when the stage has no camera. Raises StageError when ``wanted`` names no camera.
    """
    cameras = list(_cameras(reading.stage))
    if wanted is not None:
        match = [c for c in cameras if wanted in (str(c.GetPath()), c.GetName())]
        match += [c for c in cameras if str(c.GetPath()).endswith("/" + wanted.lstrip("/"))]
        if not match:
            known = ", ".join(str(c.GetPath()) for c in cameras) or "none"
            raise StageError(f"{reading.path}: no camera {wanted!r}; the stage's cameras are: {known}")
        return match[0]
    if from_settings:
        prim = reading.stage.GetPrimAtPath(from_settings)
        if prim and prim.IsA(UsdGeom.Camera):
            return prim
        reading.warn(from_settings, "the render settings name this camera, but it is none; another is used")
    primary = [c for c in cameras if c.GetName() == UsdUtils.GetPrimaryCameraName()]
    if primary:
        return primary[0]
    if len(cameras) > 1:
        reading.warn(cameras[0].GetPath(), f"first of {len(cameras)} cameras; name another to look through it")
    return cameras[0] if cameras else None


def _cameras(stage: Usd.Stage) -> Iterator[Usd.Prim]:
    for prim in Usd.PrimRange.Stage(stage, Usd.TraverseInstanceProxies()):
        if prim.IsA(UsdGeom.Camera):
            yield prim


def read_camera(reading: Reading, prim: Usd.Prim) -> tuple[Camera, np.ndarray]:
    """(Camera at the local origin, its world position in metres).

    The frame is the prim's without scale and shear: it keeps looking down its -Z, then up as near +Y as it can.
    Apertures and focal length are tenths of a scene unit; the lens radius is focalLength / (2 fStop).
    """
    world = reading.world(prim)
    path = str(prim.GetPath())
    rotation = _frame(reading, path, world[:3, :3])
    transform = np.eye(4)
    transform[:3, :3] = rotation
    number = reading.number
    projection = str(reading.value(prim, "projection", "perspective"))
    if projection not in ("perspective", "orthographic"):
        reading.warn(path, f"projection {projection!r} is not known; perspective is used")
        projection = "perspective"
    unit = _TENTH * reading.metres if projection == "orthographic" else 1.0
    near, far = (float(x) for x in reading.value(prim, "clippingRange", (0.0, np.inf)))
    if not (near >= 0 or projection == "orthographic") or not far > near:
        reading.warn(path, f"clippingRange is ({near}, {far}); it is ignored")
        near, far = 0.0, np.inf
    if len(reading.value(prim, "clippingPlanes", ())):
        reading.warn(path, "clippingPlanes are not honoured")
    f_stop = number(prim, "fStop")
    focus = number(prim, "focusDistance")
    focal = _positive(reading, prim, "focalLength", 50.0)
    if f_stop > 0 and focus <= 0:
        reading.warn(path, f"fStop is {f_stop:g} but focusDistance is {focus:g}; it is rendered as a pinhole")
        f_stop = 0.0
    camera = Camera(
        path=path,
        transform=transform,
        horizontal_aperture=_positive(reading, prim, "horizontalAperture", 20.955) * unit,
        vertical_aperture=_positive(reading, prim, "verticalAperture", 15.2908) * unit,
        horizontal_offset=number(prim, "horizontalApertureOffset") * unit,
        vertical_offset=number(prim, "verticalApertureOffset") * unit,
        focal_length=focal,
        projection=projection,
        near=near * reading.metres,
        far=far * reading.metres,
        lens_radius=0.5 * _TENTH * focal / f_stop * reading.metres if f_stop > 0 else 0.0,
        focus_distance=focus * reading.metres,
        exposure=_exposure(reading, prim),
    )
    return camera, world[:3, 3] * reading.metres


def framing_camera(low: np.ndarray, high: np.ndarray, up: np.ndarray) -> tuple[Camera, np.ndarray]:
    """A camera that sees the box ``low``..``high`` [m] whole, from the front, the right and above; and its position."""
    center, radius = (low + high) / 2, max(float(np.linalg.norm(high - low)) / 2, 1e-3)
    toward_viewer = np.array([0.0, 0.0, 1.0]) if up[1] > 0.5 else np.array([0.0, -1.0, 0.0])
    right = np.cross(up, toward_viewer)
    z = toward_viewer + 0.5 * right + 0.6 * up
    z /= np.linalg.norm(z)
    x = np.cross(up, z)
    x /= np.linalg.norm(x)
    transform = np.eye(4)
    transform[:3, :3] = np.stack([x, np.cross(z, x), z], axis=1)
    camera = Camera(path="", transform=transform)
    half = np.arctan(0.5 * camera.vertical_aperture / camera.focal_length)
    return camera, center + z * (1.05 * radius / np.sin(half))


def _frame(reading: Reading, path: str, matrix: np.ndarray) -> np.ndarray:
    z, y = matrix[:, 2], matrix[:, 1]
    length = np.linalg.norm(z)
    if not np.isfinite(matrix).all() or length == 0:
        raise StageError(f"{reading.path}: camera {path} has a transform that cannot be inverted; repair its xformOps")
    z = z / length
    y = y - (y @ z) * z
    length = np.linalg.norm(y)
    if length == 0:
        raise StageError(f"{reading.path}: camera {path} has a transform that cannot be inverted; repair its xformOps")
    y = y / length
    if np.linalg.det(matrix) < 0:
        reading.warn(path, "the camera's transform mirrors; the image is not mirrored")
    return np.stack([np.cross(y, z), y, z], axis=1)


def _positive(reading: Reading, prim: Usd.Prim, name: str, otherwise: float) -> float:
    got = reading.number(prim, name, otherwise)
    if got <= 0:
        reading.warn(prim.GetPath(), f"{name} is {got:g}; {otherwise:g} is used")
        return otherwise
    return got


def _exposure(reading: Reading, prim: Usd.Prim) -> float:
    scale = float(UsdGeom.Camera(prim).ComputeLinearExposureScale(reading.time))
    if not np.isfinite(scale) or scale < 0:
        reading.warn(prim.GetPath(), f"its exposure attributes give a factor of {scale}; 1 is used")
        return 1.0
    return scale
