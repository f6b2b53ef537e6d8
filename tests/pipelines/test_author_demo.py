"""The demo stages: valid, complete, the same every time, and read as they were meant."""

import subprocess
import sys

import numpy as np
import pytest
from pxr import Usd, UsdGeom, UsdRender, UsdShade, UsdValidation

import scratchwarp as sw
from scratchwarp import usd_schemas
from scratchwarp.pipelines import author_demo
from scratchwarp.scene.layer import DISTRIBUTIONS
from scratchwarp.stage import read

DETAIL = 0.1


@pytest.fixture(scope="module")
def stages(tmp_path_factory):
    """Small versions of all stages: name -> path."""
    paths = author_demo.author(tmp_path_factory.mktemp("demo"), DETAIL, tuple(author_demo.STAGES))
    return {path.stem: path for path in paths}


@pytest.fixture(params=tuple(author_demo.STAGES))
def path(request, stages):
    return stages[request.param]


def layers(stage):
    """(Material prim, layer name) of every scratch layer."""
    for prim in stage.Traverse():
        for schema in prim.GetAppliedSchemas():
            if schema.startswith("ScratchLayerAPI:"):
                yield prim, schema.split(":", 1)[1]


def test_openusd_finds_nothing_to_complain_about(path):
    """Every validator that OpenUSD brings, and those registered here, pass without errors or warnings."""
    usd_schemas.register()
    usd_schemas.register_shaders()
    registry = UsdValidation.ValidationRegistry()
    stage = Usd.Stage.Open(str(path))
    errors = UsdValidation.ValidationContext(registry.GetOrLoadAllValidators()).Validate(stage)
    assert [f"{error.GetName()}: {error.GetMessage()}" for error in errors] == []


def test_stages_say_their_units_camera_and_size(path):
    """metersPerUnit and upAxis are authored; the render settings name a camera and a resolution."""
    stage = Usd.Stage.Open(str(path))
    assert UsdGeom.StageHasAuthoredMetersPerUnit(stage) and stage.HasAuthoredMetadata("upAxis")
    assert stage.GetDefaultPrim().GetPath() == "/World"
    settings = UsdRender.Settings.GetStageRenderSettings(stage)
    assert settings.GetResolutionAttr().HasAuthoredValue()
    assert stage.GetPrimAtPath(settings.GetCameraRel().GetTargets()[0]).IsA(UsdGeom.Camera)


def test_meshes_carry_everything_scratches_need(path):
    """Not subdivided; normals, st, extent and a bound material on every mesh."""
    stage = Usd.Stage.Open(str(path))
    meshes = [UsdGeom.Mesh(prim) for prim in stage.Traverse() if prim.IsA(UsdGeom.Mesh)]
    assert meshes
    for mesh in meshes:
        assert mesh.GetSubdivisionSchemeAttr().Get() == "none"
        count = len(mesh.GetPointsAttr().Get())
        assert len(mesh.GetNormalsAttr().Get()) == count
        assert len(UsdGeom.PrimvarsAPI(mesh).GetPrimvar("st").Get()) == count
        extent = UsdGeom.PointBased.ComputeExtent(mesh.GetPointsAttr().Get())
        assert [tuple(p) for p in mesh.GetExtentAttr().Get()] == [tuple(p) for p in extent]
        material, _ = UsdShade.MaterialBindingAPI(mesh).ComputeBoundMaterial()
        assert material.ComputeSurfaceSource()[0]


def test_the_ball_shows_every_distribution(stages):
    """And the kettle scratches around itself, the panel in coat and metal, the plain stage not at all."""
    stage = Usd.Stage.Open(str(stages["ball"]))
    used = {prim.GetAttribute(f"scratch:layer:{name}:distribution").Get() for prim, name in layers(stage)}
    assert used == set(DISTRIBUTIONS)
    panel = Usd.Stage.Open(str(stages["panel"]))
    materials = {prim.GetAttribute(f"scratch:layer:{name}:material").Get() for prim, name in layers(panel)}
    assert {"inherit", "conductor"} <= materials
    plain = Usd.Stage.Open(str(stages["plain"]))
    assert not list(layers(plain)) and "scratch:" not in plain.GetRootLayer().ExportToString()


def test_layers_and_profiles_are_tied_together(path):
    """Each layer's profile is a ScratchProfile in the same material; curves layers target scratch curves."""
    stage = Usd.Stage.Open(str(path))
    for prim, name in layers(stage):
        cut, lines = (prim.GetRelationship(f"scratch:layer:{name}:{key}").GetTargets() for key in ("profile", "curves"))
        assert len(cut) == 1 and cut[0].GetParentPath() == prim.GetPath()
        assert stage.GetPrimAtPath(cut[0]).IsA("ScratchProfile")
        explicit = prim.GetAttribute(f"scratch:layer:{name}:distribution").Get() == "curves"
        assert bool(lines) == explicit
        assert all(stage.GetPrimAtPath(line).HasAPI("ScratchCurvesAPI") for line in lines)


