"""A highlight on a bump: round under plain normal mapping, anisotropic where facets follow the normal."""

import numpy as np
import pytest

from scratchwarp import image
from scratchwarp.pipelines import deformed_highlights as pipeline


def _elongation(kind, exponents):
    """Ratio of the axes of the highlight on a bump, whose normals fill a disk, lit and seen from along the normal."""
    x, y = np.meshgrid(np.linspace(-0.8, 0.8, 161), np.linspace(-0.8, 0.8, 161))
    inside = x**2 + y**2 < 0.64
    z = np.sqrt(np.maximum(1.0 - x**2 - y**2, 0.0))
    normal = np.where(inside[..., None], np.stack([x, y, z], axis=-1), (0.0, 0.0, 1.0)).reshape(-1, 3)
    up = np.broadcast_to((0.0, 0.0, 1.0), normal.shape)
    # a half vector a little off the pole, so that Eq. 2 has an azimuth to take its exponent by
    wi = up + np.array([0.02, 0.02, 0.0])
    wi = wi / np.linalg.norm(wi, axis=-1, keepdims=True)
    value = pipeline.reflectance(kind, wi, up, normal, exponents).reshape(x.shape) * inside
    mean = [np.sum(value * a) / value.sum() for a in (x, y)]
    wide = [np.sqrt(np.sum(value * (a - m) ** 2) / value.sum()) for a, m in zip((x, y), mean, strict=True)]
    return max(wide) / min(wide)


def test_highlights_stay_anisotropic_on_bumps():
    """Exponents 40 and 360: three times as wide as high, by the square root of their ratio."""
    assert _elongation("plain", (40.0, 360.0)) == pytest.approx(1.0, abs=0.03)
    # D(0; n) = D0(-n / (1 + |n|)): what is wide is stretched, so more than 3
    assert 3.0 < _elongation("deformed", (40.0, 360.0)) < 4.5
    assert _elongation("deformed", (100.0, 100.0)) == pytest.approx(1.0, abs=0.03)


def test_a_flat_map_changes_nothing():
    rng = np.random.default_rng(0)
    w = rng.normal(size=(2, 200, 3))
    w[..., 2] = np.abs(w[..., 2])
    wi, wo = w / np.linalg.norm(w, axis=-1, keepdims=True)
    flat = np.broadcast_to((0.0, 0.0, 1.0), wi.shape)
    smooth, plain, deformed = (pipeline.reflectance(kind, wi, wo, flat) for kind in pipeline.KINDS)
    np.testing.assert_allclose(plain, smooth, rtol=2e-3, atol=1e-5)
    np.testing.assert_array_equal(deformed, smooth)


def test_pictures(tmp_path, capsys):
    """Three balls over three; the lamp's highlight is broken up by the map, and nothing is not a number."""
    assert pipeline.main([str(tmp_path), "--size", "24", "--samples", "4"]) == 0
    for name in pipeline.MAPS:
        pixels = image.read_texture(tmp_path / f"anisotropy_{name}.png")[..., :3]
        assert pixels.shape == (48, 72, 3)
        smooth, plain, deformed = (pixels[:24, 24 * i :][:, :24] for i in range(3))
        assert all(part.max() > 0.3 for part in (smooth, plain, deformed))
        assert np.abs(plain - deformed).max() > 0.05 and np.abs(smooth - deformed).max() > 0.05
    assert pipeline.main([str(tmp_path), "--size", "2"]) == 1 and "size" in capsys.readouterr().err
