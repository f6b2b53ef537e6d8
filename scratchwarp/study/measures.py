"""How far one image is from another: relative mean square error, and FLIP where it is installed.

relMSE = mean over pixels and channels of (x - r)^2 / (Y(r)^2 + 0.01 m^2), Y the reference's luminance and m its mean
over the image, which keeps black pixels from counting without end and makes the exposure cancel. (Rousselle, Knaus,
Zwicker 2012 divide by r^2 + 0.01.) FLIP: Andersson and others 2020, of the images as sRGB shows them.
"""

from typing import Any

import numpy as np

FLOOR = 0.01
_LUMINANCE = np.array([0.2126, 0.7152, 0.0722])


def weights(reference: np.ndarray) -> np.ndarray:
    """1 / (Y^2 + 0.01 m^2) of an image [h, w, 3], shape [h, w]; 0 everywhere for a black one."""
    y = np.asarray(reference, np.float64) @ _LUMINANCE
    floor = FLOOR * float(y.mean()) ** 2
    return 1.0 / (y**2 + floor) if floor > 0.0 else np.zeros_like(y)


def rel_mse(found: np.ndarray, reference: np.ndarray) -> float:
    """Relative mean square error of linear images [h, w, 3]."""
    off = (np.asarray(found, np.float64) - reference) ** 2
    return float((off.mean(axis=-1) * weights(reference)).mean())


def uncertainty(found: np.ndarray, reference: np.ndarray) -> float:
    """Standard error of ``rel_mse`` as a mean over pixels: great where few of them carry most of it."""
    off = ((np.asarray(found, np.float64) - reference) ** 2).mean(axis=-1) * weights(reference)
    return float(off.std() / np.sqrt(off.size))


def shown(image: np.ndarray) -> np.ndarray:
    """Linear Rec.709 as sRGB in [0, 1], what is brighter cut off."""
    x = np.clip(np.asarray(image, np.float32), 0.0, 1.0)
    return np.where(x <= 0.0031308, 12.92 * x, 1.055 * x ** (1.0 / 2.4) - 0.055).astype(np.float32)


def flip(found: np.ndarray, reference: np.ndarray) -> float | None:
    """Mean FLIP of linear images [h, w, 3]; None where flip-evaluator is not installed."""
    library = _library()
    if library is None:
        return None
    return float(library.evaluate(shown(reference), shown(found), "LDR", applyMagma=False)[1])


def _library() -> Any:
    try:
        import flip_evaluator
    except ImportError:
        return None
    return flip_evaluator
