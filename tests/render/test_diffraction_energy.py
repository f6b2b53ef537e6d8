"""What diffracting scratches take from the base and return: never more than arrives, for any density and depth."""

import numpy as np
import pytest
import warp as wp

from scratchwarp.kernels.glint_arrays_device import GlintArrays, WaveLayer
from scratchwarp.kernels.glint_energy_device import BINS, COLUMNS
from scratchwarp.kernels.glint_tables import SHARES, depth_shares
from scratchwarp.reflectance.diffraction.color import spectral_samples

from .glint_kernels import balances

DEEPEST = 6.0
FINE, WEIGHTS = spectral_samples(4096)


def balanced(areas, depths, parts=None):
    """(left [n, 3], shared [n, 3], sums [n, COLUMNS]) of rows of strands."""
    areas, depths = (np.ascontiguousarray(x, np.float32) for x in (areas, depths))
    parts = np.ones_like(areas) if parts is None else np.ascontiguousarray(parts, np.float32)
    a, layer = GlintArrays(), WaveLayer()
    a.shares = wp.array(depth_shares(DEEPEST, 0.0, None), dtype=float, device="cpu")
    a.share_colors = wp.array(spectral_samples(BINS)[1].astype(np.float32), dtype=wp.vec3, device="cpu")
    layer.share_count, layer.share_step = SHARES, DEEPEST / (SHARES - 1)
    rows = [wp.array(x, dtype=float, device="cpu") for x in (areas, parts, depths)]
    left, shared = (wp.zeros(len(areas), dtype=wp.vec3, device="cpu") for _ in range(2))
    sums = wp.zeros((len(areas), COLUMNS), dtype=float, device="cpu")
    wp.launch(balances, len(areas), inputs=[a, layer, *rows, left, shared, sums], device="cpu")
    return left.numpy().astype(float), shared.numpy().astype(float), sums.numpy().astype(float)


def test_no_density_and_no_depth_makes_light():
    """2,000 rows of up to 30 strands, each of any share of the area up to all of it and any depth: base and scratches
    return at most 1 in every channel (1e-6 for float32), and neither is negative."""
    rng = np.random.default_rng(1)
    areas = 10.0 ** rng.uniform(-4, 0, (2000, 30)) * (rng.random((2000, 30)) < rng.random((2000, 1)))
    left, shared, sums = balanced(areas, rng.uniform(0.0, DEEPEST, areas.shape))
    back = left + shared * np.maximum(sums[:, BINS:], 0.0)
    assert left.min() >= 0.0 and left.max() <= 1.0 + 1e-6
    assert shared.min() >= 0.0 and shared.max() <= 1.0 + 1e-6
    assert back.max() <= 1.0 + 1e-5
    # nearly all of it: colours so pure that they have nothing in a channel aside
    assert np.median(back) == pytest.approx(1.0, abs=1e-5)


def test_base_has_its_weight_at_every_wavelength():
    """One scratch, then two at random, against 4,096 wavelengths: 1 - a |D|^2, and the product of both. |D|^2 is
    linear between depths 6 nm apart: 0.5 % of a |D|^2 <= 0.48; what two do to each other, a b |D D|^2 <= 0.23, is
    averaged over 16 parts of the spectrum: an eighth of it at worst."""
    rng = np.random.default_rng(2)
    areas, depths = rng.uniform(0.0, 0.12, (400, 2)), rng.uniform(0.0, DEEPEST, (400, 2))
    d2 = 4.0 * np.sin(2.0 * np.pi * depths[..., None] / (FINE * 1e-3)) ** 2
    one, two = 1.0 - areas[:, :1] * d2[:, 0], (1.0 - areas[..., None] * d2).prod(1)
    for rows, keep, within in ((areas * [1.0, 0.0], one, 3e-3), (areas, two, 3e-2)):
        left, _, _ = balanced(rows, depths)
        expected = keep @ WEIGHTS
        inside = (expected > 0.0).all(1) & (expected < 1.0).all(1)
        assert inside.mean() > 0.9
        assert np.median(np.abs(left[inside] - expected[inside])) < 2e-3
        np.testing.assert_allclose(left[inside], expected[inside], atol=within)


def test_pieces_of_a_line_take_what_it_would():
    """Cut in three, wherever: the same (float32)."""
    rng = np.random.default_rng(3)
    area, depth = rng.uniform(0.0, 0.3, 100), rng.uniform(0.0, DEEPEST, 100)
    cuts = np.sort(rng.random((100, 2)), axis=1)
    parts = np.stack([cuts[:, 0], cuts[:, 1] - cuts[:, 0], 1.0 - cuts[:, 1]], axis=1)
    whole = balanced(area[:, None], depth[:, None])
    split = balanced(np.repeat(area[:, None], 3, 1), np.repeat(depth[:, None], 3, 1), parts)
    for one, three in zip(whole, split, strict=True):
        np.testing.assert_allclose(three, one, atol=1e-5)


def test_invisible_scratches_take_nothing():
    """Half wavelengths deep where the eye sees: at 550 nm, and next to nothing of the light around it."""
    shares = depth_shares(DEEPEST, 0.0, None)[:, :BINS]
    assert shares[0].max() == 0.0 and shares.min() >= 0.0
    row = shares[round(0.275 / DEEPEST * (SHARES - 1))]
    at = 1.0 / (1.0 / 380.0 + (np.arange(BINS) + 0.5) / BINS * (1.0 / 780.0 - 1.0 / 380.0))
    nearest = row[np.argsort(np.abs(1.0 / at - 1.0 / 550.0))]
    assert nearest[0] < 0.05 < 1.0 < row.max()
