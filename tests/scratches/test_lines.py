"""Regular patterns: their closed form against counting points under the footprint."""

import numpy as np
import pytest
import warp as wp

from scratchwarp.scratches.layer_device import LayerData
from scratchwarp.scratches.lines_device import band_coverage, concentric, linear, spiral

wp.set_module_options({"enable_backward": False})


@wp.kernel
def bands(
    x: wp.array(dtype=wp.float64), extent: wp.float64, pitch: wp.float64, width: wp.float64, out: wp.array(dtype=float)
):
    i = wp.tid()
    out[i] = band_coverage(x[i], extent, pitch, width)


@wp.kernel
def patterns(layer: LayerData, q: wp.array(dtype=wp.vec2d), step: float, out: wp.array2d(dtype=wp.vec3)):
    i = wp.tid()
    one = wp.vec2d(wp.float64(1.0), wp.float64(1.0))
    ax = wp.vec2(step, 0.0)
    ay = wp.vec2(0.0, step)
    a = linear(layer, q[i], one, ax, ay, 0.5)
    out[i, 0] = wp.vec3(a.alpha, a.direction[0], a.direction[1])
    b = concentric(layer, q[i], one, ax, ay, 0.5)
    out[i, 1] = wp.vec3(b.alpha, b.direction[0], b.direction[1])
    c = spiral(layer, q[i], one, ax, ay, 0.5)
    out[i, 2] = wp.vec3(c.alpha, c.direction[0], c.direction[1])


@pytest.mark.parametrize("extent", [0.0, 1e-3, 0.4, 3.7, 250.0])
def test_band_coverage_counts_points(extent):
    """20,000 points over the footprint resolve an edge to extent / 20,000: two edges and the partial bands."""
    rng = np.random.default_rng(2)
    x = rng.uniform(-1e4, 1e6, 50)
    out = wp.zeros(50, dtype=float, device="cpu")
    wp.launch(bands, dim=50, inputs=[wp.array(x, dtype=wp.float64, device="cpu"), extent, 3.0, 1.2, out], device="cpu")
    points = x[:, None] + extent * ((np.arange(20000) + 0.5) / 20000 - 0.5)
    counted = (np.mod(points, 3.0) < 1.2).mean(1)
    assert np.abs(out.numpy() - counted).max() < 2e-4 + 1e-4 * extent / 3.0


def layer(**fields):
    d = LayerData()
    d.cos_a, d.sin_a = np.cos(0.3), np.sin(0.3)
    d.pitch, d.width = 2.0, 0.6
    d.center = wp.vec2d(0.0, 0.0)
    d.offset = wp.vec2d(0.0, 0.0)
    return d


def test_directions_lie_along_the_lines_and_coverage_is_constant_along_them():
    rng = np.random.default_rng(4)
    q = rng.uniform(-50, 50, (200, 2))

    def run(points, step):
        out = wp.zeros((200, 3), dtype=wp.vec3, device="cpu")
        wp.launch(
            patterns, dim=200, inputs=[layer(), wp.array(points, dtype=wp.vec2d, device="cpu"), step, out], device="cpu"
        )
        return out.numpy()

    here = run(q, 0.0)
    assert set(np.unique(here[:, :, 0])) <= {0.0, 1.0}
    direction = here[:, :, 1:]
    assert np.allclose(np.linalg.norm(direction, axis=-1), 1.0, atol=1e-6)
    assert np.allclose(direction[:, 0], [np.cos(0.3), np.sin(0.3)], atol=1e-6)
    radial = q / np.linalg.norm(q, axis=1, keepdims=True)
    assert np.abs((direction[:, 1] * radial).sum(1)).max() < 1e-6
    # a step of 1e-3 pitch along a line of curvature 1 / r leaves it by step^2 / (2 r): nothing for all but edges
    for k in range(3):
        moved = run(q + 2e-3 * direction[:, k], 0.0)
        assert (moved[:, k, 0] != here[:, k, 0]).mean() < 0.02


def test_far_away_every_pattern_covers_width_over_pitch():
    """A footprint of 100 pitches holds at most one partial band at either end: error below 0.6 / 200 each."""
    q = np.random.default_rng(5).uniform(5e3, 9e3, (200, 2))
    out = wp.zeros((200, 3), dtype=wp.vec3, device="cpu")
    wp.launch(patterns, dim=200, inputs=[layer(), wp.array(q, dtype=wp.vec2d, device="cpu"), 200.0, out], device="cpu")
    assert np.abs(out.numpy()[:, :, 0] - 0.3).max() < 0.006
