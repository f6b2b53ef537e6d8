"""Reflectance models, one file (or a host and a device file) a model; public names load on first use.

``base`` the surface under the scratches; ``profile_table`` the mirror cone of a scratch profile; ``texture`` what
varies over a surface.
"""

import importlib

_PUBLIC = {
    "BaseSurface": "base",
    "base_density": "base",
    "evaluate_base": "base",
    "preview_base": "base",
    "sample_base": "base",
}

__all__ = sorted(_PUBLIC)


def __getattr__(name: str):
    if name not in _PUBLIC:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    value = getattr(importlib.import_module(f"{__name__}.{_PUBLIC[name]}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
