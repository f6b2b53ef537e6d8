"""compare, contact-sheet, turntable and zoom: what they say, what they write, where the camera stands."""

import json
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

import scratchwarp as sw
from scratchwarp import cli, image
from scratchwarp.pipelines import camera_moves, looks, pictures
from scratchwarp.pipelines.put_on import put_on


@pytest.fixture
def ramps(tmp_path):
    """Two images that differ by a factor of 0.9: a.exr and b.npz."""
    ramp = np.linspace(0.0, 1.0, 6 * 8 * 3, dtype=np.float32).reshape(6, 8, 3)
    image.write_layers({"color": ramp}, tmp_path / "a.npz")
    image.write_layers({"color": 0.9 * ramp}, tmp_path / "b.npz")
    return ramp, tmp_path / "a.npz", tmp_path / "b.npz"


def test_compare_images(ramps, capsys):
    ramp, a, b = ramps
    out = a.with_name("compared")
    before = [p.read_bytes() for p in (a, b)]
    for _ in range(2):
        assert cli.main(["compare", str(a), str(b), str(out), "--json"]) == 0
    record = json.loads(capsys.readouterr().out.partition("}\n{")[0] + "}")
    assert record["relMSE"] == pytest.approx(float(np.mean((0.1 * ramp) ** 2 / (ramp**2 + 0.01))), rel=1e-4)
    assert record["largest"] == pytest.approx(0.1, rel=1e-4) and record["failed"] is False
    names = {"index.html", "compare.json", "reference.png", "other.png", "difference.png"}
    assert names <= {p.name for p in out.iterdir()} and not any(p.name.startswith(".") for p in out.iterdir())
    assert "data:image/png;base64," in (out / "index.html").read_text()
    assert [p.read_bytes() for p in (a, b)] == before
    assert cli.main(["compare", str(a), str(b), str(out), "--maxError", "1e-5", "--quiet"]) == 1


def test_compare_faults(ramps, capsys):
    _, a, b = ramps
    small = a.with_name("small.npz")
    image.write_layers({"color": np.zeros((2, 2, 3), np.float32)}, small)
    assert cli.main(["compare", str(a), str(small), str(a.with_name("out"))]) == 1
    assert "[6, 8, 3] and [2, 2, 3]" in capsys.readouterr().err
    assert cli.main(["compare", str(a), str(a.with_name("none.exr")), str(a.with_name("out"))]) == 1
    assert "none.exr" in capsys.readouterr().err
    assert not a.with_name("out").exists()


def test_grid_keeps_every_pixel():
    cells = [np.full((2, 3, 3), value, np.float32) for value in (0.1, 0.2, 0.3)]
    sheet = pictures.grid(cells, columns=2, gap=1)
    assert sheet.shape == (5, 7, 3)
    assert np.all(sheet[:2, :3] == cells[0]) and np.all(sheet[:2, 4:] == cells[1]) and np.all(sheet[3:, :3] == cells[2])
    assert np.all(sheet[2] == np.float32(0.18))


def test_captions_cannot_write_the_page():
    text = pictures.page("a<b", {'<script>"x': np.zeros((1, 1, 3))})
    assert "<script>" not in text and 'alt="&lt;script&gt;&quot;x"' in text and "<h1>a&lt;b</h1>" in text


def test_contact_sheet_of_wear(asset, capsys):
    """Three cells that differ, and the choice of the stage itself is left alone."""
    out, sheet = asset.with_name("worn.usda"), asset.with_name("sheet.npz")
    put_on(asset, out, looks.with_values(looks.plain_look("hair"), ["coverage=0.4", "depth=5"]), "*")
    before = out.read_bytes()
    argv = ["contact-sheet", str(out), "--variants", "wear", "--out", str(sheet), "--columns=3"]
    assert cli.main([*argv, "-w=16", "--spp=2", "--quality=draft", "--json"]) == 0
    names = json.loads(capsys.readouterr().out)["cells"]
    assert names == [f"{out} {wear}" for wear in looks.WEAR] and out.read_bytes() == before
    pixels = np.asarray(image.read_layers(sheet)[0]["color"])
    cells = [pixels[:, i * 20 : i * 20 + 16] for i in range(3)]
    assert pixels.shape == (12, 56, 3) and not np.array_equal(cells[0], cells[1])
    assert not np.array_equal(cells[1], cells[2])
    assert cli.main(["contact-sheet", str(asset), "--variants", "wear", "--out", str(sheet)]) == 1
    assert "no root prim has a variant set 'wear'" in capsys.readouterr().err


