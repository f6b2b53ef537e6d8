"""What made a pixel: shares of layers, the frame and lobe of each, the footprint."""

from dataclasses import replace

import numpy as np
import pytest

import scratchwarp as sw
from scratchwarp.render import Session
from scratchwarp.scene import DistantLight, Profile

from . import scenes

SETTINGS = sw.Settings(width=32, height=32, spp=4, filter="box", threads=1, effects=scenes.EVERYTHING)


def facing(*layers, angle=0.0):
    """A square that faces the camera at 6 m, with layers of V grooves at ``angle``, under a sky."""
    material = scenes.scratched(scenes.white_metal(0.3), width=20000.0, depth=8000.0, length=3e5, angle=angle)
    mold = material.layers[0]
    own = tuple(replace(mold, name=name, **fields) for name, fields in layers)
    return scenes.scene([scenes.plane(3.0)], [replace(material, layers=own)], [scenes.dome(1.0)])


def test_shares_belong_to_the_layers_that_made_them():
    """A Lambert scratch that is black takes light away, a covered share of it; one that covers nothing has no share."""
    black = {"material": "diffuse", "diffuse_color": (0.0, 0.0, 0.0), "coverage": 0.5}
    report = Session(facing(("dark", black), ("none", {"coverage": 0.0})), SETTINGS).inspect((16, 16))
    shares = {share.name: share for share in report.layers}
    assert report.prim == "/placed" and report.material == "/mat" and set(shares) == {"dark", "none"}
    # without the scratches a white furnace: radiance 1; with them what is not covered is left of it
    assert sum(shares["dark"].radiance) / 3 == pytest.approx(report.radiance[0] - 1.0, abs=0.05)
    assert shares["none"].radiance == (0.0, 0.0, 0.0) and shares["dark"].lobe == ()
    assert {"scratches", "lights.dome"} <= {name for name, _ in report.effects}
    assert report.radiance == pytest.approx(np.add(np.add(report.base, report.scratches), report.emission), abs=1e-6)


@pytest.mark.parametrize("angle", [0.0, np.pi / 2])
def test_the_lobe_is_that_of_the_layer_s_direction(angle):
    """Left of the middle the viewer stands at theta > 0 of scratches along u, and at phi > 0 of those across it."""
    looking = Session(facing(("fine", {}), angle=angle), SETTINGS)
    report = looking.inspect((8, 16))
    (fine,) = report.layers
    x = 6 * (8.5 - 16) / 32 * 20 / 50
    view = np.arctan2(-x, 6)  # the eye is to the right of the point by -x
    along, across = (view, 0.0) if angle == 0.0 else (0.0, -view)
    # the row of pixels lies half a pixel below the middle: 0.04 degrees
    assert (fine.theta, fine.phi) == pytest.approx((along, across), abs=0.015)
    weights = np.cos(fine.angles) * np.pi / len(fine.angles)
    assert np.dot(fine.lobe, weights) == pytest.approx(1.0, abs=0.02)  # a lossless table's row


def test_the_footprint_is_a_pixel_on_the_surface():
    """A pixel sees 20 / 50 / 32 of the distance, 75 mm at 6 m, longer by 1 / cos where the surface leans."""
    scene = facing(("fine", {}))
    report = Session(scene, SETTINGS).inspect((16, 16))
    assert report.footprint == pytest.approx((75000.0, 75000.0), rel=1e-3)
    assert report.distance == pytest.approx(6.0, abs=0.05)
    lean = np.array([[1, 0, 0], [0, np.sqrt(0.5), -np.sqrt(0.5)], [0, np.sqrt(0.5), np.sqrt(0.5)]])
    leaning = replace(scene, instances=(scenes.place(0, 0, (0, 0, -6), linear=lean),))
    long, short = Session(leaning, SETTINGS).inspect((16, 16)).footprint
    assert long / short == pytest.approx(np.sqrt(2), rel=0.02)


def test_the_sky_has_no_layers_and_outside_is_refused():
    looking = Session(facing(("fine", {})), replace(SETTINGS, width=64, height=32))
    report = looking.inspect((1, 1))
    assert report.prim == report.material == "" and report.layers == () and report.emission == (1.0, 1.0, 1.0)
    for pixel in ((-1, 0), (64, 0), (0, 32)):
        with pytest.raises(ValueError, match="outside the image of 64 x 32"):
            looking.inspect(pixel)


def test_looking_at_a_pixel_changes_nothing():
    """The film goes on to the bits that it would have had, and nothing is built again afterwards."""
    light = DistantLight(path="/sun", radiance=np.ones(3), direction=(0, 0, -1.0))
    scene = replace(facing(("fine", {"profile": Profile("/mat/vee")}), ("more", {"coverage": 0.2})), lights=(light,))
    looking = Session(scene, SETTINGS)
    looking.refine()
    looking.inspect((16, 16))
    assert set(looking.change().seconds) == {"plan"}
    film = None
    while not looking.finished:
        film = looking.refine() or film
    np.testing.assert_array_equal(film["color"], sw.render(scene, sw.make_plan(scene, SETTINGS))["color"])
