"""read: a USD file to a Scene."""

import time
from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from pxr import Usd, UsdGeom

from scratchwarp.scene import Budget, Camera, Scene, StageError

from .camera import find_camera, framing_camera, read_camera
from .complain import complain
from .crate import check_arrays
from .curves import CurveSets
from .geometry import Geometry, read_geometry
from .illuminate import read_lights
from .layer import layer_primvars
from .material import Materials
from .open import gathered_diagnostics, metres_per_unit, open_stage, up_axis, usd_errors
from .options import StageSettings, read_settings
from .place import place_instances
from .reading import Reading, TextureLoader, Warnings
from .texture import Textures
from .traverse import placed_prims

PURPOSES = ("default", "render")
ALL_PURPOSES = ("default", "render", "proxy", "guide")


def read(
    path: str | Path,
    frame: float | None = None,
    camera: str | None = None,
    purposes: Iterable[str] = PURPOSES,
    load_texture: TextureLoader | None = None,
    session_layer: str | Path | None = None,
    mask: str | Iterable[str] | None = None,
    render_settings: str | None = None,
    default_time: bool = False,
    warn: Callable[[str], None] | None = None,
    budget: Budget | None = None,
) -> Scene:
    """Read a stage at one time.

    Args:
        path: a .usd, .usda, .usdc or .usdz file.
        frame: time code; None reads every attribute at its earliest sample, or its default where it has none.
        default_time: read every attribute's default, even where it has samples; ``frame`` is then None.
        camera: path or name of the camera; None: the render settings', the primary, the first, else one that frames
            the scene.
        purposes: purposes to include besides default; the render settings' authored includedPurposes replace the two
            given here by default.
        load_texture: decodes image files, ``(path, colour space) -> [h, w, 4]``; None: textures give their fallback.
        session_layer: file with opinions stronger than the stage's.
        mask: prim paths to which the stage is limited, as a sequence or one string.
        render_settings: path of a RenderSettings prim; None: the one that the stage names.
        warn: called with each warning of the scene, at the end.
        budget: memory that what is read may take; None: most of this machine's. What would take more is an error.

    Raises StageError (a ValueError) when the input is at fault: the message names the file, or the prim and the value.
    """
    started = time.perf_counter()
    warnings = Warnings()
    with gathered_diagnostics(path, warnings), usd_errors(path):
        reading, settings = opened(
            path, frame, purposes, load_texture, session_layer, mask, render_settings, default_time, camera, warnings,
            budget,
        )  # fmt: skip
        scene, _ = read_scene(reading, settings, camera)
    scene = replace(
        scene,
        time=None if frame is None else float(frame),
        warnings=warnings.lines(),
        seconds=time.perf_counter() - started,
    )
    if warn is not None:
        for sentence in scene.warnings:
            warn(sentence)
    return scene


@dataclass(frozen=True, eq=False)
class Kept:
    """What is read of a stage once, however often its layers, lights and camera are read: meshes in object space with
    their placements, and decoded images."""

    geometry: Geometry
    textures: Textures
    primvars: frozenset[str] = frozenset()


def opened(
    path: str | Path,
    frame: float | None = None,
    purposes: Iterable[str] = PURPOSES,
    load_texture: TextureLoader | None = None,
    session_layer: str | Path | None = None,
    mask: str | Iterable[str] | None = None,
    render_settings: str | None = None,
    default_time: bool = False,
    camera: str | None = None,
    warnings: Warnings | None = None,
    budget: Budget | None = None,
) -> tuple[Reading, StageSettings]:
    """Open a stage for reading; arguments and errors as those of ``read``."""
    unknown = sorted({*purposes} - {*ALL_PURPOSES})
    if unknown:
        raise StageError(f"purposes name {', '.join(unknown)}; known are {', '.join(ALL_PURPOSES)}")
    if frame is not None and not np.isfinite(frame):
        raise StageError(f"frame is {frame}; expected a time code")
    if frame is not None and default_time:
        raise StageError(f"frame is {frame} and default_time is set; give one of them")
    unsampled = Usd.TimeCode.Default() if default_time else Usd.TimeCode.EarliestTime()
    stage = open_stage(path, session_layer, mask, [k for k in (camera, render_settings) if k])
    allowed = budget or Budget()
    check_arrays(stage, allowed)
    up_axis(path, stage)
    reading = Reading(
        stage=stage,
        time=unsampled if frame is None else Usd.TimeCode(float(frame)),
        path=str(path),
        metres=metres_per_unit(path, stage),
        warn=warnings or Warnings(),
        load_texture=load_texture,
        budget=allowed,
    )
    settings = read_settings(reading, render_settings)
    return replace(reading, purposes=_purposes(tuple(purposes), settings)), settings