def test_matrices():
    """A whole turn comes home, a quarter turn about +y takes +z to +x, and the camera looks where it looked."""
    matrix, about = np.eye(4), np.array([0.0, 1.0, 0.0])
    matrix[:3, 3] = (0.0, 1.0, 4.0)
    up = np.array([0.0, 1.0, 0.0])
    quarter = camera_moves.turned(matrix, about, up, np.pi / 2)
    assert np.allclose(quarter[:3, 3], (4.0, 1.0, 0.0)) and np.allclose(quarter[:3, 2], (1.0, 0.0, 0.0))
    assert np.allclose(camera_moves.turned(matrix, about, up, 2 * np.pi), matrix)
    assert np.allclose(camera_moves.moved(matrix, about, 0.25)[:3, 3], (0.0, 1.0, 1.0))


def test_moves_keep_the_middle_in_the_middle(asset):
    """Every camera looks at the point, from distances that fall by one factor a frame."""
    scene = sw.read(asset)
    about = np.array([0.011, 0.0, 0.0]) - scene.origin
    shots = list(camera_moves.approach(scene, about, 3, 0.01))
    eyes = [shot.camera.transform[:3, 3] - about for shot in shots]
    assert np.allclose([np.linalg.norm(e) / np.linalg.norm(eyes[0]) for e in eyes], (1.0, 0.1, 0.01))
    for shot in camera_moves.orbit(scene, about, 5):
        towards = about - shot.camera.transform[:3, 3]
        before = about - scene.camera.transform[:3, 3]
        assert np.isclose(towards @ -shot.camera.transform[:3, 2], before @ -scene.camera.transform[:3, 2])


def test_the_object_turns_under_lights_that_stay(asset):
    """Half a turn takes one quad to where the other was; the camera and the lights are what they were."""
    scene = sw.read(asset)
    middle = -scene.origin
    _, half = camera_moves.spin(scene, middle, 2)
    left, right = (next(one for one in shot.instances if one.path.endswith("left")) for shot in (scene, half))
    assert np.allclose(right.transform[:3, 3] - middle, (left.transform[:3, 3] - middle) * (-1, 1, -1))
    assert half.lights == scene.lights and half.camera is scene.camera
    _, alone = camera_moves.spin(scene, middle, 2, "/World/geo/left")
    moved = [one.path for one, was in zip(alone.instances, scene.instances, strict=True) if one is not was]
    assert moved == ["/World/geo/left"]
    with pytest.raises(ValueError, match="/World/nobody"):
        list(camera_moves.spin(scene, middle, 2, "/World/nobody"))


def test_zoom_and_turntable(asset, capsys):
    """The quad is met where it lies; frames are numbered; a contact sheet holds them."""
    scene = sw.read(asset, camera="/World/camera")
    assert cli.main(["turntable", str(asset), str(asset.with_name("t.##.npz")), "--frames=2", "-w=16", "--spp=2"]) == 1
    assert "shows nothing" in capsys.readouterr().err  # the gap between the quads
    argv = ["zoom", str(asset), str(asset.with_name("z.##.npz")), "--frames=2", "--to=0.5", "-w=16", "--spp=2"]
    assert cli.main([*argv, "--target", "0.011", "0", "0", "--sheet", str(asset.with_name("z.png")), "--json"]) == 0
    record = json.loads(capsys.readouterr().out)
    assert record["target"] == pytest.approx((0.011, 0.0, 0.0))
    near, far = (image.read_layers(asset.with_name(f"z.0{i}.npz"))[0]["depth"][6, 8] for i in (2, 1))
    assert near == pytest.approx(far / 2, rel=0.02) and scene.camera.path == "/World/camera"
    assert cli.main(["zoom", str(asset), str(asset.with_name("z.png"))]) == 2
    assert cli.main(["turntable", str(asset), str(asset.with_name("t.##.png")), "--object", "/World/geo/left"]) == 2
    assert cli.main(["zoom", str(asset), str(asset.with_name("z.##.png")), "--to", "0"]) == 2


def test_the_middle_is_what_is_seen(asset):
    """A camera that looks at the quad meets it at z = 0."""
    scene = sw.read(asset)
    matrix = np.array(scene.camera.transform)
    matrix[0, 3] += 0.011
    hit = camera_moves.middle(replace(scene, camera=replace(scene.camera, transform=matrix))) + scene.origin
    assert hit == pytest.approx((0.011, 0.0, 0.0), abs=2e-5)


def test_pictures_need_a_color(tmp_path):
    image.write_layers({"depth": np.ones((2, 2), np.float32)}, tmp_path / "d.npz")
    with pytest.raises(ValueError, match="no layer color, only depth"):
        pictures.picture(tmp_path / "d.npz", SimpleNamespace())
