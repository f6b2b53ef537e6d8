"""How far a fitted BRDF is from the measurement, by the libraries that others use: scikit-image where it is installed.

Without it the same metrics come from ``measured.compare``, which agrees with it to 1e-9.
"""

from typing import Any

import numpy as np

from ..reflectance.measured.comparison import compare, lab, luminance


def metrics(reference: np.ndarray, found: np.ndarray) -> dict[str, float]:
    """``delta_e``, ``rmse``, ``psnr`` [dB] and ``ssim`` as ``measured.compare`` defines them, images [h, w, 3]."""
    own = compare(reference, found)
    library = _library()
    if library is None:
        return own
    a, b = np.asarray(reference, np.float64), np.asarray(found, np.float64)
    peak, bright = float(a.max()), float(luminance(a).max())
    if peak <= 0.0 or bright <= 0.0 or own["rmse"] == 0.0:
        return own  # the libraries divide by zero there
    measure, color = library
    return {
        "delta_e": float(np.mean(color.deltaE_cie76(lab(a), lab(b)))),
        "rmse": float(np.sqrt(measure.mean_squared_error(a, b))),
        "psnr": float(measure.peak_signal_noise_ratio(a, b, data_range=peak)),
        "ssim": float(
            measure.structural_similarity(
                luminance(a), luminance(b), data_range=bright, gaussian_weights=True, sigma=1.5,
                use_sample_covariance=False,
            )
        ),
    }  # fmt: skip


def source() -> str:
    """Where the numbers come from, for reports."""
    return "scratchwarp" if _library() is None else "scikit-image"


def _library() -> tuple[Any, Any] | None:
    try:
        from skimage import color, metrics
    except ImportError:
        return None
    return metrics, color
