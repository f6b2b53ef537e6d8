"""A stage that is looked at while it is edited; the edits lie on a layer of their own."""

import time
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from pxr import Gf, Sdf, Usd, UsdGeom

from scratchwarp.scene import Camera, Control, Scene
from scratchwarp.scene.digest import digest

from . import controls
from .curves import CurveSets
from .layer import layer_primvars, read_layers, read_wave
from .open import gathered_diagnostics, usd_errors
from .options import read_settings, settings_path
from .overlay import check_target, overlay, save_layer
from .read import opened, read_scene
from .reading import Reading, Warnings

CAMERA_PATH = "/lookCamera"


class LiveStage:
    """A stage, the scene read from it, and edits to it that no file knows before ``save``.

    Geometry and textures are read once; after an edit only what depends on it is read again, and records that come
    out the same are the same objects, so that a session does not build them again.

    Attributes:
        scene: as it is now. seconds: that reading took the last time.
        edited: paths of the attributes that were turned.
    """

    def __init__(self, path: str | Path, camera: str | None = None, **options: Any) -> None:
        """``options``: those of ``stage.read``. Raises as it does."""
        self.path = str(path)
        clock, warnings = time.perf_counter(), Warnings()
        with gathered_diagnostics(path, warnings), usd_errors(path):
            self._reading, self._settings = opened(path, camera=camera, warnings=warnings, **options)
            scene, self._kept = read_scene(self._reading, self._settings, camera)
        self.seconds = time.perf_counter() - clock
        frame = options.get("frame")
        self.scene = replace(
            scene, time=None if frame is None else float(frame), warnings=warnings.lines(), seconds=self.seconds
        )
        self._stage, self._camera, self._wanted = self._reading.stage, camera, options.get("render_settings")
        self._session_layer = options.get("session_layer")
        self._known: dict[str, Control] = {}
        self._edits = Sdf.Layer.CreateAnonymous("look")
        self._stage.GetSessionLayer().subLayerPaths.insert(0, self._edits.identifier)
        self._stage.SetEditTarget(self._edits)

    @property
    def edited(self) -> tuple[str, ...]:
        """Paths of the attributes that the edits hold an opinion on."""
        found: list[str] = []

        def visit(path: Sdf.Path) -> None:
            if path.IsPropertyPath():
                found.append(str(path))

        self._edits.Traverse(Sdf.Path.absoluteRootPath, visit)
        return tuple(sorted(found))

    def controls(self) -> tuple[Control, ...]:
        """Everything that can be turned, in the order in which to show it."""
        if not self._known:
            self._known = {c.id: c for c in self._controls()}
        return tuple(self._known.values())

    def edit(self, values: Mapping[str, Any]) -> Scene:
        """Give attributes other values, by the ids of ``controls``, all of them or none.

        Raises ValueError on an id that is no control, a value that it does not take, or one that the stage as a whole
        cannot have.
        """
        self.controls()
        known, checked = self._known, {}
        for name, value in values.items():
            if name not in known:
                raise ValueError(f"{name!r} is nothing that can be turned")
            checked[name] = known[name].checked(value)
        sections = {known[name].section for name in values}
        with self.attempt():
            for name, value in checked.items():
                controls.author(self._attribute(name, known[name].section), value)
            scene = self._read_again(only_layers=sections <= {"layer", "profile", "curves", "wave"})
        self._known = known | {name: replace(known[name], value=value) for name, value in checked.items()}
        return scene

    def place(self, prim: str, matrix: np.ndarray) -> Scene:
        """Put a light or the camera elsewhere: ``matrix`` [4, 4], object to world in metres relative to the scene's
        origin, column vectors. ``prim`` "" is the camera that is looked through. ValueError for any other prim."""
        camera = prim in ("", self.scene.camera.path)
        with self.attempt():
            target = self._camera_prim() if camera else self._stage.GetPrimAtPath(prim)
            if not camera and not (target and controls.is_light(target)):
                raise ValueError(f"{prim!r} is no light that can be moved")
            world = np.array(matrix, np.float64)
            if world.shape != (4, 4) or not np.isfinite(world).all() or abs(np.linalg.det(world[:3, :3])) < 1e-12:
                raise ValueError(f"{prim or 'camera'}: the matrix to place it by cannot be inverted")
            world[:3, 3] += self.scene.origin
            world[:3, 3] /= self._reading.metres
            if not camera:  # which has no size
                world[:3, :3] /= self._reading.metres
            xform = UsdGeom.Xformable(target)
            op = xform.GetTransformOp("look") or xform.AddTransformOp(opSuffix="look")
            op.Set(Gf.Matrix4d(world.T.tolist()))
            xform.SetXformOpOrder([op], resetXformStack=True)
            return self._read_again(only_layers=False)

    def matrix(self, prim: str) -> np.ndarray:
        """Where a light is: object to world [4, 4] in metres relative to the scene's origin, column vectors."""
        target = self._stage.GetPrimAtPath(prim)
        if not (target and controls.is_light(target)):
            raise ValueError(f"{prim!r} is no light that can be moved")
        world = self._reading.world(target)
        world[:3] *= self._reading.metres
        world[:3, 3] -= self.scene.origin
        return world

    def reset(self) -> Scene:
        """Drop every edit."""
        self._edits.Clear()
        self._known = {}
        return self._read_again(only_layers=False)

    def save(self, path: str | Path) -> None:
        """Write the edits as a USD layer that lies over the stage: opened, it shows the stage as it is now.

        Raises ValueError where that would replace a file of the stage, OSError where it cannot be written.
        """
        target = Path(path)
        check_target(self._stage, target)
        between = [self._session_layer] if self._session_layer else []
        save_layer(overlay(self._edits, self._stage.GetRootLayer(), target, between), target)

    def _controls(self) -> Iterator[Control]:
        time_code = self._reading.time
        for path in dict.fromkeys(m.path for m in self.scene.materials if m.path):
            prim = self._stage.GetPrimAtPath(path)
            if prim and not prim.IsInstanceProxy():
                yield from controls.material_controls(prim, time_code)
        for path in dict.fromkeys(light.path for light in self.scene.lights if light.path):
            prim = self._stage.GetPrimAtPath(path)
            if prim and controls.is_light(prim):
                yield from controls.light_controls(prim, time_code)
        prim = self._stage.GetPrimAtPath(self.scene.camera.path) if self.scene.camera.path else None
        if prim and not prim.IsInstanceProxy():
            yield from controls.camera_controls(prim, time_code)
        path = settings_path(self._stage, self._wanted)
        prim = self._stage.GetPrimAtPath(path) if path else None
        if prim:
            yield from controls.settings_controls(prim, time_code)

    def _attribute(self, name: str, section: str) -> Usd.Attribute:
        path = Sdf.Path(name)
        if section == "surface":
            return controls.surface_attribute(self._stage, path)
        return self._stage.GetAttributeAtPath(path)

    def _camera_prim(self) -> Usd.Prim:
        """The prim that is looked through; one of the edits' own where the stage has none."""
        prim = self._stage.GetPrimAtPath(self.scene.camera.path or CAMERA_PATH)
        if prim and not prim.IsInstanceProxy():
            return prim
        made = UsdGeom.Camera.Define(self._stage, CAMERA_PATH)
        seen: Camera = self.scene.camera
        made.CreateHorizontalApertureAttr(seen.horizontal_aperture)
        made.CreateVerticalApertureAttr(seen.vertical_aperture)
        made.CreateFocalLengthAttr(seen.focal_length)
        self._camera = CAMERA_PATH
        return made.GetPrim()

    def _read_again(self, only_layers: bool) -> Scene:
        clock, old, warnings = time.perf_counter(), self.scene, Warnings()
        # a reading of its own: matrices and warnings of the last one are stale
        reading = replace(self._reading, warn=warnings)
        with gathered_diagnostics(self.path, warnings), usd_errors(self.path):
            if only_layers and layer_primvars(self._stage) <= self._kept.primvars:
                scene = self._with_layers(reading)
            else:
                self._settings = read_settings(reading, self._wanted)
                scene, self._kept = read_scene(reading, self._settings, self._camera, self._kept, old.origin)
        kept = ("meshes", "textures", "curves")
        same: dict[str, Any] = {name: _same(getattr(old, name), getattr(scene, name)) for name in kept}
        self.scene = replace(scene, **same, time=old.time, seconds=old.seconds, warnings=warnings.lines())
        self._reading, self.seconds = reading, time.perf_counter() - clock
        return self.scene

    def _with_layers(self, reading: Reading) -> Scene:
        """The scene with the layers of its materials read again."""
        curves = CurveSets(reading, self.scene.origin)
        textures = self._kept.textures
        materials = []
        for material in self.scene.materials:
            prim = self._stage.GetPrimAtPath(material.path) if material.path else None
            if prim:
                layers = read_layers(reading, prim, curves, textures)
                material = replace(material, layers=layers, wave=read_wave(reading, prim))
            materials.append(material)
        return replace(
            self.scene,
            materials=tuple(materials),
            curves=tuple(curves.records),
            textures=tuple(textures.records),
        )

    @contextmanager
    def attempt(self) -> Iterator[None]:
        """Edits made in this block are undone where it raises."""
        kept = Sdf.Layer.CreateAnonymous("kept")
        kept.TransferContent(self._edits)
        before = (self.scene, self._camera, self._known, self._reading, self._settings, self.seconds)
        try:
            yield
        except BaseException:
            self._edits.TransferContent(kept)
            self.scene, self._camera, self._known, self._reading, self._settings, self.seconds = before
            raise


def _same(old: tuple[Any, ...], new: tuple[Any, ...]) -> tuple[Any, ...]:
    """The new records, the old ones in place of those that are equal to the last bit."""
    pairs = zip(old, new, strict=False)
    made = tuple(o if o is n or digest(o) == digest(n) else n for o, n in pairs) + new[len(old) :]
    return old if made == old else made
