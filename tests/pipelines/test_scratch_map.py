"""Scratch maps as files: seamless, as rough as engraved, and on a stage that every program reads."""

import numpy as np
import pytest
from pxr import Usd, UsdShade

import scratchwarp as sw
from scratchwarp import image, mdf
from scratchwarp.cli import main as cli
from scratchwarp.pipelines import scratch_map as pipeline
from scratchwarp.stage.validation import validate


def test_tiles_meet(tmp_path):
    """Across an edge neighbours differ no more than they do inside: on sampled rows and columns, as the map is
    turned over its edges, the slopes are one torus."""
    out = tmp_path / "worn.png"
    assert pipeline.main([str(out), "--resolution", "256", "--density", "400", "--width", "0.05", "--seed", "3"]) == 0
    n = image.read_normals(out).astype(float)
    for axis in (0, 1):
        steps = np.linalg.norm(n - np.roll(n, 1, axis=axis), axis=-1).mean(axis=1 - axis)
        # the first step is the one across the edge; 256 pixels: means of steps scatter by a few per cent
        assert steps[0] < steps[1:].mean() + 4.0 * steps[1:].std() and steps[0] > 0.5 * steps[1:].mean()
    slope = -n[..., :2] / n[..., 2:]
    # a height on a torus rises as much as it falls; 16 bits and the jump at each rim, sampled
    assert np.all(np.abs(slope.mean(axis=(0, 1))) < 0.01 * np.abs(slope).mean())
    normal = n.mean(axis=(0, 1))
    assert np.linalg.norm(normal[:2]) < 0.01 * normal[2]


@pytest.mark.parametrize("depth", [0.1, 0.3])
def test_slopes_are_those_of_the_cap(tmp_path, depth):
    """Mean squares along and across of one pit: integrals of a spherical cap stretched to an ellipse.

    With half-axes a, b, sag s = depth width / b and R = (1 + s^2) / (2 s), the slope is b r / sqrt(R^2 - r^2) in units
    of the disk; int r^3 / (R^2 - r^2) dr = -(1 + R^2 ln(1 - 1 / R^2)) / 2 over r in [0, 1].
    """
    a, b = 0.25, 0.05
    out = tmp_path / "pit.exr"
    pipeline.author(
        out, resolution=(1024, 512), density=1, length=2 * a, width=2 * b, depth=depth, direction=0.0, variation=0.0
    )
    n = image.read_normals(out).astype(float)
    slope = n[..., :2] / n[..., 2:]
    s = depth * 2 * b / b
    r2 = (1 + s * s) / (2 * s)
    ring = -0.5 * np.pi * (1.0 + r2**2 * np.log(1.0 - 1.0 / r2**2))
    along, across = b**2 * (b / a) * ring, b**2 * (a / b) * ring
    # pixels of 1 / 512 across a rim where the slope jumps, on 1000 pixels of rim
    np.testing.assert_allclose(np.mean(slope**2, axis=(0, 1)), [along, across], rtol=0.02)


def test_the_stage(tmp_path):
    """Valid, the texture found from the stage's own folder, its network what a UsdPreviewSurface needs."""
    out, stage_path = tmp_path / "maps" / "hair.png", tmp_path / "plate.usda"
    out.parent.mkdir()
    words = ["scratchmap", str(out), "--resolution", "64", "32", "--direction", "30", "--stage", str(stage_path)]
    assert cli([*words, "--repeat", "2", "--quiet"]) == 0
    assert [str(finding) for finding in validate(stage_path)] == []
    stage = Usd.Stage.Open(str(stage_path))
    surface, _, _ = UsdShade.Material(stage.GetPrimAtPath("/Scratched/metal")).ComputeSurfaceSource()
    texture = UsdShade.Shader(surface.GetInput("normal").GetConnectedSources()[0][0].source.GetPrim())
    assert texture.GetInput("file").Get().path == "./maps/hair.png"
    assert tuple(texture.GetInput("scale").Get())[:3] == (2, 2, 2)
    scene = sw.read(stage_path)
    assert not [w for w in scene.warnings if "normal" in w]
    material = scene.materials[scene.instances[0].materials[0]]
    assert material.layers[0].model == "normalMap" and material.layers[0].normal_map.repeats == (1.0, 1.0)
    wanted = mdf.scratch_map((64, 32), direction=np.radians(30.0))
    found = scene.textures[material.surface.normal.texture].pixels
    np.testing.assert_allclose(2.0 * np.asarray(found)[..., :3] - 1.0, wanted, atol=3e-5)


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (["map.jpg"], ".png, .exr"),
        (["map.png", "--depth", "-1"], "depth"),
        (["map.png", "--resolution", "0"], "resolution"),
        (["map.png", "--stage", "a.obj"], ".usda"),
        (["map.png", "--stage", "a.usda", "--repeat", "0"], "repeat"),
    ],
)
def test_bad_arguments_write_nothing(tmp_path, monkeypatch, capsys, words, message):
    monkeypatch.chdir(tmp_path)
    assert pipeline.main(words) == 1 and cli(["scratchmap", *words]) == 2
    errors = capsys.readouterr().err.splitlines()
    assert len(errors) == 2 and all(message in line for line in errors)
    assert not list(tmp_path.iterdir())
