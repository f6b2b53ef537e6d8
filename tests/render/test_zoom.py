"""Scratches from a tenth of a pixel to ten thousand a pixel: the mean stays, and nothing shimmers."""

from dataclasses import replace

import numpy as np

from scratchwarp.scene import DistantLight

from . import scenes

RATIO, LEVELS = 4, 8  # distances 1, 4, ... 4^7: a little over four decades
NEAREST = 2e-3  # metres; a pixel of the nearest image spans 1 um, a scratch 12 um
SIDE = 32


def look(distance):
    """A camera of a degree's field, straight above the sheet in the plane z = 0."""
    m = np.eye(4)
    m[2, 3] = distance
    return replace(scenes.camera(aperture=20.0, focal=1250.0), transform=m, near=distance / 10, far=distance * 10)


def sheet(**fields):
    """Two directions of V grooves under a lamp of 20 degrees and a dome, which the base and every slope see in part."""
    fields = {
        "width": 12.0,
        "depth": 4.0,
        "length": 400.0,
        "coverage": 0.4,
        "patterns": 3,
        "angle_spread": 1.2,
        **fields,
    }
    material = scenes.scratched(**fields)
    lamp = DistantLight(
        path="/lamp", radiance=np.full(3, 8.0), direction=np.array([0.0, 0.6, -0.8]), angle=np.radians(40.0)
    )
    # the sheet stays in front of the camera at every distance
    return scenes.scene(
        [scenes.plane(40.0)], [material], [lamp, scenes.dome(0.2)], instances=[scenes.place(0, 0)], cam=look(NEAREST)
    )


def shoot(world, distance, seeds, part=1.0):
    """Mean radiance of the middle ``part`` of the image at 16 samples a pixel, and its standard error over seeds."""
    edge = 0.5 * (1 - part)
    world = replace(world, camera=look(distance))
    found = []
    for seed in range(seeds):
        film = scenes.shoot(world, width=SIDE, height=SIDE, seed=seed, crop=(edge, 1 - edge, edge, 1 - edge))
        found.append(film["color"][..., 1].mean(dtype=np.float64))
    return np.mean(found), np.std(found, ddof=1) / np.sqrt(seeds)


def test_a_patch_keeps_its_radiance_over_four_decades_of_distance():
    # The middle quarter of each image is the whole of the one before, nearer by RATIO: the same patch of the surface,
    # so its mean may differ by noise alone, which the seeds show.
    world = sheet()
    wholes = [shoot(world, NEAREST * RATIO**k, 12) for k in range(LEVELS)]
    for k in range(LEVELS - 1):
        near, near_error = wholes[k]
        far, far_error = shoot(world, NEAREST * RATIO ** (k + 1), 128, 1 / RATIO)
        assert abs(far - near) < 0.01 * near + 3 * np.hypot(near_error, far_error), (k, near, far)
        assert np.hypot(near_error, far_error) < 0.01 * near
    # where a pixel holds thousands of scratches, all images have one mean
    levels = np.array(wholes[-3:])
    assert np.ptp(levels[:, 0]) < 0.01 * levels[0, 0] + 3 * levels[:, 1].max()


def test_a_slow_zoom_does_not_shimmer():
    # Temporal metric: the relative root mean square of the second difference of a patch's mean radiance over frames
    # whose distance shrinks by 2 %; a smooth zoom has next to none, beside sqrt(6) times the noise of a frame.
    world = sheet()
    for start in (0.02, 0.5):
        frames = np.array([shoot(world, start * 0.98**k, 4) for k in range(6)])
        trend = np.diff(frames[:, 0], 2)
        noise = np.sqrt(6.0) * frames[:, 1].mean()
        assert np.sqrt(np.mean(trend**2)) < 0.005 * frames[0, 0] + 2 * noise
        assert noise < 0.02 * frames[0, 0]
