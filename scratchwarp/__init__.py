"""scratchwarp: light in scratches, from a USD stage to an image.

Public names load on first use, so that ``import scratchwarp`` imports neither USD nor Warp nor pyvista::

    import scratchwarp as sw
    scene = sw.read("ball.usda")
    plan = sw.make_plan(scene, sw.Settings(width=640, spp=16))
    sw.write(sw.render(scene, plan), "ball.exr")
"""

import importlib
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .render import render as render

__version__ = "0.1.0"

# name -> (module, attribute); attribute None means the module itself.
_PUBLIC = {
    "read": ("scratchwarp.pipeline", "read"),
    "make_plan": ("scratchwarp.plan", "make_plan"),
    "render": ("scratchwarp.render", None),  # the room, which renders when it is called
    "write": ("scratchwarp.image", "write"),
    "Settings": ("scratchwarp.scene", "Settings"),
    "Scene": ("scratchwarp.scene", "Scene"),
    "EffectPlan": ("scratchwarp.plan", "EffectPlan"),
    "EffectChoice": ("scratchwarp.plan", "EffectChoice"),
    "Film": ("scratchwarp.render", "Film"),
    "grooves": ("scratchwarp.reflectance.grooves", None),
    "mdf": ("scratchwarp.reflectance.mdf", None),
    "fit_far_field": ("scratchwarp.plan.far_field", "fit_far_field"),
    "measured": ("scratchwarp.reflectance.measured", None),
    "diffraction": ("scratchwarp.reflectance.diffraction", None),
    "optics": ("scratchwarp.optics", None),
    "profiles": ("scratchwarp.profiles", None),
    "scene": ("scratchwarp.scene", None),
    "study": ("scratchwarp.study", None),
    "stencils": ("scratchwarp.reflectance.stencils", None),
}

__all__ = ["__version__", *sorted(_PUBLIC)]


def __getattr__(name: str):
    try:
        module, attribute = _PUBLIC[name]
    except KeyError:
        raise AttributeError(f"module 'scratchwarp' has no attribute {name!r}") from None
    loaded = importlib.import_module(module)
    value = loaded if attribute is None else getattr(loaded, attribute)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *_PUBLIC})
