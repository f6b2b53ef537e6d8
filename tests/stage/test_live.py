"""A stage that is edited while it is looked at: controls as the schema has them, edits on a layer of their own."""

import hashlib

import numpy as np
import pytest
from pxr import Gf, Sdf, Usd, UsdGeom

from scratchwarp.pipelines import author_demo
from scratchwarp.scene import Control, StageError
from scratchwarp.scene.control import SECTIONS
from scratchwarp.stage import LiveStage, read

DEPTH = "/World/mtl/ball.scratch:layer:hairlines:depth"


@pytest.fixture(scope="module")
def ball(tmp_path_factory):
    return author_demo.author(tmp_path_factory.mktemp("stages"), 0.1, ["ball"])[0]


@pytest.fixture
def live(ball):
    return LiveStage(ball)


def layer(scene, name):
    return next(one for material in scene.materials for one in material.layers if one.name == name)


def test_it_reads_what_read_reads(live, ball):
    there, fresh = live.scene, read(ball)
    assert there.camera.path == fresh.camera.path and len(there.instances) == len(fresh.instances)
    assert [m.path for m in there.materials] == [m.path for m in fresh.materials]
    assert there.warnings == fresh.warnings


def test_controls_say_what_the_schema_says(live):
    """Type, value, range, unit and documentation of attributes of every kind."""
    known = {c.id: c for c in live.controls()}
    depth = known[DEPTH]
    assert (depth.section, depth.owner, depth.label) == ("layer", "/World/mtl/ball hairlines", "Depth")
    assert depth.kind == "number" and depth.value == 4.0 and depth.default == 1.0 and depth.units == "micrometer"
    assert (depth.low, depth.high, depth.least, depth.most) == (0.0, 500.0, 0.0, None)
    assert "Mean depth below the unscratched surface" in depth.documentation
    kinds = {c.kind for c in known.values()}
    assert kinds == {"number", "whole", "switch", "choice", "pair", "color", "name", "fixed"}
    shape = known["/World/mtl/ball/soft.scratch:shape"]
    assert shape.section == "profile" and shape.value == "round" and "vGroove" in shape.choices
    assert known["/World/mtl/ball/measured.inputs:metal"].choices[1] == "aluminium"
    assert {c.section for c in known.values()} == set(SECTIONS) - {"wave", "measured"}


def test_every_layer_attribute_of_the_schema_has_a_control(live):
    definition = Usd.SchemaRegistry().FindAppliedAPIPrimDefinition("ScratchLayerAPI")
    attributes = [n for n in definition.GetPropertyNames() if definition.GetAttributeDefinition(n)]
    names = {n.split(":")[-1] for n in attributes}
    prefix = "/World/mtl/ball.scratch:layer:marks:"
    assert {c.id.removeprefix(prefix) for c in live.controls() if c.id.startswith(prefix)} == names


def test_an_edit_changes_the_scene_and_keeps_what_it_did_not_touch(live):
    before = live.scene
    after = live.edit({DEPTH: 7.5})
    assert layer(after, "hairlines").depth == 7.5 and live.scene is after
    assert after.meshes is before.meshes and after.lights is before.lights and after.camera is before.camera
    assert next(c.value for c in live.controls() if c.id == DEPTH) == 7.5 and live.edited == (DEPTH,)
    lit = live.edit({"/World/lights/key.inputs:intensity": 3.0})
    for name in ("meshes", "textures", "curves"):
        assert getattr(lit, name) is getattr(before, name), name


def test_layers_are_switched_and_ordered(live):
    marks = "/World/mtl/ball.scratch:layer:marks:"
    ball = next(m.layers for m in live.scene.materials if m.path == "/World/mtl/ball")
    assert [one.name for one in ball][-1] == "hairlines" or [one.name for one in ball][-1] == "marks"
    first, last = (one.name for one in ball)
    prefix = "/World/mtl/ball.scratch:layer:"
    swapped = live.edit({f"{prefix}{first}:order": 5, f"{prefix}{last}:order": 1})
    assert [one.name for m in swapped.materials if m.path == "/World/mtl/ball" for one in m.layers] == [last, first]
    off = live.edit({marks + "enabled": False})
    assert [one.name for m in off.materials if m.path == "/World/mtl/ball" for one in m.layers] == ["hairlines"]


