"""Stages made elsewhere: they must read, with warnings and without noise."""

import os
from pathlib import Path

import numpy as np
import pytest

from scratchwarp import stage

SHARED = Path(os.environ.get("SCRATCHWARP_SHARED", Path(__file__).resolve().parents[2].parent / "shared"))
BALL = SHARED / "data/usd/StandardShaderBall/standard_shader_ball_scene.usda"
TEAPOT = SHARED / "data/usd/Teapot/Teapot.usd"


def pixels(path, space):
    return np.full((1, 1, 4), 0.5, np.float32)


@pytest.mark.skipif(not BALL.exists(), reason=f"{BALL} is absent")
def test_shader_ball(capfd, said):
    scene = stage.read(BALL, load_texture=pixels)
    assert capfd.readouterr().err == ""
    assert scene.camera.path == "/standard_shader_ball_scene/camera" and len(scene.lights) == 5
    assert len(scene.instances) == 12 and scene.triangles > 10000
    said(scene, "subdivision surface")
    said(scene, "ground.ACEScg.exr")
    assert sum("mtlx" in w for w in scene.warnings) == 4
    # Rect lights shine along -Z: the big ones hang above and look down.
    down = [light.normal for light in scene.lights if "emitterTop" in light.path]
    np.testing.assert_allclose(down, np.broadcast_to([0, -1, 0], (4, 3)), atol=1e-12)


@pytest.mark.skipif(not BALL.exists(), reason=f"{BALL} is absent")
def test_a_session_layer_scratches_the_shader_ball(write):
    session = write(
        """
over "standard_shader_ball_scene" {
    over "shader_ball" {
        over "material_surface" (prepend apiSchemas = ["MaterialBindingAPI"]) {
            rel material:binding = </Scratched>
        }
    }
}
def Material "Scratched" (prepend apiSchemas = ["ScratchLayerAPI:fine"]) {
    token outputs:surface.connect = </Scratched/s.outputs:surface>
    rel scratch:layer:fine:profile = </Scratched/Vee>
    def Shader "s" {
        uniform token info:id = "UsdPreviewSurface"
        token outputs:surface
    }
    def ScratchProfile "Vee" {}
}
""",
        name="session.usda",
    )
    scene = stage.read(BALL, load_texture=pixels, session_layer=session)
    (ball,) = [i for i in scene.instances if i.path.endswith("material_surface")]
    assert scene.materials[ball.materials[0]].layers[0].name == "fine"
    assert "st" in scene.meshes[ball.mesh].uvs


@pytest.mark.skipif(not TEAPOT.exists(), reason=f"{TEAPOT} is absent")
def test_teapot(said):
    scene = stage.read(TEAPOT, load_texture=pixels)
    assert scene.materials[0].uses_display_color and scene.triangles > 1000
    said(scene, "no camera")
    said(scene, "no light")
