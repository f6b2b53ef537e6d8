"""Measured BRDFs: read, interpolated, compared, and fitted by analytical rivals; public names load on first use.

``files`` reads UTIA, MERL and RGL and writes UTIA; ``brdf`` the record that they become. ``grid_device``,
``merl_device`` and ``rgl_device`` interpolate each format on the device. ``comparison`` the metrics, ``rivals`` and
``rival_shapes`` analytical models fitted to the same data as a stencil model.
"""

from ...lazy import lazily

_PUBLIC = {
    "Brdf": "brdf",
    "RIVALS": "rivals",
    "Rival": "rivals",
    "compare": "comparison",
    "fit_rival": "rivals",
    "load": "files",
    "lobes_for": "rivals",
    "save_utia": "files",
}

__all__ = sorted(_PUBLIC)

__getattr__, __dir__ = lazily(__name__, _PUBLIC)