def read_scene(
    reading: Reading,
    settings: StageSettings,
    camera: str | None,
    kept: Kept | None = None,
    origin: np.ndarray | None = None,
) -> tuple[Scene, Kept]:
    """(the scene, but for what is known only at the end; what need not be read again).

    ``kept``: of an earlier reading, where no mesh has changed or moved since. ``origin``: the scene's [m], where it
    shall not be the camera's position.
    """
    if kept is None:
        reading.budget.taken = 0.0
    budget = reading.budget if kept is None else reading.budget.fresh()  # what is kept was counted
    reading = replace(reading, primvars=layer_primvars(reading.stage), budget=budget)
    places = placed_prims(reading)
    if kept is None or not reading.primvars <= kept.primvars:
        textures = Textures(reading) if kept is None else kept.textures
        kept = Kept(read_geometry(reading, places), textures, reading.primvars)
    geometry, textures = Geometry(list(kept.geometry.meshes), kept.geometry.placements), kept.textures
    view, eye = _camera(reading, find_camera(reading, camera, settings.camera), geometry, settings)
    if origin is None:
        origin = eye
    else:
        transform = np.array(view.transform)
        transform[:3, 3] += eye - origin
        view = replace(view, transform=transform)
    curves = CurveSets(reading, origin)
    materials = Materials(reading, textures, curves)
    instances = place_instances(reading, geometry, origin, materials, settings.binding_purposes)
    complain(reading, geometry.meshes, instances, materials.records)
    lit = read_lights(reading, places, origin, geometry.meshes, instances, materials, textures)
    scene = Scene(
        path=reading.path,
        meshes=tuple(lit.meshes),
        instances=tuple(lit.instances),
        materials=tuple(materials.records),
        lights=tuple(lit.lights),
        camera=view,
        textures=tuple(textures.records),
        curves=tuple(curves.records),
        origin=origin,
        up=_up(reading.stage),
        options=settings.options,
    )
    return scene, kept


def _purposes(asked: tuple[str, ...], settings: StageSettings) -> tuple[str, ...]:
    chosen = settings.purposes if asked == PURPOSES and settings.purposes is not None else asked
    return ("default", *(p for p in chosen if p != "default"))


def _up(stage: Usd.Stage) -> np.ndarray:
    return np.array([0.0, 0.0, 1.0] if UsdGeom.GetStageUpAxis(stage) == UsdGeom.Tokens.z else [0.0, 1.0, 0.0])


def _camera(
    reading: Reading, prim: Usd.Prim | None, geometry: Geometry, settings: StageSettings
) -> tuple[Camera, np.ndarray]:
    """(the camera at the origin, its world position [m]); one that frames the scene where the stage has none."""
    if prim is None:
        reading.warn(reading.path, "the stage has no camera; one that frames the scene is used")
        low, high = geometry.bounds() or (-np.ones(3), np.ones(3))
        return framing_camera(low * reading.metres, high * reading.metres, _up(reading.stage))
    view, origin = read_camera(reading, prim)
    return (view if settings.options.depth_of_field else replace(view, lens_radius=0.0)), origin
