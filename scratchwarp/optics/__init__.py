"""Light at one interaction: Fresnel reflectance, metals, spectra, microfacets, sampling.

Host, NumPy: ``fresnel`` (the reflectors and their reference formulas), ``metals`` and ``metal_tables`` (measured n, k),
``spectra`` and ``cie_tables`` (colorimetry). Device, Warp: ``frames_device``, ``fresnel_device``,
``refraction_device``, ``microfacets_device``, ``sampling_device`` (front door to ``hash_device``, ``sobol_device`` and
``filters_device``).
Importing this package does not import Warp.
"""

from ..lazy import lazily

_PUBLIC = {
    "Mirror": "fresnel",
    "Conductor": "fresnel",
    "Dielectric": "fresnel",
    "Schlick": "fresnel",
    "Reflector": "fresnel",
    "fresnel": "",
    "metals": "",
    "spectra": "",
}

__all__ = sorted(_PUBLIC)

__getattr__, __dir__ = lazily(__name__, _PUBLIC)
