"""Reflectance models, one file (or a host and a device file) a model; public names load on first use.

``base`` the surface under the scratches (``base_device``, ``base_energy_device``, and ``base_arrays_device`` over
arrays); ``profile_table`` the mirror cone of a scratch profile; ``texture`` what varies over a surface; ``vectors``
checks of what NumPy entry points are given. ``mdf``, ``diffraction``, ``stencils``, ``measured``: folders of their own;
``responses`` those of them, and others, that stand in for a table or a base in the renderer.
"""

from ..lazy import lazily

_PUBLIC = {
    "BaseSurface": "base",
    "base_density": "base",
    "evaluate_base": "base",
    "preview_base": "base",
    "sample_base": "base",
}

__all__ = sorted(_PUBLIC)

__getattr__, __dir__ = lazily(__name__, _PUBLIC)
