"""How far two BRDFs, unfolded into images, are from one another."""

from typing import Any

import numpy as np

_LUMINANCE = np.array([0.2126, 0.7152, 0.0722])
_TO_XYZ = np.array(
    [[0.4124564, 0.3575761, 0.1804375], [0.2126729, 0.7151522, 0.0721750], [0.0193339, 0.1191920, 0.9503041]]
)
_SIDE, _SIGMA = 11, 1.5  # of the window of SSIM


def compare(a: Any, b: Any) -> dict[str, float]:
    """Differences of ``b`` from the reference ``a``: ``Brdf`` or images [h, w, 3] of linear Rec.709, h and w >= 11.

    ``delta_e``: mean CIE 1976 colour difference under D65; ``rmse``: root of the mean square over all values;
    ``psnr`` [dB]: with the maximum of the reference for peak, inf for equal images; ``ssim``: mean structural
    similarity of luminance, Gaussian window 11 x 11 of sigma 1.5, range the maximum of the reference's luminance.
    Raises ValueError naming the argument.
    """
    first, second = _image("a", a), _image("b", b)
    if first.shape != second.shape:
        raise ValueError(f"b must have the shape of a, {list(first.shape)}, got {list(second.shape)}")
    rmse = float(np.sqrt(np.mean((first - second) ** 2)))
    peak = float(first.max())
    if rmse == 0.0:
        psnr = float("inf")
    else:
        psnr = 20.0 * float(np.log10(peak / rmse)) if peak > 0.0 else float("-inf")
    delta_e = float(np.mean(np.linalg.norm(lab(first) - lab(second), axis=-1)))
    return {"delta_e": delta_e, "rmse": rmse, "psnr": psnr, "ssim": _ssim(luminance(first), luminance(second))}


def _image(name: str, values: Any) -> np.ndarray:
    image = np.asarray(values, np.float64)
    if image.ndim != 3 or image.shape[-1] != 3 or min(image.shape[:2]) < _SIDE:
        raise ValueError(f"{name} must have shape [h, w, 3] with h and w of {_SIDE} or more, got {list(image.shape)}")
    if not np.all(np.isfinite(image)):
        raise ValueError(f"{name} must be finite, got {image[~np.isfinite(image)][0]}")
    return image


def luminance(rgb: np.ndarray) -> np.ndarray:
    """Luminance [...] of linear Rec.709 [..., 3]."""
    return rgb @ _LUMINANCE


def lab(rgb: np.ndarray) -> np.ndarray:
    """CIE L*a*b* [..., 3] of linear Rec.709, white at (1, 1, 1)."""
    t = np.maximum(rgb, 0.0) @ _TO_XYZ.T / _TO_XYZ.sum(axis=1)
    f = np.where(t > (6.0 / 29.0) ** 3, np.cbrt(t), t * (29.0 / 6.0) ** 2 / 3.0 + 4.0 / 29.0)
    return np.stack(
        [116.0 * f[..., 1] - 16.0, 500.0 * (f[..., 0] - f[..., 1]), 200.0 * (f[..., 1] - f[..., 2])], axis=-1
    )


def _ssim(a: np.ndarray, b: np.ndarray) -> float:
    """Wang et al. 2004 over all windows that lie inside the images."""
    at = np.arange(_SIDE) - _SIDE // 2
    window = np.exp(-0.5 * (at / _SIGMA) ** 2)
    window /= window.sum()

    def mean(image: np.ndarray) -> np.ndarray:
        rows = np.lib.stride_tricks.sliding_window_view(image, _SIDE, axis=0) @ window
        return np.lib.stride_tricks.sliding_window_view(rows, _SIDE, axis=1) @ window

    scale = float(a.max())
    if scale <= 0.0:
        return float(np.array_equal(a, b))
    a, b = a / scale, b / scale
    mean_a, mean_b = mean(a), mean(b)
    var_a, var_b = mean(a * a) - mean_a**2, mean(b * b) - mean_b**2
    cross = mean(a * b) - mean_a * mean_b
    top = (2.0 * mean_a * mean_b + 1e-4) * (2.0 * cross + 9e-4)
    return float(np.mean(top / ((mean_a**2 + mean_b**2 + 1e-4) * (var_a + var_b + 9e-4))))
