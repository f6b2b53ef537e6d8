"""The lines drawn on a surface run as the layer's scratches do."""

import numpy as np
import pytest

from scratchwarp.viewers import directions
from scratchwarp.viewers.colors import shown

# Float64 throughout, a handful of operations: 1e-9 is far above rounding and far below any wrong convention.
EXACT = 1e-9


def unit_lines(scene, count=200):
    lines = directions.segments(scene, shown(scene)[0], count)
    along = lines[:, 1] - lines[:, 0]
    return lines.mean(1), along / np.linalg.norm(along, axis=1, keepdims=True)


@pytest.mark.parametrize("angle", [0.0, 0.4, np.pi / 2, -1.1])
def test_parallel_lines_lie_at_their_angle_from_u(make_scene, make_layer, angle):
    """u is +x on the square, so a line at an angle has the slope of that angle."""
    _, along = unit_lines(make_scene((make_layer(distribution="linear", angle=angle),)))
    assert np.abs(along - [np.cos(angle), np.sin(angle), 0.0]).max() < EXACT


def test_angles_turn_counter_clockwise_seen_from_outside_under_a_mirror(make_scene, make_layer):
    """A negative scale in x turns u round; the outside stays +z, from where the angle still counts the same way."""
    angle = 0.3
    scene = make_scene((make_layer(distribution="linear", angle=angle),), transform=np.diag([-1.0, 1.0, 1.0, 1.0]))
    _, along = unit_lines(scene)
    u, n = np.array([-1.0, 0, 0]), np.array([0, 0, 1.0])
    assert np.abs(along - (np.cos(angle) * u + np.sin(angle) * np.cross(n, u))).max() < EXACT


@pytest.mark.parametrize("distribution", ["concentric", "spiral"])
def test_circles_run_around_their_center(make_scene, make_layer, distribution):
    """The line through a point is perpendicular to the way to the center, here at uv (0.75, 0.5), which is x = 0.5."""
    at, along = unit_lines(make_scene((make_layer(distribution=distribution, center=(0.75, 0.5)),)))
    away = at - [0.5, 0.0, 0.0]
    assert np.abs((away * along).sum(1) - away[:, 2] * along[:, 2]).max() < EXACT


def test_spread_stays_within_half_of_itself_either_way(make_scene, make_layer):
    """Angles fill the range of the spread and do not leave it."""
    _, along = unit_lines(make_scene((make_layer(distribution="random", angle=0.5, angle_spread=0.8),)), 2000)
    turn = np.arctan2(along[:, 1], along[:, 0]) - 0.5
    assert np.abs(turn).max() <= 0.4 + EXACT and np.ptp(turn) > 0.75


def test_lines_of_a_layer_stay_on_its_material(make_scene, make_layer):
    """Middles lie on the square (lifted by two thousandths of its size); a layer of explicit curves has no lines."""
    scene = make_scene((make_layer(distribution="worley"),))
    at, _ = unit_lines(scene)
    assert np.abs(at[:, :2]).max() <= 1.0 and np.abs(at[:, 2]).max() < 0.01
    explicit = make_scene((make_layer(distribution="curves"),))
    assert len(directions.segments(explicit, shown(explicit)[0], 10)) == 0


def test_no_more_lines_than_scratches(make_scene, make_layer):
    """200 um by 0.5 m over 4 square metres at density 1e-5 a square millimetre: 40 scratches, whatever is asked for."""
    layer = make_layer(distribution="random", density=1e-5, width=200.0, length=5e5)
    scene = make_scene((layer,))
    assert len(directions.segments(scene, shown(scene)[0], 1000)) == 40
    # the same amount as coverage: 1 - exp(-density * width * length) with width * length = 100 mm^2
    sparse = make_layer(distribution="random", coverage=1 - np.exp(-1e-3), width=200.0, length=5e5)
    assert directions.number(sparse, 4.0) in (40, 41)  # rounded up
