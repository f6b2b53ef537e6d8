"""Light at one interaction: Fresnel reflectance, metals, spectra, microfacets, sampling.

Host, NumPy: ``fresnel`` (the reflectors and their reference formulas), ``metals`` and ``metal_tables`` (measured n, k),
``spectra`` and ``cie_tables`` (colorimetry). Device, Warp: ``frames_device``, ``fresnel_device``,
``microfacets_device``,
``sampling_device`` (front door to ``hash_device``, ``sobol_device`` and ``filters_device``). Importing this package
does not import Warp.
"""

import importlib

_PUBLIC = {
    "Mirror": "fresnel",
    "Conductor": "fresnel",
    "Dielectric": "fresnel",
    "Schlick": "fresnel",
    "Reflector": "fresnel",
}
_MODULES = ("fresnel", "metals", "spectra")

__all__ = [*sorted(_PUBLIC), *_MODULES]


def __getattr__(name: str):
    if name in _MODULES:
        return importlib.import_module(f"{__name__}.{name}")
    if name in _PUBLIC:
        value = getattr(importlib.import_module(f"{__name__}.{_PUBLIC[name]}"), name)
        globals()[name] = value
        return value
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
