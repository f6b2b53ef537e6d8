"""Scratch maps: seamless, engraved, as deep and as directed as asked."""

import numpy as np
import pytest

from scratchwarp import mdf


def test_normals_are_unit_and_outward():
    m = mdf.scratch_map(128, density=50, width=0.02, depth=0.6)
    assert m.shape == (128, 128, 3) and m.dtype == np.float32
    np.testing.assert_allclose(np.linalg.norm(m, axis=-1), 1.0, atol=1e-6)
    assert np.all(m[..., 2] > 0) and np.any(m[..., 2] < 0.8)


def test_a_gradient_on_a_torus_has_no_mean():
    """The slopes of a height without seams sum to 0 over a tile; a seam would leave its step."""
    m = mdf.scratch_map(512, density=6, width=0.2, length=0.3, depth=0.2, seed=5).astype(float)
    slope = -m[..., :2] / m[..., 2:]
    # pits have a rim where the slope jumps: each column of pixels across it is off by at most slope * pixel
    assert np.all(np.abs(slope.mean(axis=(0, 1))) < 0.01 * np.abs(slope).max())
    assert np.any(m[0, :, 2] < 1) and np.any(m[:, 0, 2] < 1), "no pit crosses the edge: choose another seed"


def test_hemisphere():
    """One round pit: the normals are those of a sphere of the radius that its width and depth give."""
    m = mdf.scratch_map(256, density=1, length=0.4, width=0.4, depth=0.25, variation=0.0, seed=14).astype(float)
    dug = m[..., 2] < 1 - 1e-6
    # cap of half-width 0.2 and depth 0.1: R = (0.2^2 + 0.1^2) / 0.2 = 0.25, steepest normal sin = 0.2 / 0.25
    assert abs(np.linalg.norm(m[dug][:, :2], axis=-1).max() - 0.8) < 0.02
    np.testing.assert_allclose(dug.mean(), np.pi * 0.2**2, rtol=0.01)
    rows, columns = np.nonzero(dug)
    # normals of a pit lean towards its centre: x against the columns, y (upwards) along the rows
    assert np.corrcoef(columns, m[dug][:, 0])[0, 1] < -0.9
    assert np.corrcoef(rows, m[dug][:, 1])[0, 1] > 0.9


@pytest.mark.parametrize("angle", [0.0, 0.6, 2.0])
def test_directed_scratches_tilt_normals_across_them(angle):
    m = mdf.scratch_map(256, density=80, width=0.02, length=0.5, direction=angle, depth=0.3).astype(float)
    x, y = m[..., 0], m[..., 1]
    across = np.mean((y * np.cos(angle) - x * np.sin(angle)) ** 2)
    along = np.mean((x * np.cos(angle) + y * np.sin(angle)) ** 2)
    assert along < 0.02 * across


def test_options():
    np.testing.assert_array_equal(mdf.scratch_map(64, seed=5), mdf.scratch_map(64, seed=5))
    assert np.any(mdf.scratch_map(64, seed=5) != mdf.scratch_map(64, seed=6))
    np.testing.assert_array_equal(
        mdf.scratch_map((8, 16), density=0), np.broadcast_to(np.float32([0, 0, 1]), (8, 16, 3))
    )
    np.testing.assert_array_equal(mdf.scratch_map(8, depth=0.0)[..., 2], 1.0)
    shallow, deep = (mdf.scratch_map(128, width=0.05, depth=d)[..., 2].min() for d in (0.1, 0.4))
    assert deep < shallow
    few, many = (np.mean(mdf.scratch_map(128, density=d, width=0.02)[..., 2] < 1) for d in (20, 200))
    assert many > 4 * few


def test_bad_input_is_named():
    for name, value in (("width", 0.0), ("depth", -1.0), ("density", np.nan), ("variation", 2.0), ("resolution", 0)):
        with pytest.raises(ValueError, match=name):
            mdf.scratch_map(**{"resolution": 16, name: value})
