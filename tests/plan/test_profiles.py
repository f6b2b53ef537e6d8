"""From an authored profile and a layer's size to the cross-section that is simulated."""

import numpy as np
import pytest

from scratchwarp.plan.profiles import cross_section
from scratchwarp.scene import Layer, Profile


def made(width=10.0, depth=4.0, **fields):
    record = Profile(path="/mat/p", **fields)
    return cross_section(record, Layer(name="a", prim="/mat", profile=record, width=width, depth=depth))


def test_the_aspect_of_the_layer_scales_the_shape():
    np.testing.assert_allclose(made(shape="vGroove").points, [[0, 0], [0.5, -0.4], [1, 0]])
    points = [[0.0, 0.0], [0.2, -1.0], [1.0, 0.1]]
    np.testing.assert_allclose(
        made(shape="points", points=points, periodic=True).points, [[0, 0], [0.2, -0.4], [1, 0.04]]
    )


def test_authored_parameters_reach_the_shape():
    np.testing.assert_allclose(made(shape="vGroove", parameters=(("apex", 0.3),)).points[1], [0.3, -0.4])
    trapezoid = made(shape="trapezoid", parameters=(("floorWidth", 0.2), ("apex", 0.25)))
    np.testing.assert_allclose(trapezoid.points, [[0, 0], [0.2, -0.4], [0.4, -0.4], [1, 0]])
    assert made(shape="gaussian", parameters=(("sigma", 0.1),)).token != made(shape="gaussian").token


def test_parameters_of_other_shapes_do_not_matter():
    """A stage gives every shape the schema's value of every parameter."""
    every = (("apex", 0.3), ("floorWidth", 0.2), ("sigma", 0.1))
    assert made(shape="round", parameters=every).token == made(shape="round").token


def test_rims_stand_on_a_skewed_groove_as_on_a_straight_one():
    skewed = made(shape="vGroove", rim=0.2, parameters=(("apex", 0.3),)).points
    straight = made(shape="vGroove", rim=0.2).points
    assert skewed[:, 1].max() == pytest.approx(straight[:, 1].max()) == pytest.approx(0.08, rel=0.01)
    # the groove has the middle half to itself: its apex lies at 0.25 + 0.3 / 2
    assert skewed[skewed[:, 1].argmin()] == pytest.approx([0.4, -0.4])


def test_periodic_or_alone():
    assert made(shape="round").isolated and not made(shape="round", periodic=True).isolated


def test_width_0_is_flat_ground_and_bad_values_name_the_prim():
    assert made(width=0.0, shape="round").points[:, 1].tolist() == [0, 0]
    with pytest.raises(ValueError, match=r"/mat/p \(for /mat layer 'a'\): apex"):
        made(shape="vGroove", parameters=(("apex", 1.5),))