def test_the_surface_a_profile_and_a_light_are_turned(live):
    scene = live.edit(
        {
            "/World/mtl/ball/measured.inputs:metal": "gold",
            "/World/mtl/ball/soft.scratch:shape": "sine",
            "/World/lights/key.inputs:color": [1.0, 0.0, 0.0],
        }
    )
    assert next(m.surface.metal for m in scene.materials if m.path == "/World/mtl/ball") == "gold"
    assert {one.profile.shape for m in scene.materials for one in m.layers if m.path == "/World/mtl/ball"} > {"sine"}
    red = next(light.radiance for light in scene.lights if light.path == "/World/lights/key")
    assert red[0] > 0 and red[1] == red[2] == 0


@pytest.mark.parametrize(
    ("name", "value", "match"),
    [
        (DEPTH, -1.0, r"\[0, inf\)"),
        (DEPTH, float("nan"), "finite"),
        (DEPTH, "deep", "finite number"),
        (DEPTH, True, "finite number"),
        (DEPTH.replace("depth", "seed"), 1.5, "whole"),
        (DEPTH.replace("depth", "seed"), 2**40, "whole"),
        (DEPTH.replace("depth", "enabled"), 1, "true or false"),
        (DEPTH.replace("depth", "model"), "magic", "expected one of auto"),
        (DEPTH.replace("depth", "offset"), [1.0], "2 numbers"),
        (DEPTH.replace("depth", "maskTexture"), "/etc/passwd", "cannot be turned"),
        (DEPTH.replace("depth", "maskPrimvar"), "x" * 1000, "at most 200"),
        ("/World/geo/ball.points", [], "nothing that can be turned"),
        ("no path", 1, "nothing that can be turned"),
    ],
)
def test_a_senseless_edit_is_refused_and_leaves_all_as_it_was(live, name, value, match):
    before = live.scene
    with pytest.raises(ValueError, match=match):
        live.edit({"/World/lights/key.inputs:intensity": 1.0, name: value})
    assert live.scene is before and live.edited == ()


def test_what_the_stage_as_a_whole_cannot_have_is_undone(ball):
    """A depth without a width is no error of one attribute; the reader says so, and the edit is gone."""
    live = LiveStage(ball)
    before = live.scene
    wild = Control(DEPTH, "layer", "", "", "number", 4.0)
    live._known = {DEPTH: wild}  # a schema without limits
    with pytest.raises(StageError, match="depth is -3"):
        live.edit({DEPTH: -3.0})
    assert live.scene is before and live.edited == ()
    assert layer(live.edit({DEPTH: 2.0}), "hairlines").depth == 2.0


def test_the_camera_and_a_light_are_moved(live):
    seen = live.scene
    moved = np.array(seen.camera.transform)
    moved[:3, 3] += (0.01, 0.0, 0.0)
    after = live.place("", moved)
    np.testing.assert_allclose(after.camera.transform, moved, atol=1e-12)
    np.testing.assert_array_equal(after.origin, seen.origin)
    assert all(a is b for a, b in zip(after.meshes, seen.meshes, strict=True))
    key = live.matrix("/World/lights/key")
    key[:3, 3] += (0.0, 0.02, 0.0)
    lit = live.place("/World/lights/key", key)
    centers = [next(x.center for x in s.lights if x.path == "/World/lights/key") for s in (seen, lit)]
    np.testing.assert_allclose(centers[1] - centers[0], (0.0, 0.02, 0.0), atol=1e-9)
    sizes = [next(np.linalg.norm(x.ex) for x in s.lights if x.path == "/World/lights/key") for s in (seen, lit)]
    assert sizes[1] == pytest.approx(sizes[0], rel=1e-9)


@pytest.mark.parametrize("prim", ["/World/geo/ball", "/nothing", "no path"])
def test_nothing_but_lights_and_the_camera_moves(live, prim):
    with pytest.raises(ValueError, match="no light"):
        live.place(prim, np.eye(4))
    with pytest.raises(ValueError, match="inverted"):
        live.place("", np.zeros((4, 4)))


