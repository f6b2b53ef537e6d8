"""How far two images are apart: relative mean square error, FLIP, and a boosted difference."""

import numpy as np

EPSILON = 0.01


def check_pair(reference: np.ndarray, other: np.ndarray) -> None:
    """ValueError unless both are [h, w, 3] of one size without a NaN or an infinity."""
    if reference.shape != other.shape or reference.ndim != 3 or reference.shape[2] != 3:
        raise ValueError(f"the images are {list(reference.shape)} and {list(other.shape)}; both must be one [h, w, 3]")
    for name, pixels in (("first", reference), ("second", other)):
        if not np.isfinite(pixels).all():
            row, column = np.argwhere(~np.isfinite(pixels).all(axis=-1))[0]
            raise ValueError(f"the {name} image is not finite at pixel x {column}, y {row}")


def relative_mse(reference: np.ndarray, other: np.ndarray) -> float:
    """Mean over pixels and channels of (b - a)^2 / (a^2 + 0.01), a the reference (Rousselle et al. 2011, equation 5).

    ``reference``, ``other``: linear Rec.709 [h, w, 3].
    """
    check_pair(reference, other)
    a, b = reference.astype(np.float64), other.astype(np.float64)
    return float(np.mean((b - a) ** 2 / (a**2 + EPSILON)))


def flip(reference: np.ndarray, other: np.ndarray) -> tuple[np.ndarray, float] | None:
    """FLIP's error map, in the colours of its paper as linear Rec.709 [h, w, 3], and its mean; None without the
    package flip-evaluator (extra ``study``).

    Linear images in [0, 1] are shown as sRGB and compared as such; those that go beyond by FLIP for high dynamic range.
    """
    check_pair(reference, other)
    try:
        import flip_evaluator
    except ImportError:
        return None
    a, b = (np.ascontiguousarray(np.maximum(pixels, 0.0), np.float32) for pixels in (reference, other))
    within = max(float(a.max()), float(b.max())) <= 1.0
    pair = (_srgb(a), _srgb(b), "LDR") if within else (a, b, "HDR")
    shown, mean, _ = flip_evaluator.evaluate(*pair)
    return _linear(np.asarray(shown, np.float32)), float(mean)


def boosted(reference: np.ndarray, other: np.ndarray, factor: float = 8.0) -> np.ndarray:
    """``factor`` times the absolute difference, float32 [h, w, 3]."""
    check_pair(reference, other)
    return (factor * np.abs(other.astype(np.float64) - reference)).astype(np.float32)


def _srgb(linear: np.ndarray) -> np.ndarray:
    low = linear * 12.92
    return np.where(linear <= 0.0031308, low, 1.055 * np.maximum(linear, 1e-9) ** (1 / 2.4) - 0.055).astype(np.float32)


def _linear(srgb: np.ndarray) -> np.ndarray:
    return np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4).astype(np.float32)
