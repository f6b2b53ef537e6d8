"""Cross-sections out of height maps: made ones with a known answer, and measured ones."""

import json
import os
from pathlib import Path

import numpy as np
import pytest

from scratchwarp.pipelines import looks, topography
from scratchwarp.pipelines import profile_from_topography as pipeline

SHARED = Path(os.environ.get("SCRATCHWARP_SHARED", Path(__file__).parents[2].parent / "shared")) / "data/topography"


def made(direction, noise=0.002, seed=0):
    """A tilted, wavy, noisy map of 200 x 160 um with one V groove 12 um wide and 0.3 um deep, with rims, at
    ``direction``; and a pit."""
    rng = np.random.default_rng(seed)
    y, x = np.meshgrid(np.arange(400) * 0.4, np.arange(500) * 0.4, indexing="ij")
    across = -np.sin(direction) * (x - 100) + np.cos(direction) * (y - 80) - 15.0
    height = np.where(np.abs(across) < 6, -0.3 * (1 - np.abs(across) / 6), 0.0)
    height += np.where(
        (np.abs(across) > 6) & (np.abs(across) < 9), 0.06 * np.sin(np.pi * (np.abs(across) - 6) / 3), 0.0
    )
    height[np.hypot(x - 40, y - 30) < 8] -= 1.0
    height += 0.003 * x - 0.001 * y + 0.2 * np.sin(x / 60) + rng.normal(0, noise, x.shape)
    return pipeline.Topography(height, 0.4, 0.4)


@pytest.mark.parametrize("degrees", [0.0, 27.3, 90.0, 141.8])
def test_made_groove_is_found(degrees):
    """Direction within half a degree; width between the crests of its rims, 15 um, and depth below them, 0.36 um,
    roughly."""
    topography = pipeline.without_waviness(pipeline.levelled(made(np.radians(degrees))), 120.0)
    found = pipeline.section(topography)
    turn = (np.degrees(found.direction) - degrees + 90) % 180 - 90
    assert abs(turn) < 0.5
    # noise moves the crests by up to 1 um, where they are lower by 0.8 %; the filter takes a little of 12 um against
    # 120
    assert found.width == pytest.approx(15.0, abs=2.0)
    # the tip is averaged over 0.4 um of 6 and over the error of the direction, 0.4 degrees of 160 um
    assert found.depth == pytest.approx(0.36, rel=0.15)
    assert found.points[0].tolist() == [0.0, 0.0] and found.points[-1].tolist() == [1.0, 0.0]
    assert found.points[:, 1].min() == -1.0


def test_whole_profile_and_thinning():
    """The whole mean profile is one period; thinning keeps every height within the tolerance."""
    topography = pipeline.levelled(made(0.0))
    whole = pipeline.section(topography, 0.0, whole=True)
    assert whole.periodic and whole.width == pytest.approx(400 * 0.4, rel=0.02)
    few = pipeline.thinned(whole, 0.02)
    assert len(few.x) < 0.5 * len(whole.x)
    assert np.abs(np.interp(whole.x, few.x, few.z) - whole.z).max() <= 0.02 + 1e-12


def test_an_image_becomes_a_look(tmp_path, capsys):
    """A picture of heights, black to white 2 um: a valid preset that ``author`` takes, and a page."""
    from scratchwarp.image import quick
    from scratchwarp.stage.validation import validate

    heights = made(0.0).height
    low, high = heights.min(), heights.max()
    grey = np.rint(255 * (heights - low) / (high - low)).astype(np.uint8)
    source, out = tmp_path / "scan.png", tmp_path / "scan.usda"
    source.write_bytes(quick.png(np.ascontiguousarray(np.repeat(grey[..., None], 3, -1))))
    assert topography.main([str(source), str(out)]) == 1
    assert "--pitch" in capsys.readouterr().err
    size = ["--pitch", "0.4", "--height", str(high - low), "--direction", "0"]
    assert topography.main([str(source), str(out), *size, "--metal", "brass", "--json"]) == 0
    record = json.loads(capsys.readouterr().out)
    # 8 bits are 7 nm of 1.8 um, averaged along the groove
    assert record["depth_um"] == pytest.approx(0.36, rel=0.2) and not record["periodic"]
    assert [f for f in validate(out) if f.severity != "info"] == []
    look = looks.read_preset(out)
    assert look.layers == ("measured",) and look.values["scratch:layer:measured:width"] == pytest.approx(
        record["width_um"], rel=1e-6
    )
    assert topography.main([str(source), str(source), *size]) == 1
    assert topography.main([str(source), "x.obj", *size]) == 2