def test_saved_edits_open_as_they_were_and_the_stage_stays_as_it_is(live, ball, tmp_path):
    before = hashlib.sha256(ball.read_bytes()).hexdigest()
    live.edit({DEPTH: 7.5, "/World/mtl/ball.scratch:layer:marks:enabled": False})
    moved = np.array(live.scene.camera.transform)
    moved[:3, 3] += (0.01, 0.0, 0.0)
    live.place("", moved)
    look = tmp_path / "look.usda"
    live.save(look)
    assert [p.name for p in tmp_path.iterdir()] == ["look.usda"]
    again = LiveStage(look)
    assert {c.id: c.value for c in again.controls()} == {c.id: c.value for c in live.controls()}
    np.testing.assert_allclose(again.scene.origin, live.scene.origin + (0.01, 0, 0), atol=1e-9)
    assert [m.path for m in again.scene.materials] == [m.path for m in live.scene.materials]
    again.edit({DEPTH: 8.5})
    again.save(tmp_path / "second.usda")
    assert layer(read(tmp_path / "second.usda"), "hairlines").depth == 8.5
    assert hashlib.sha256(ball.read_bytes()).hexdigest() == before


def test_render_settings_and_waves_are_turned(live, tmp_path):
    settings = next(c for c in live.controls() if c.id.endswith("scratch:render:samplesPerPixel"))
    assert settings.section == "settings" and live.edit({settings.id: 7}).options.spp == 7
    spoon = LiveStage(author_demo.author(tmp_path, 0.1, ["spoon"])[0])
    radius = next(c for c in spoon.controls() if c.id.endswith("scratch:wave:coherenceRadius"))
    assert radius.section == "wave" and radius.units == "micrometer"
    waves = [m.wave for m in spoon.edit({radius.id: 33.0}).materials if m.wave is not None]
    assert [w.coherence_radius for w in waves] == [33.0] * len(waves) and waves


def test_a_file_of_the_stage_is_never_replaced(live, ball, tmp_path):
    with pytest.raises(ValueError, match="is a file of the stage"):
        live.save(ball)
    with pytest.raises(ValueError, match="saved as"):
        live.save(tmp_path / "look.txt")
    with pytest.raises(OSError, match="does not exist"):
        live.save(tmp_path / "no" / "look.usda")


def test_reset_drops_all_edits(live):
    live.edit({DEPTH: 7.5})
    assert layer(live.reset(), "hairlines").depth == 4.0 and live.edited == ()
    assert next(c.value for c in live.controls() if c.id == DEPTH) == 4.0


def test_a_stage_without_a_camera_gets_one_when_it_is_moved(tmp_path):
    file = tmp_path / "bare.usda"
    stage = Usd.Stage.CreateNew(str(file))
    UsdGeom.SetStageMetersPerUnit(stage, 0.01)
    UsdGeom.Cube.Define(stage, "/cube")
    stage.GetRootLayer().Save()
    live = LiveStage(file)
    moved = np.array(live.scene.camera.transform)
    moved[:3, 3] += (0.0, 0.3, 0.0)
    after = live.place("", moved)
    np.testing.assert_allclose(after.camera.transform, moved, atol=1e-9)
    live.save(tmp_path / "look.usda")
    again = read(tmp_path / "look.usda")
    np.testing.assert_allclose(again.origin, live.scene.origin + (0.0, 0.3, 0.0), atol=1e-9)
    window = [scene.camera.window(64, 48) for scene in (again, after)]
    np.testing.assert_allclose(window[0], window[1], rtol=1e-6)


def test_time_samples_give_way_to_an_edit(ball, tmp_path):
    file = tmp_path / "moving.usda"
    stage = Usd.Stage.CreateNew(str(file))
    stage.GetRootLayer().subLayerPaths.append(str(ball))
    for name in ("metersPerUnit", "upAxis"):
        stage.SetMetadata(name, Sdf.Layer.FindOrOpen(str(ball)).pseudoRoot.GetInfo(name))
    light = stage.OverridePrim("/World/lights/key").CreateAttribute("inputs:intensity", Sdf.ValueTypeNames.Float)
    light.Set(5.0, 1.0)
    light.Set(9.0, 2.0)
    stage.OverridePrim("/World/camera").CreateAttribute("exposure", Sdf.ValueTypeNames.Float)
    stage.GetRootLayer().Save()
    live = LiveStage(file, frame=2.0)
    before = next(x.radiance for x in live.scene.lights if x.path == "/World/lights/key")
    after = live.edit({"/World/lights/key.inputs:intensity": 18.0})
    lit = next(x.radiance for x in after.lights if x.path == "/World/lights/key")
    np.testing.assert_allclose(lit, 2 * before, rtol=1e-6)
    assert Gf.Vec3f(*lit.tolist()) and after.time == 2.0
