"""Stages on which knobs are measured, as they are and otherwise lit or cut so that further knobs act."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from ..plan import make_plan
from ..plan.knobs import acting
from ..scene import DomeLight, Layer, Profile, RectLight, Scene, Settings, Shaping, Texture
from .knob_errors import MEASURED

STAGES = (
    "ball", "panel", "gold", "patterns", "spoon_window", "spoon_dome", "disc", "roof", "grooves_parallel",
    "grooves_crossing", "vinyls",
)  # fmt: skip
"""Demo stages that errors of knobs are measured on; the others are for testing them."""


@dataclass(frozen=True)
class Case:
    """A scene, its settings, and the knobs to measure on it, which all act there; ``name`` as in the file."""

    name: str
    scene: Scene
    settings: Settings
    knobs: tuple[str, ...]


def cases(name: str, scene: Scene, settings: Settings, knobs: Sequence[str] = MEASURED) -> list[Case]:
    """The stage itself first, then what becomes of it."""
    plan = make_plan(scene, settings)
    found = [(name, scene, settings, tuple(knobs))]

    def more(called: str, changed: Scene, how: Settings, *names: str) -> None:
        found.append((f"{name} {called}", changed, how, tuple(n for n in names if n in knobs)))

    tables, grooves = (any(x.table >= 0 for own in plan.layers for x in own), plan.on("grooves"))
    if tables and plan.on("lights.closedForm"):
        more("under windows", under_windows(scene), settings, "lights.coneTaps")
        more("under lamps", under_lamps(scene), settings, "lights.coneTaps")
    if grooves and not tables and name in ROUNDED:
        more("of round grooves", round_grooves(scene), settings, "grooves.section")
    if grooves and not tables:
        more("of deep grooves of gold", deep_grooves(scene), settings, "grooves.bounces", "pathDepth")
    if plan.on("diffraction.distantLookup"):
        own = {**settings.knobs, "diffraction.colors": "wavelengths"}
        more("by wavelengths", scene, replace(settings, knobs=own), "diffraction.wavelengths")
    made = []
    for called, changed, how, names in found:
        known = acting(make_plan(changed, how)) if names else {}
        acts = tuple(n for n in names if n in known)
        if acts:
            made.append(Case(called, changed, how, acts))
    return made


ROUNDED = ("roof", "grooves_parallel", "grooves_crossing")
"""Stages whose grooves are few enough under a footprint to be made of arcs."""


def under_windows(scene: Scene) -> Scene:
    """Domes show a room of three windows, plates of light shine mostly ahead."""
    return _lit(scene, "/windows", 8.0, ((8, 6, 6, 4), (4, 27, 3, 12), (12, 50, 8, 3)))


def under_lamps(scene: Scene) -> Scene:
    """Domes show rows of small lamps, plates of light shine mostly ahead."""
    lamps = tuple((row, column, 1, 1) for row in (3, 8, 13) for column in range(2 + row % 5, 64, 7))
    return _lit(scene, "/lamps", 40.0, lamps)


def _lit(scene: Scene, path: str, light: float, places: Sequence[tuple[int, int, int, int]]) -> Scene:
    """``places``: row, column, rows and columns of 32 by 64 pixels that shine."""
    pixels = np.full((32, 64, 4), 0.1, np.float32)
    for row, column, rows, columns in places:
        pixels[row : row + rows, column : column + columns] = light
    shaped = Shaping(focus=4.0, cone_angle=0.9, cone_softness=0.3)
    lights = []
    for own in scene.lights:
        if isinstance(own, DomeLight):
            own = replace(own, texture=len(scene.textures))
        elif isinstance(own, RectLight):
            own = replace(own, shaping=shaped)
        lights.append(own)
    return replace(scene, lights=tuple(lights), textures=(*scene.textures, Texture(path, pixels)))


def round_grooves(scene: Scene) -> Scene:
    """Cross-sections are arcs, of which simplified ones have fewer facets."""
    return _layers(scene, lambda layer: replace(layer, profile=Profile(path="/round", shape="round")))


def deep_grooves(scene: Scene) -> Scene:
    """Layers are as deep as wide at least and of gold, so that light goes on inside them."""
    return _layers(
        scene, lambda layer: replace(layer, depth=max(layer.depth, layer.width), material="conductor", metal="gold")
    )


def _layers(scene: Scene, change: Callable[[Layer], Layer]) -> Scene:
    materials = tuple(replace(m, layers=tuple(change(x) for x in m.layers)) for m in scene.materials)
    return replace(scene, materials=materials)