def test_command_writes_a_profile_that_can_be_simulated(tmp_path):
    """NPZ in metres to USD, and to CSV in micrometres; the layer carries width and depth."""
    from pxr import Usd

    from scratchwarp import profiles

    source = tmp_path / "map.npz"
    np.savez(source, height_m=made(0.5).height * 1e-6, dx_m=0.4e-6, dy_m=0.4e-6)
    arguments = ["--waviness", "120", "--tolerance", "0.003"]
    assert topography.main([str(source), str(tmp_path / "groove.usda"), *arguments]) == 0
    first = (tmp_path / "groove.usda").read_bytes()
    assert topography.main([str(source), str(tmp_path / "groove.usda"), *arguments]) == 0
    assert (tmp_path / "groove.usda").read_bytes() == first
    assert topography.main([str(source), str(tmp_path / "groove.csv"), *arguments]) == 0
    stage = Usd.Stage.Open(str(tmp_path / "groove.usda"))
    points = np.array(stage.GetPrimAtPath("/Measured/Section").GetAttribute("scratch:points").Get())
    micrometres = np.loadtxt(tmp_path / "groove.csv", delimiter=",")
    layer = stage.GetPrimAtPath("/Measured")
    size = [layer.GetAttribute(f"scratch:layer:measured:{n}").Get() for n in ("width", "depth")]
    np.testing.assert_allclose(points * size, micrometres, atol=1e-3)
    table = profiles.simulate(profiles.Profile(micrometres), resolution=32, rays=128)
    np.testing.assert_allclose((table.mirror * table.weights[:, None]).sum(axis=0) + table.lost, 1.0, atol=1e-5)


@pytest.mark.parametrize("name", ["ground_lay_plu-1.npz", "isolated_scratches_nms-1.npz"])
def test_measured_maps(name, tmp_path):
    """Real surfaces: ground metal lies along the rows; a lone scratch, not the pit beside it, is found on the other."""
    if not (SHARED / name).exists():
        pytest.skip(f"the measured map {name} is not here")
    topography = pipeline.without_waviness(pipeline.levelled(pipeline.load(SHARED / name)), 80.0)
    found = pipeline.section(topography)
    degrees = np.degrees(found.direction)
    if name.startswith("ground"):
        assert min(degrees, 180 - degrees) < 3.0
        assert 5.0 < found.width < 40.0 and 0.01 < found.depth < 0.2
    else:
        assert 5.0 < degrees < 12.0
        assert found.width < 5.0 and 0.01 < found.depth < 0.1


@pytest.mark.parametrize("content", ["lacking", "small", "flat", "text"])
def test_bad_maps_are_refused(content, tmp_path, capsys):
    """Status 1 and one clear line."""
    source = tmp_path / "map.npz"
    if content == "lacking":
        np.savez(source, height_m=np.zeros((32, 32)))
    elif content == "small":
        np.savez(source, height_m=np.zeros((4, 4)), dx_m=1e-6, dy_m=1e-6)
    elif content == "flat":
        np.savez(source, height_m=np.zeros((32, 32)), dx_m=1e-6, dy_m=1e-6)
    else:
        source = tmp_path / "map.csv"
        np.savetxt(source, np.zeros((32, 32)), delimiter=",")
    assert topography.main([str(source), str(tmp_path / "out.usda")]) == 1
    error = capsys.readouterr().err
    assert error.startswith("topography: ") and len(error.splitlines()) == 1
    assert not (tmp_path / "out.usda").exists()


def test_what_is_no_height_map_is_named(tmp_path):
    for name, data in (("a.npz", b"no zip"), ("a.npy", b"nothing"), ("a.txt", b"(1, 2)"), ("b.npz", b"")):
        (tmp_path / name).write_bytes(data)
        with pytest.raises(ValueError, match=f"{name}: holds no height map"):
            pipeline.load(tmp_path / name, pitch=1.0)
    with pytest.raises(FileNotFoundError, match="nowhere.npz: no such file"):
        pipeline.load(tmp_path / "nowhere.npz")
