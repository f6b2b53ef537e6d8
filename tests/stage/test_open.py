"""Files that are no stage, masks, session layers."""

import pytest

from scratchwarp import stage
from scratchwarp.scene import StageError

QUAD = """
        int[] faceVertexCounts = [4]
        int[] faceVertexIndices = [0, 1, 2, 3]
        point3f[] points = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0)]
        uniform token subdivisionScheme = "none"
"""


def test_a_missing_file_a_folder_and_no_usd_say_so(tmp_path):
    (tmp_path / "text.txt").write_text("hello")
    (tmp_path / "broken.usda").write_text("#usda 1.0\ndef Xform {\n")
    (tmp_path / "junk.usdc").write_bytes(b"junk")
    for name, words in {
        "missing.usda": "no such file",
        ".": "is a folder",
        "text.txt": "no USD file",
        "broken.usda": "broken.usda:2",
        "junk.usdc": "no USD file",
    }.items():
        with pytest.raises(StageError, match=words) as error:
            stage.read(tmp_path / name)
        assert str(tmp_path) in str(error.value)


def test_an_empty_stage_and_a_bad_unit_say_so(write):
    with pytest.raises(StageError, match="no prims"):
        stage.read(write(""))
    with pytest.raises(StageError, match="metersPerUnit is -1"):
        stage.read(write('def Xform "a" {}', metres=-1))


def test_a_stage_without_geometry_camera_and_light_says_so(read, said):
    scene = read('def Xform "World" {}')
    assert not scene.instances and len(scene.lights) == 1
    said(scene, "no geometry")
    said(scene, "no camera")
    said(scene, "no light")


def test_mask_limits_the_stage_but_keeps_bound_materials_and_the_camera(write, said):
    path = write(f"""
def Xform "World"
{{
    def Mesh "a" (prepend apiSchemas = ["MaterialBindingAPI"])
    {{
        rel material:binding = </Looks/red>
        {QUAD}
    }}
    def Mesh "b" {{
        {QUAD}
    }}
}}
def Camera "cam" {{}}
def Scope "Looks"
{{
    def Material "red"
    {{
        token outputs:surface.connect = </Looks/red/s.outputs:surface>
        def Shader "s"
        {{
            uniform token info:id = "UsdPreviewSurface"
            color3f inputs:diffuseColor = (1, 0, 0)
            token outputs:surface
        }}
    }}
}}
""")
    scene = stage.read(path, mask="/World/a", camera="/cam")
    assert [i.path for i in scene.instances] == ["/World/a"]
    assert scene.materials[scene.instances[0].materials[0]].surface.diffuse_color == (1.0, 0.0, 0.0)
    assert scene.camera.path == "/cam"
    with pytest.raises(StageError, match="/World/nobody"):
        stage.read(path, mask=["/World/nobody"])
    with pytest.raises(StageError, match="a b c"):
        stage.read(path, mask=["a b c"])


def test_session_layer_is_stronger(write):
    path = write(f'def Mesh "a" {{\n{QUAD}\n}}\n')
    session = write('over "a"\n{\n    token visibility = "invisible"\n}\n', name="session.usda")
    assert len(stage.read(path).instances) == 1
    assert len(stage.read(path, session_layer=session).instances) == 0


def test_missing_references_are_warnings_not_noise(write, said, capfd):
    path = write(f'def Mesh "a" {{\n{QUAD}\n}}\ndef Xform "b" (references = @nowhere.usda@) {{}}\n')
    scene = stage.read(path)
    said(scene, "nowhere.usda", str(path))
    assert capfd.readouterr().err == ""


def test_unknown_purposes_and_frames_are_refused(write):
    path = write('def Xform "a" {}')
    with pytest.raises(StageError, match="beauty"):
        stage.read(path, purposes=("beauty",))
    with pytest.raises(StageError, match="frame is nan"):
        stage.read(path, frame=float("nan"))


def test_warnings_are_said_once_and_handed_on(write):
    heard = []
    meshes = "".join(f'def Mesh "m{i}" {{}}\n' for i in range(6))
    scene = stage.read(write(meshes), warn=heard.append)
    about = [w for w in scene.warnings if "has no faces" in w]
    assert len(about) == 1 and about[0].startswith("/m0, /m1, /m2 and 3 more:")
    assert tuple(heard) == scene.warnings


ODD = {
    "attribute types": (
        'def SphereLight "l" { string inputs:intensity = "much" }',
        ["/l.inputs:intensity", "wrong type"],
    ),
    "primvar types": (
        f'def Mesh "m" {{ {QUAD}\nstring primvars:displayColor = "red" }}',
        ["/m.primvars:displayColor", "no numbers"],
    ),
    "single values": (f'def Mesh "m" {{ {QUAD}\nfloat primvars:displayColor = 3 }}', ["displayColor", "ignored"]),
    "shader types": (
        f"""def Material "mat" {{
    token outputs:surface.connect = </mat/s.outputs:surface>
    def Shader "s" {{
        uniform token info:id = "UsdPreviewSurface"
        string inputs:diffuseColor = "red"
        token outputs:surface
    }}
}}
def Mesh "m" (prepend apiSchemas = ["MaterialBindingAPI"]) {{ rel material:binding = </mat>\n{QUAD} }}""",
        ["/mat/s.inputs:diffuseColor", "'red'", "wrong type"],
    ),
    "files": ('def DomeLight "d" { bool inputs:texture:file = 1 }', ["/d.inputs:texture:file", "True", "wrong type"]),
    "arrays of vectors": (
        'def Camera "c" { float2[] clippingRange = [(1, 2), (3, 4)] }',
        ["/c.clippingRange", "wrong type"],
    ),
    "points": ('def Mesh "m" { float[] points = [1, 2, 3, 4] }', ["/m.points", "wrong type"]),
    "counts": ('def Mesh "m" { asset faceVertexCounts = @a.png@ }', ["/m.faceVertexCounts", "wrong type"]),
}


@pytest.mark.parametrize("case", ODD)
def test_odd_stages_warn(read, said, case):
    text, words = ODD[case]
    said(read(text), *words)


def test_transforms_that_usd_cannot_evaluate_are_refused(read):
    with pytest.raises(StageError, match="/m has xformOps"):
        read(f'def Mesh "m" {{ {QUAD}\nuniform token[] xformOpOrder = ["xformOp:nope"] }}')
