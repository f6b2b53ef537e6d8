"""The most that lights and glowing surfaces may emit."""

import numpy as np

from scratchwarp import stage

from .test_light import QUAD


def test_lights_and_surfaces_that_outshine_what_images_hold_are_dimmed(write, tmp_path, said):
    """Squares of radiances are kept in float32: 1e16 is the most, of a colour, a texel or a light that a glow tints."""
    (tmp_path / "a.hdr").write_bytes(b"x")
    path = write(f"""
def DomeLight "d" {{
    asset inputs:texture:file = @a.hdr@
    float inputs:intensity = 2e10
}}
def RectLight "r" {{
    asset inputs:texture:file = @a.hdr@
    float inputs:intensity = 2e10
}}
def Mesh "m" (prepend apiSchemas = ["MeshLightAPI", "MaterialBindingAPI"]) {{
    rel material:binding = </mat>
    uniform token light:materialSyncMode = "materialGlowTintsLight"
    float inputs:intensity = 4
    {QUAD}
}}
def Mesh "n" (prepend apiSchemas = ["MaterialBindingAPI"]) {{
    rel material:binding = </mat>
    {QUAD}
}}
def Material "mat" {{
    token outputs:surface.connect = </mat/s.outputs:surface>
    def Shader "s" {{
        uniform token info:id = "UsdPreviewSurface"
        color3f inputs:emissiveColor = (3e38, 1.5e38, 0)
        token outputs:surface
    }}
}}
""")
    scene = stage.read(path, load_texture=lambda path, space: np.full((2, 4, 4), 1e10, np.float32))
    shining = {light.path: light.radiance for light in scene.lights}
    np.testing.assert_allclose(shining["/d"], 1e6)
    np.testing.assert_allclose(shining["/r"], 1e6)
    np.testing.assert_allclose(shining["/m"], [1e16, 5e15, 0.0])
    (glow,) = {m.surface.emissive_color for m in scene.materials if any(m.surface.emissive_color)}
    np.testing.assert_allclose(glow, [1e16, 5e15, 0.0])
    for prim in ("/d, /r:", "/m:", "/mat/s:"):
        said(scene, prim, "more than images hold")
