"""Highlight stencils: multi-axial anisotropic BRDFs in a few numbers (Filip, Havlicek and Vavra 2015).

Public names load on first use. ``model`` the records; ``stencil_device`` and ``sample_device`` value, sampling and
density; ``evaluation`` the same from NumPy; ``energy`` what keeps a model from reflecting more than it gets.
Fitting: ``angles`` the grid of a measurement and its symmetries, ``axes`` the detection of modes, ``direct`` the fit
of the paper, ``start``, ``forward`` and ``refine`` the least squares after it, ``fitting`` the way through all of them.
"""

from ...lazy import lazily

_PUBLIC = {
    "Mode": "model",
    "Model": "model",
    "StencilSamples": "evaluation",
    "evaluate": "evaluation",
    "fit": "fitting",
    "pdf": "evaluation",
    "sample": "evaluation",
    "unfolded": "evaluation",
}

__all__ = sorted(_PUBLIC)

__getattr__, __dir__ = lazily(__name__, _PUBLIC)
