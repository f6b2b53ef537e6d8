"""Microfacet distributions that follow a scratch normal map (Kang and Cho, WSCG 2011); public names load on first use.

``distributions_device`` the densities of facet normals; ``deform_device`` the map of the disk of normals that a
perturbed normal pulls along; ``lobe_device`` value, sampling and density of the reflection; ``density`` and ``lobe``
the same from NumPy; ``normal_map`` seamless maps of scratches.
"""

from ...lazy import lazily

_PUBLIC = {
    "DISTRIBUTIONS": "density",
    "KINDS": "density",
    "Lobe": "lobe",
    "LobeSamples": "lobe",
    "ashikhmin_shirley": "density",
    "beckmann": "density",
    "deform": "density",
    "deformed": "density",
    "evaluate": "lobe",
    "ggx": "density",
    "inverse_deform": "density",
    "pdf": "lobe",
    "sample": "lobe",
    "scratch_map": "normal_map",
    "ward": "density",
}

__all__ = sorted(_PUBLIC)

__getattr__, __dir__ = lazily(__name__, _PUBLIC)
