"""The demo stages of materials, patterns and the zoom: what they promise about themselves."""

import numpy as np
import pytest

import scratchwarp as sw
from scratchwarp.pipelines import author_demo, demo_materials, demo_zoom


@pytest.mark.parametrize("name", sorted(demo_materials.TABLE_1))
def test_materials_ask_for_64_samples_and_metals_for_paths(tmp_path, name):
    (path,) = author_demo.author(tmp_path, 0.1, [name])
    scene = sw.read(path)
    assert not scene.warnings
    plan = sw.make_plan(scene)
    assert plan.size == (640, 480) and plan.settings.spp == 64
    assert plan.settings.integrator == ("path" if name in ("gold", "painted") else "direct")
    sets, _, _, width, aspect, covered, _ = demo_materials.TABLE_1[name]
    (layer,) = scene.materials[0].layers
    assert layer.patterns == sets and layer.space == "uv"
    assert layer.depth / layer.width == pytest.approx(aspect, rel=1e-5)
    bare = 1.0
    for sub in plan.layers[0]:
        bare *= 1 - sub.sublayer.coverage
    assert 1 - bare == pytest.approx(covered, abs=1e-3)
    # paint and diffuse terms stay apart: scratches in paint are bare metal, those in clear coats share the colour
    assert plan.layers[0][0].keeps_diffuse == (name in ("plastic", "wood"))


def test_the_grain_of_the_wood_repeats_around_it():
    grain = demo_materials.rings(64)
    step = np.abs(np.diff(grain, axis=1)).max()
    assert np.abs(grain[:, 0] - grain[:, -1]).max() <= 1.5 * step
    assert grain.min() > 0 and grain.max() < 1


def test_the_zoom_flies_four_decades(tmp_path):
    (path,) = author_demo.author(tmp_path, 1.0, ["zoom"])
    # the reader puts the camera at the origin
    far, near = (sw.read(path, frame=f).instances[0].transform[:3, 3] for f in (1, demo_zoom.FRAMES))
    assert np.linalg.norm(far) / np.linalg.norm(near) == pytest.approx(1e4, rel=1e-3)
    assert np.dot(far, near) / np.linalg.norm(far) / np.linalg.norm(near) == pytest.approx(1.0)
