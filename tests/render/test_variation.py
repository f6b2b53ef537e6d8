"""Scratches that differ within a layer: their mean is the mean over what they are, resolved or not.

A mirror V groove seen from straight above sends half of the light to each side, by 2 a of the normal, where its walls
slope by a = atan(2 depth / width) up to 30 degrees. Under a sky that is cos^2 of the longitude about the grooves'
direction, a pixel over its covered part is the mean of cos^2(2 a) over the scratches.
"""

import numpy as np
import pytest

import scratchwarp as sw
from scratchwarp.scene import DomeLight, PreviewSurface, Profile, Texture

from . import scenes

BLACK = PreviewSurface(diffuse_color=(0.0, 0.0, 0.0), ior=1.0)
COLUMNS = 512


def sky():
    """cos^2 of the longitude; longitude pi at the left edge, -pi at the right one."""
    longitude = np.pi * (1 - 2 * (np.arange(COLUMNS) + 0.5) / COLUMNS)
    pixels = np.broadcast_to((np.cos(longitude) ** 2)[None, :, None], (4, COLUMNS, 4)).astype(np.float32)
    return DomeLight(path="/sky", radiance=(1, 1, 1), texture=0), (Texture("/sky", np.ascontiguousarray(pixels)),)


def world(light, textures=(), **fields):
    fields = {"distribution": "linear", "width": 40.0, "length": 4000.0, "angle": np.pi / 2, **fields}
    fields = {"depth": 0.15 * fields["width"], "pitch": 2.5 * fields["width"], **fields}
    material = scenes.scratched(BLACK, **fields)
    placed = [scenes.place(at=(0, 0, -6))]
    camera = scenes.camera(focal=5000.0)  # 24 mm of the plane, all rays within 0.12 degrees
    return scenes.scene([scenes.plane()], [material], [light], placed, camera, textures=textures)


def reflected(**fields):
    """(mean radiance over covered share, covered share) under the sky."""
    light, textures = sky()
    settings = fields.pop("settings", {})
    lit = scenes.shoot(world(light, textures, **fields), **settings)["color"].mean(dtype=float)
    covered = scenes.shoot(world(scenes.dome(), **fields), **settings)["color"].mean(dtype=float)
    return lit / covered, covered


def expected(width, depth, power, ratio=0.15):
    """By quadrature over widths and depths; a share of the area goes with width to the power."""
    t = (np.arange(400) + 0.5) / 200 - 1
    w, d = np.meshgrid(1 + width * t, 1 + depth * t, indexing="ij")
    values = np.cos(2 * np.arctan(2 * ratio * d / w)) ** 2
    return float((values * w**power).sum() / (w**power).sum())


@pytest.mark.parametrize(
    ("distribution", "power"), [("linear", 1), ("worley", 2), ("concentric", 1), ("spiral", 1), ("random", 2)]
)
@pytest.mark.parametrize(("width", "depth"), [(0.0, 0.6), (0.2, 0.5)])
def test_unresolved_scratches_reflect_their_mean(distribution, power, width, depth):
    """Noise of 16384 samples drawing one of the tables: sigma of cos^2 below 0.25, so 0.002 each; 3 sigma and 3e-3 for
    bins of 0.7 degrees."""
    fields = {"distribution": distribution, "width_variation": width, "depth_variation": depth}
    if distribution in ("concentric", "spiral"):
        fields |= {"center": (-40.0, 0.5)}  # so far away that they run along v
    if distribution == "random":
        fields |= {"angle_spread": 1e-3}
    found, _ = reflected(**fields)
    assert found == pytest.approx(expected(width, depth, power), abs=0.009)


def test_resolved_lines_reflect_as_the_scratches_they_are():
    """0.75 mm pixels, lines of 0.5 mm: some 14 of them differ from the mean by sigma / sqrt(14) and are the same ones
    all along; 4 layouts bring that to 0.2 / sqrt(56) = 0.027."""
    found = []
    for seed in range(4):
        one, covered = reflected(
            width=300.0, seed=seed, depth_variation=0.6, length=1e5, settings={"width": 24, "height": 8, "spp": 16}
        )
        found.append(one)
        assert covered == pytest.approx(0.4, abs=0.03)
    assert np.std(found) > 0.003  # single scratches are told apart
    assert np.mean(found) == pytest.approx(expected(0.0, 0.6, 1), abs=0.08)


def test_lines_change_smoothly_along_themselves():
    """One line in the image, 8 mm wide: alike all along, or in waves of 12 mm."""
    light, textures = sky()
    fields = {"width": 30000.0, "pitch": 40000.0, "depth_variation": 0.9, "offset": (0.0, 0.2)}
    profiles = []
    for length in (0.0, 12000.0):
        film = scenes.shoot(world(light, textures, **fields, variation_length=length))
        profiles.append(film["color"][..., 0].mean(1))
    alike, waves = profiles
    # a bin and the choice between two tables
    assert np.ptp(alike) < 0.05 and np.ptp(waves) > 0.15
    steps = np.abs(np.diff(waves))
    assert steps.max() < 0.35 * np.ptp(waves)


def test_profiles_change_from_one_to_the_other():
    """From V grooves to flat ground: half the scratches' mean slope; a flat scratch mirrors the sky's cos^2(0) = 1."""
    flat = Profile(path="/mat/flat", shape="flat")
    none, _ = reflected(profile_end=flat, profile_variation=0.0)
    some, _ = reflected(profile_end=flat, profile_variation=1.0)
    assert none == pytest.approx(expected(0.0, 0.0, 1), abs=6e-3)
    # outlines between the two are V grooves of part the depth
    part = (np.arange(1000) + 0.5) / 1000
    assert some == pytest.approx(np.mean(np.cos(2 * np.arctan(0.3 * part)) ** 2), abs=0.012)


def test_the_plan_says_how_many_tables_stand_for_them():
    plan = sw.make_plan(world(scenes.dome(), depth_variation=0.5))
    choice = plan.effects["scratches.variation"]
    assert choice.enabled and choice.prims == ("/mat layer 'fine'",)
    how = plan.layers[0][0].variation
    assert how is not None and len(plan.tables) == how.aspects * how.blends
    off = sw.make_plan(world(scenes.dome(), depth_variation=0.5), sw.Settings(effects={"scratches.variation": False}))
    assert len(off.tables) == 1 and off.layers[0][0].variation is None
    assert not sw.make_plan(world(scenes.dome())).on("scratches.variation")
    assert not any("depthVariation" in w for w in plan.warnings)
