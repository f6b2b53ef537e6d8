"""A small asset: two quads of steel and wood under a light."""

import numpy as np
import pytest

from scratchwarp.pipelines import demo_shapes, demo_usd


@pytest.fixture
def asset(tmp_path):
    """Path of cup.usda: /World/geo/{left, right}, bound to /World/mtl/{steel, wood}."""
    stage = demo_usd.new_stage()
    x, y = np.meshgrid((-1.0, 1.0), (-1.0, 1.0))
    points = np.stack([x, y, 0 * x], axis=-1)
    normals = np.broadcast_to((0.0, 0.0, 1.0), points.shape)
    quad = demo_shapes.grid(points, normals, 0.5 + 0.5 * np.stack([x, y], axis=-1))
    for name, owner, at in (("left", "steel", -1.1), ("right", "wood", 1.1)):
        surface = demo_usd.material(stage, owner, diffuseColor=(0.4, 0.4, 0.4), roughness=0.2)
        demo_usd.mesh(stage, name, quad, surface, (at, 0.0, 0.0))
    demo_usd.sphere_light(stage, "bulb", (0.0, 1.0, 5.0), 0.5, 60.0)
    demo_usd.camera(stage, (0.0, 0.0, 8.0), (0.0, 0.0, 0.0))
    demo_usd.settings(stage, 16, 12)
    return demo_usd.save(stage, tmp_path / "cup.usda", "A test.")
