"""A published asset: complete, checked, the same every time, readable without our schemas, and nothing else touched."""

import hashlib
import json
import os
import subprocess
import sys

import numpy as np
import pytest
from pxr import Sdf, Usd, UsdGeom, UsdMedia, UsdShade

import scratchwarp as sw
from scratchwarp import cli, image
from scratchwarp.pipelines import looks
from scratchwarp.pipelines.gather import gather
from scratchwarp.pipelines.put_on import put_on
from scratchwarp.stage.validation import validate


@pytest.fixture
def worn(asset):
    """worn.usda in a folder of its own, over cup.usda, which reads a texture; and every byte of both folders."""
    image.write_layers({"color": np.full((2, 2, 3), 0.5, np.float32)}, asset.with_name("mask.png"))
    layer = Sdf.Layer.FindOrOpen(str(asset))
    shots = asset.parent / "shots"
    shots.mkdir()
    look = looks.with_values(looks.plain_look("hair"), [f"maskTexture={asset.with_name('mask.png')}"])
    put_on(asset, shots / "worn.usda", look, "steel")
    assert layer
    return shots / "worn.usda"


def contents(folder):
    return {p.relative_to(folder).as_posix(): p.read_bytes() for p in sorted(folder.rglob("*")) if p.is_file()}


def publish(stage, out, *options):
    return cli.main(["publish", str(stage), str(out), "--name=cup", "--assetVersion=1.2", "--quiet", *options])


def test_published(worn, tmp_path_factory):
    before, home = contents(worn.parents[1]), tmp_path_factory.mktemp("home")
    out = home / "cup"
    assert publish(worn, out, "-w=8", "--spp=1") == 0
    first = contents(out)
    assert publish(worn, out, "-w=8", "--spp=1") == 0
    assert contents(out) == first and contents(worn.parents[1]) == before
    assert [p.name for p in home.iterdir()] == ["cup"]
    manifest = json.loads(first.pop("manifest.json"))
    assert {row["path"]: row["sha256"] for row in manifest["files"]} == {
        name: hashlib.sha256(data).hexdigest() for name, data in first.items()
    }
    assert {"cup.usda", "cup.usdz", "contents/worn.usda", "thumbnails/cup.png"} <= set(first)
    assert manifest["missing"] == []
    assert sum(name.endswith("mask.png") for name in first) == 1
    outside = [name for name, data in first.items() if data == before["cup.usda"]]
    assert outside == ["contents/outside/cup.usda"]
    stage = Usd.Stage.Open(str(out / "cup.usda"), Usd.Stage.LoadNone)
    prim = stage.GetDefaultPrim()
    model = Usd.ModelAPI(prim)
    assert (model.GetKind(), model.GetAssetName(), model.GetAssetVersion()) == ("component", "cup", "1.2")
    assert UsdGeom.GetStageMetersPerUnit(stage) == 0.01 and prim.HasAuthoredPayloads()
    thumbnail = UsdMedia.AssetPreviewsAPI(prim).GetDefaultThumbnails().defaultImage
    assert thumbnail.path == "./thumbnails/cup.png"
    assert [str(f) for f in validate(out / "cup.usda")] == []
    (layer,) = next(m.layers for m in sw.read(out / "cup.usdz").materials if m.path == "/World/mtl/steel")
    assert layer.name == "hair" and layer.mask_texture >= 0


