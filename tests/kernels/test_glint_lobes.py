"""The tabulated lobe of facets against their Fourier transform, for all sizes and wavelengths."""

import numpy as np
import pytest
import warp as wp

from scratchwarp.kernels.glint_across_device import across_value
from scratchwarp.kernels.glint_arrays_device import GlintArrays, Strand, WaveLayer
from scratchwarp.kernels.glint_tables import MOST_LOBES, lobe_table

wp.set_module_options({"enable_backward": False})

X = np.linspace(0.0, 1.0, 65)
PROFILES = {
    "sine": np.stack([X, 0.5 * np.cos(2.0 * np.pi * X) - 0.5], 1),
    "box": np.array([[0.0, 0.0], [0.0, -1.0], [1.0, -1.0], [1.0, 0.0]]),
    "lopsided": np.array([[0.0, 0.0], [0.2, -1.0], [1.0, 0.0]]),
}


@wp.kernel
def values(a: GlintArrays, layer: WaveLayer, strand: Strand, given: wp.array(dtype=wp.vec3),
           out: wp.array(dtype=float)):  # fmt: skip
    t = wp.tid()
    out[t] = across_value(a, layer, strand, given[t][0], given[t][1], given[t][2])


@pytest.mark.parametrize("name", PROFILES)
def test_the_lobe_of_facets_is_tabulated(name):
    """Cubic interpolation of 16 places a cycle: (2 pi / 16)^4 3 / 128 = 6e-4 of the finest cycles, of which the lobe
    has few; 1e-3 of the greatest value bounds both arguments."""
    points = PROFILES[name]
    rows = np.concatenate([0.5 * (points[1:] + points[:-1]) - (0.5, 0.0), np.diff(points, axis=0)], 1)
    table, first = lobe_table(rows, 2.0 * 3.0 / 0.4, 2.0 * 1.0 / 0.4)
    layer, strand, a = WaveLayer(), Strand(), GlintArrays()
    layer.facets, strand.width, strand.depth = len(rows), 3.0, 1.0
    a.outlines = wp.array(rows, dtype=wp.vec4d, device="cpu")
    rng = np.random.default_rng(3)
    n = 4000
    given = np.stack([rng.uniform(0.4, 0.75, n), rng.uniform(-2.0, 2.0, n), rng.uniform(0.0, 2.0, n)], 1)
    held = wp.array(given.astype(np.float32), dtype=wp.vec3, device="cpu")

    def asked():
        out = wp.zeros(n, dtype=float, device="cpu")
        wp.launch(values, n, [a, layer, strand, held], [out], device="cpu")
        return out.numpy()

    exact = asked()
    a.lobes = wp.array(table.ravel(), dtype=float, device="cpu")
    layer.lobe_depths, layer.lobe_reaches = table.shape
    layer.lobe_first, layer.lobe_even = first, int(name != "lopsided")
    tabled = asked()
    assert (tabled != exact).mean() > 0.9
    np.testing.assert_allclose(tabled, exact, atol=1e-3 * exact.max())
    # beyond the table as before
    strand.width = 9.0
    beyond = np.abs(given[:, 1]) * 9.0 / given[:, 0] > 2.0 * 3.0 / 0.4 + 0.5
    wide = asked()
    layer.lobe_depths = 0
    np.testing.assert_array_equal(wide[beyond], asked()[beyond])


def test_too_large_a_table_is_not_made():
    rows = np.array([[0.0, -1.0, 1.0, 0.0]])
    assert lobe_table(rows, 1e9, 1e9) is None
    assert lobe_table(rows, 1.0, MOST_LOBES) is None
