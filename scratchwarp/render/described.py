"""What decides an image, part by part: in the header of an image as one hash, of a checkpoint as names and values."""

from dataclasses import fields

from .. import __version__
from ..kernels import KernelKey
from ..plan import EffectPlan
from ..scene import Scene
from ..scene.digest import digest


def described(scene: Scene, plan: EffectPlan, key: KernelKey) -> dict[str, str]:
    """Name -> value of everything that decides an image and its tiles, the value as text, or # and a hash of it."""
    settings = plan.settings
    x0, x1, y0, y1 = plan.window
    said = {
        "version": __version__,
        "stage": scene.path,
        "time code": scene.time,
        "image size": plan.size,
        "window": plan.window,
        "tile": settings.tile,
        "spp": settings.spp or 1,
        "seed": settings.seed,
        "max_error": settings.max_error,
        "first pass": None if plan.aim is None else f"{plan.aim.first} to leave {plan.aim.noise:.6g}",
        "max_depth": settings.max_depth,
        "filter": settings.filter,
        "filter_width": settings.filter_width,
        "cone_taps": settings.cone_taps,
        "model": settings.model,
        "knobs": dict(sorted(settings.knobs.items())),
        "effects forced": dict(sorted(settings.effects.items())),
    }
    decisive = [f.name for f in fields(scene) if f.name not in ("warnings", "seconds", "path", "time")]
    hashed = {name: getattr(scene, name) for name in decisive}
    hashed |= {"scratch layers": plan.layers, "tables": plan.tables, "responses": plan.responses, "effects": key}
    return {n: f"{v}" for n, v in said.items()} | {n: f"#{digest(v)}" for n, v in hashed.items()}


def render_digest(scene: Scene, plan: EffectPlan, key: KernelKey) -> str:
    """Hash of everything that decides an image and its tiles."""
    return digest(described(scene, plan, key))


def scene_digest(scene: Scene) -> str:
    """Hash of everything in the scene that decides an image."""
    decisive = [f.name for f in fields(scene) if f.name not in ("warnings", "seconds")]
    return digest(*(getattr(scene, name) for name in decisive))