def test_the_package_opens_without_our_schemas(worn, tmp_path):
    out = tmp_path / "elsewhere"
    assert publish(worn, out, "--no-thumbnail") == 0
    plain = {name: value for name, value in os.environ.items() if name != "PXR_PLUGINPATH_NAME"}
    argv = [sys.executable, "-c", BARE, str(out / "cup.usdz")]
    done = subprocess.run(argv, env=plain, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    found = json.loads(done.stdout)
    assert found["surfaces"]["/World/geo/left"] == ["/World/mtl/steel", "UsdPreviewSurface"]
    assert found["textures"] and all(size > 0 for size in found["textures"].values())
    assert found["errors"] == [] and min(found["size"]) > 0.0


BARE = """
import json, sys
from pxr import Ar, Usd, UsdGeom, UsdShade
stage = Usd.Stage.Open(sys.argv[1])
assert not Usd.SchemaRegistry().FindAppliedAPIPrimDefinition("ScratchLayerAPI") and "scratchwarp" not in sys.modules
surfaces, textures = {}, {}
for prim in stage.Traverse():
    if prim.IsA(UsdGeom.Gprim):
        material = UsdShade.MaterialBindingAPI(prim).ComputeBoundMaterial()[0]
        if material:
            shader = material.ComputeSurfaceSource()[0]
            surfaces[str(prim.GetPath())] = [str(material.GetPath()), shader.GetShaderId()]
            for node in Usd.PrimRange(material.GetPrim()):
                file = UsdShade.Shader(node).GetInput("file") if node.IsA(UsdShade.Shader) else None
                if file:
                    path = Ar.ResolvedPath(file.Get().resolvedPath)
                    textures[str(path)] = Ar.GetResolver().OpenAsset(path).GetSize()
box = UsdGeom.BBoxCache(0.0, ["default", "render"]).ComputeWorldBound(stage.GetDefaultPrim()).ComputeAlignedRange()
errors = [str(e) for e in stage.GetCompositionErrors()]
print(json.dumps({"surfaces": surfaces, "textures": textures, "errors": errors, "size": list(box.GetSize())}))
"""


def test_models_in_a_component_become_subcomponents(tmp_path):
    (tmp_path / "set.usda").write_text(
        '#usda 1.0\n(\n defaultPrim = "Set"\n metersPerUnit = 1\n upAxis = "Y"\n)\n'
        'def Xform "Set" (\n kind = "group"\n variants = {\n  string shape = "one"\n }\n'
        ' prepend variantSets = "shape"\n)\n{\n def Xform "Box" (\n  kind = "component"\n )\n {\n }\n'
        ' variantSet "shape" = {\n  "one" {\n  }\n  "two" {\n   def Xform "Other" (\n    kind = "assembly"\n   )\n'
        "   {\n   }\n  }\n }\n}\n"
    )
    out = tmp_path / "out"
    plain = ("--no-thumbnail", "--no-usdz", "--no-preview")
    assert publish(tmp_path / "set.usda", out, *plain) == 0
    stage = Usd.Stage.Open(str(out / "cup.usda"))

    def kinds():
        return {str(p.GetPath()): Usd.ModelAPI(p).GetKind() for p in stage.Traverse()}

    assert kinds() == {"/Set": "component", "/Set/Box": "subcomponent"}
    stage.GetDefaultPrim().GetVariantSet("shape").SetVariantSelection("two")
    assert kinds() == {"/Set": "component", "/Set/Box": "subcomponent", "/Set/Other": "subcomponent"}
    assert publish(tmp_path / "set.usda", out, *plain, "--kind=assembly") == 0
    stage = Usd.Stage.Open(str(out / "cup.usda"))
    stage.Reload()
    assert kinds() == {"/Set": "assembly", "/Set/Box": "component"}


def test_what_is_there_is_not_replaced(worn, tmp_path, capsys):
    out = tmp_path / "notes"
    out.mkdir()
    (out / "mine.txt").write_text("mine")
    assert publish(worn, out, "--no-thumbnail") == 1
    assert "was not published" in capsys.readouterr().err and [p.name for p in out.iterdir()] == ["mine.txt"]
    assert publish(worn, worn.parent, "--no-thumbnail") == 1
    assert "choose another folder" in capsys.readouterr().err
    assert publish(worn, tmp_path / "a", "--name=two words", "--no-thumbnail") == 1
    assert publish(worn, tmp_path / "a", f"--thumbnail={worn}") == 1
    assert not (tmp_path / "a").exists() and not [p for p in tmp_path.iterdir() if p.name.startswith(".")]


def test_a_material_beside_the_default_prim_is_refused(asset, tmp_path, capsys):
    stage = Usd.Stage.Open(str(asset))
    made = UsdShade.Material.Define(stage, "/Elsewhere")
    UsdShade.MaterialBindingAPI(stage.GetPrimAtPath("/World/geo/left")).Bind(made)
    stage.GetRootLayer().Export(str(tmp_path / "split.usda"))
    assert publish(tmp_path / "split.usda", tmp_path / "out", "--no-thumbnail") == 1
    assert "cannot be published" in capsys.readouterr().err and not (tmp_path / "out").exists()


def test_gathered_files_find_one_another(tmp_path):
    """Absolute paths become relative, tiles follow their pattern, and what is missing is said."""
    texts = {
        "far/b.usda": (
            '#usda 1.0\ndef Shader "B"\n{\n    uniform token info:id = "UsdUVTexture"\n'
            "    asset inputs:file = @./t.<UDIM>.png@\n    asset inputs:none = @./none.png@\n}\n"
        ),
        "far/t.1001.png": "1",
        "far/t.1002.png": "2",
        "near/a.usda": f"#usda 1.0\n(\n    subLayers = [@{tmp_path}/far/b.usda@]\n)\n",
    }
    for name, text in texts.items():
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(text)
    copy, missing = gather(tmp_path / "near/a.usda", tmp_path / "out")
    assert copy == tmp_path / "out/a.usda" and missing == ["../far/none.png"]
    assert Sdf.Layer.FindOrOpen(str(copy)).subLayerPaths == ["./outside/b.usda"]
    found = contents(tmp_path / "out")
    assert found["outside/b.usda"].decode() == texts["far/b.usda"]
    assert found["outside/t.1002.png"] == b"2"
