"""The walk of the docs, at a small size: an asset of others, published, opens where nobody knows our schemas."""

import os
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

import scratchwarp

ROOT = Path(__file__).resolve().parents[2]
HOME = Path(scratchwarp.__file__).parents[1]  # of the package under test, which may be an installed one
SHARED = Path(os.environ.get("SCRATCHWARP_SHARED", ROOT.parent / "shared")) / "data" / "usd"
LOOK = (
    "import sys; from pxr import Plug, Usd, UsdGeom, UsdShade\n"
    "assert not any('scratch' in p.name.lower() for p in Plug.Registry().GetAllPlugins())\n"
    "stage = Usd.Stage.Open(sys.argv[1])\n"
    "bound = UsdShade.MaterialBindingAPI.ComputeBoundMaterials(\n"
    "    [p for p in stage.Traverse() if p.IsA(UsdGeom.Mesh)])[0]\n"
    "shaders = {str(m.GetPath()): m.ComputeSurfaceSource()[0] for m in bound if m}\n"
    "print([(path, s.GetShaderId(), s.GetPath().name) for path, s in shaders.items()])\n"
    "assert stage.GetDefaultPrim().HasAuthoredPayloads() or sys.argv[1].endswith('z')\n"
    "print(Usd.ModelAPI(stage.GetDefaultPrim()).GetKind(), Usd.ModelAPI(stage.GetDefaultPrim()).GetAssetName())\n"
)


@pytest.mark.parametrize("name", ["teapot"])
def test_an_asset_goes_the_whole_way(name, tmp_path):
    """Author, validate, bake, render, export, publish; its own files are the same, bytes and all, afterwards. (The
    script as a whole walks two assets; here it ends after one, which exports a UsdPreviewSurface alone.)"""
    if not (SHARED / "Teapot").is_dir():
        pytest.skip("the assets of the USD working group are not here")
    text = (ROOT / "docs" / "asset_walk.sh").read_text()
    first, second = text.index("asset=$data/StandardShaderBall"), text.index('sums > "$out/after.txt"')
    shorter = text[:first].replace("preview materialx mitsuba", "preview") + text[second:]
    assert shorter.count("walk teapot") == 1 and "preview materialx" not in shorter
    data = tmp_path / "data"
    shutil.copytree(SHARED / "Teapot", data / "Teapot")
    plain = {k: v for k, v in os.environ.items() if k != "PXR_PLUGINPATH_NAME"}
    environment = {**plain, "SCRATCHWARP": f"{sys.executable} -m scratchwarp", "PYTHONPATH": str(HOME)}
    command = ["sh", "-c", shorter, "walk", str(data), str(tmp_path / "out"), "16", "1", "16"]
    done = subprocess.run(command, env=environment, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert "the assets' own files are what they were" in done.stdout
    package = tmp_path / "out" / "published" / name / f"{name}.usdz"
    assert zipfile.ZipFile(package).testzip() is None
    seen = subprocess.run([sys.executable, "-c", LOOK, str(package)], env=plain, capture_output=True, text=True)
    assert seen.returncode == 0, seen.stderr
    assert "('/Teapot/Materials/Ceramic', 'UsdPreviewSurface', 'BakedSurface')" in seen.stdout
    assert seen.stdout.split()[-2:] == ["component", name]