def test_the_spoon_is_closed_and_evenly_charted(stages):
    """Every face looks outwards; uv are neither mirrored nor folded, nor more than 1.8 times out of scale where the
    scratches lie; widths and depths are 0.8 to 6 um, scratch by scratch, on one prim."""
    scene = read(stages["spoon"])
    (placed,) = [i for i in scene.instances if i.path == "/World/geo/spoon"]
    mesh = scene.meshes[placed.mesh]
    corners = mesh.points[mesh.triangles]
    facing = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    assert ((facing * mesh.normals.mean(axis=1)).sum(axis=1) > 0).all()
    edges = np.concatenate([mesh.triangles[:, [i, (i + 1) % 3]] for i in range(3)])
    at = np.unique(mesh.points.round(4), axis=0, return_inverse=True)[1].reshape(-1)
    directed, twice = np.unique(at[edges], axis=0, return_counts=True)
    there = {tuple(edge) for edge in directed}
    assert (twice == 1).all() and all((b, a) in there for a, b in there)
    a, b = (mesh.uvs["st"][:, i] - mesh.uvs["st"][:, 0] for i in (1, 2))
    area = a[:, 0] * b[:, 1] - a[:, 1] * b[:, 0]
    assert (area > 0).all()
    top = mesh.uvs["st"][:, :, 1].min(axis=1) > 0.5
    scale = np.linalg.norm(facing[top], axis=1) / area[top] / 19.0**2
    assert 0.99 < scale.min() and scale.max() < 1.8
    (curves,) = scene.curves
    assert curves.space == "uv" and len(curves.counts) == 10000 * DETAIL
    for values in (curves.widths, curves.depths):
        each = values[::2]
        assert np.array_equal(each, values[1::2]) and 0.8 <= each.min() < 1.0 and 5.8 < each.max() <= 6.0


def test_running_twice_replaces_the_files(tmp_path):
    """Same bytes the second time, nothing else in the folder, and a stage that is open sees the new file."""
    first = author_demo.author(tmp_path, DETAIL, ["panel"])[0]
    before = first.read_bytes()
    opened = Usd.Stage.Open(str(first))
    points = len(UsdGeom.Mesh(opened.GetPrimAtPath("/World/geo/door")).GetPointsAttr().Get())
    author_demo.author(tmp_path, 2 * DETAIL, ["panel"])
    assert len(UsdGeom.Mesh(opened.GetPrimAtPath("/World/geo/door")).GetPointsAttr().Get()) > points
    author_demo.author(tmp_path, DETAIL, ["panel"])
    assert first.read_bytes() == before
    assert [p.name for p in tmp_path.iterdir()] == ["panel.usda"]


@pytest.mark.parametrize(("names", "detail", "message"), [(["bal"], 1.0, "'bal'"), (["ball"], 0.0, "detail is 0.0")])
def test_wrong_arguments_are_named(tmp_path, names, detail, message):
    """ValueError naming the value; nothing is written."""
    with pytest.raises(ValueError, match=message):
        author_demo.author(tmp_path, detail, names)
    assert not list(tmp_path.iterdir())


def test_the_command_line_prints_what_it_wrote(tmp_path, capsys):
    """Status 0 and the path; status 1 and a message where a file is in the way of the folder."""
    assert author_demo.main([str(tmp_path / "out"), "--detail", str(DETAIL), "--only", "plain"]) == 0
    assert capsys.readouterr().out.strip() == str(tmp_path / "out" / "plain.usda")
    assert author_demo.main([str(tmp_path / "out" / "plain.usda"), "--only", "plain"]) == 1
    assert "plain.usda" in capsys.readouterr().err


def test_it_runs_on_its_own(tmp_path):
    """A fresh process registers the schemas by itself."""
    command = [sys.executable, "-m", "scratchwarp.pipelines.author_demo", str(tmp_path), "--detail", "0.05"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120)
    assert done.returncode == 0, done.stderr
    assert len(done.stdout.split()) == 4


def test_stages_read_without_a_warning(path):
    """Every layer, light and curve arrives; micro-structure in micrometres, scene lengths in metres."""
    scene = sw.read(path)
    assert scene.warnings == ()
    stage = Usd.Stage.Open(str(path))
    assert sum(len(material.layers) for material in scene.materials) == len(list(layers(stage)))
    glowing = [prim for prim in stage.Traverse() if prim.HasAPI("MeshLightAPI")]
    assert len(scene.lights) == len(stage.GetPrimAtPath("/World/lights").GetChildren()) + len(glowing)
    settings = UsdRender.Settings.GetStageRenderSettings(stage)
    assert scene.options.resolution == tuple(settings.GetResolutionAttr().Get())
    low, high = scene.bounds()
    assert 0.1 < np.linalg.norm(high - low) < 10.0


def test_the_rosette_lies_on_its_tile(stages):
    """Object-space scratches are within a micrometre of the top of the tile that they are engraved in."""
    scene = read(stages["ball"])
    (curves,) = scene.curves
    (tile,) = [i for i in scene.instances if i.path.endswith("curvesTile")]
    points = scene.meshes[tile.mesh].points @ tile.transform[:3, :3].T + tile.transform[:3, 3]
    assert np.abs(curves.points[:, 1] - points[:, 1].max()).max() < 1e-6
    assert np.linalg.norm((curves.points - points.mean(0))[:, [0, 2]], axis=1).max() < 0.028


def test_the_camera_sees_the_whole_subject(stages):
    """Corners of the main object's bounding box project inside the picture."""
    subjects = {"ball": "ball", "kettle": "body", "panel": "door", "plain": "plastic", "spoon": "spoon", "disc": "rim"}
    for name, subject in subjects.items():
        scene = read(stages[name])
        (found,) = [i for i in scene.instances if i.path == f"/World/geo/{subject}"]
        points = scene.meshes[found.mesh].points @ found.transform[:3, :3].T + found.transform[:3, 3]
        eye = (points - scene.camera.transform[:3, 3]) @ scene.camera.transform[:3, :3]
        left, right, bottom, top = scene.camera.window(640, 480)
        x, y = eye[:, 0] / -eye[:, 2], eye[:, 1] / -eye[:, 2]
        assert left < x.min() and x.max() < right and bottom < y.min() and y.max() < top, name
