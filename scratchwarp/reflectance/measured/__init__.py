"""Measured BRDFs: read, interpolated, compared, and fitted by analytical rivals; public names load on first use.

``files`` reads UTIA, MERL and RGL and writes UTIA; ``brdf`` the record that they become. ``grid_device``,
``merl_device`` and ``rgl_device`` interpolate each format on the device. ``comparison`` the metrics, ``rivals`` and
``rival_shapes`` analytical models fitted to the same data as a stencil model.
"""

import importlib

_PUBLIC = {
    "Brdf": "brdf",
    "RIVALS": "rivals",
    "Rival": "rivals",
    "compare": "comparison",
    "fit_rival": "rivals",
    "load": "files",
    "save_utia": "files",
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
