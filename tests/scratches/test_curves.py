"""Explicit curves: area covered on a surface against the strips' own area, in both spaces."""

import numpy as np
import pytest
import warp as wp

from scratchwarp.scene import Curves
from scratchwarp.scratches import curves as host
from scratchwarp.scratches.curves_device import CurveHit, SegmentArrays, curves, drawn_curve
from scratchwarp.scratches.layer_device import LayerData

wp.set_module_options({"enable_backward": False})


@wp.kernel
def look(
    segments: SegmentArrays,
    layer: LayerData,
    p: wp.array(dtype=wp.vec3),
    step: float,
    size: float,
    alpha: wp.array(dtype=float),
    direction: wp.array(dtype=wp.vec3),
):
    i = wp.tid()
    du = wp.vec3(size, 0.0, 0.0)
    dv = wp.vec3(0.0, size, 0.0)
    uv = wp.vec2d(wp.float64(p[i][0] / size), wp.float64(p[i][1] / size))
    j = step / size
    hit = curves(
        segments,
        layer,
        p[i],
        wp.vec3(0.0, 0.0, 1.0),
        uv,
        du,
        dv,
        wp.vec3(step, 0.0, 0.0),
        wp.vec3(0.0, step, 0.0),
        wp.vec2(j, 0.0),
        wp.vec2(0.0, j),
        0.5,
    )
    alpha[i] = hit.alpha
    direction[i] = hit.direction


def run(record, p, step, size):
    arrays, (strokes,) = host.pack([record])
    layer = LayerData()
    layer.first, layer.bvh, layer.reach = strokes.first, strokes.bvh.id, strokes.reach
    layer.curve_uv, layer.width_uv = int(strokes.uv), int(strokes.width_uv)
    alpha = wp.zeros(len(p), dtype=float, device="cpu")
    direction = wp.zeros(len(p), dtype=wp.vec3, device="cpu")
    inputs = [arrays, layer, wp.array(p.astype(np.float32), dtype=wp.vec3, device="cpu"), step, size, alpha, direction]
    wp.launch(look, dim=len(p), inputs=inputs, device="cpu")
    return alpha.numpy(), direction.numpy()


def strips(space):
    """Parallel strips 400 um wide, 5 mm apart, on a square of 0.1 m: they cover 8 %."""
    size = 0.1
    y = (np.arange(20) + 0.5) * 5e-3
    ends = np.stack([np.stack([np.zeros(20), y], 1), np.stack([np.full(20, size), y], 1)], 1).reshape(-1, 2)
    points = np.concatenate([ends, np.zeros((40, 1))], 1)
    points = points / size if space == "uv" else points
    return Curves("/c", points, np.full(20, 2), np.full(40, 400.0), np.full(40, 10.0), space)


@pytest.mark.parametrize("space", ["object", "uv"])
@pytest.mark.parametrize("step", [0.0, 1e-4, 2e-3])
def test_mean_coverage_is_the_strips_area(space, step):
    """Points uniform over the inside: binomial at step 0, 5 sigma."""
    rng = np.random.default_rng(0)
    p = np.concatenate([rng.uniform(0.01, 0.09, (20000, 2)), np.zeros((20000, 1))], 1)
    p[:, 1] = rng.uniform(0.01, 0.09, 20000)
    alpha, direction = run(strips(space), p, step, 0.1)
    assert abs(alpha.mean() - 0.08) < 5 * np.sqrt(0.08 * 0.92 / 20000)
    hit = alpha > 0
    assert np.allclose(np.abs(direction[hit]), [1, 0, 0], atol=1e-4)


def test_far_surfaces_are_not_scratched():
    p = np.array([[0.05, 0.0025, 0.2]])
    alpha, _ = run(strips("object"), p, 0.0, 0.1)
    assert alpha[0] == 0.0


def test_single_points_and_zero_widths_make_no_segment():
    record = Curves("/c", np.zeros((3, 3)), np.array([1, 2]), np.ones(3), np.ones(3))
    assert len(host.segments(record)[0]) == 0
    record = Curves("/c", np.eye(3), np.array([3]), np.zeros(3), np.ones(3))
    assert len(host.segments(record)[0]) == 0


@wp.kernel
def drawn(
    segments: SegmentArrays, layer: LayerData, at: wp.array(dtype=float), index: int, out: wp.array(dtype=wp.vec2)
):
    i = wp.tid()
    found = CurveHit()
    found.segment = index
    found.at = at[i]
    hit = drawn_curve(segments, layer, found)
    out[i] = wp.vec2(hit.along, hit.aspect)


def test_a_drawn_segment_knows_its_depth_and_place():
    """Two polylines of lengths 3 and 2 m, depth over width running along them; the second segment of the first."""
    points = np.array([[0, 0, 0], [1, 0, 0], [1, 2, 0], [5, 5, 0], [5, 7, 0]], float)
    widths, depths = np.full(5, 10.0), np.array([1.0, 2.0, 4.0, 5.0, 5.0])
    record = Curves("/c", points, np.array([3, 2]), widths, depths)
    number, run, aspects = host.along(record)
    assert number.tolist() == [0, 0, 1]
    np.testing.assert_allclose(run * 1e-6, [[0, 1], [1, 2], [0, 2]])
    np.testing.assert_allclose(aspects, [[0.1, 0.2], [0.2, 0.4], [0.5, 0.5]])
    arrays, _ = host.pack([record], varied=True)
    layer = LayerData()
    layer.wave = 1e-6
    at = np.array([0.0, 0.25, 1.0], np.float32)
    out = wp.zeros(3, dtype=wp.vec2, device="cpu")
    wp.launch(drawn, dim=3, inputs=[arrays, layer, wp.array(at, dtype=float, device="cpu"), 1, out], device="cpu")
    np.testing.assert_allclose(out.numpy(), [[1.0, 0.2], [1.5, 0.25], [3.0, 0.4]], rtol=1e-5)
    mixed = Curves("/c", points, np.array([3, 2]), widths, depths, "uv", "uv", "um")
    assert (host.along(mixed)[2] == -1.0).all()
