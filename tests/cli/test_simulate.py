import numpy as np
import pytest

from scratchwarp import image, profiles
from scratchwarp.cli import main
from scratchwarp.pipelines.author_demo import author

SMALL = ["--resolution", "8", "--rays", "16"]


def test_a_named_shape(tmp_path, capsys):
    out = tmp_path / "t.npz"
    assert main(["simulate", "vGroove", str(out), "--depth", "0.3", *SMALL]) == 0
    layers, metadata = image.read_layers(out)
    expected = profiles.simulate(profiles.shape("vGroove", depth=0.3), resolution=8, rays=16)
    np.testing.assert_array_equal(layers["mirror"], expected.mirror)
    np.testing.assert_array_equal(layers["angles"], expected.angles)
    assert metadata["scratchwarp:profile"] == "vGroove"
    assert str(out) in capsys.readouterr().out


def test_exr_has_named_channels(tmp_path):
    assert main(["simulate", "quartic", str(tmp_path / "t.exr"), "--metal", "gold", *SMALL]) == 0
    layers, _ = image.read_layers(tmp_path / "t.exr")
    assert {n: v.shape for n, v in layers.items()} == {
        "mirror": (8, 8),
        "bounce1": (8, 8),
        "bounce2": (8, 8),
        "bounce3": (8, 8),
        "rho": (8, 8, 3),
        "gamma": (8, 8, 3),
    }
    parts = layers["bounce1"] + layers["bounce2"] + layers["bounce3"]
    np.testing.assert_allclose(layers["mirror"], parts, rtol=1e-6)


def test_picture(tmp_path):
    assert main(["simulate", "sine", str(tmp_path / "t.png"), "--quiet", *SMALL]) == 0
    shown = profiles.picture(profiles.simulate(profiles.shape("sine"), resolution=8, rays=16), profiles.shape("sine"))
    read = image.read_texture(tmp_path / "t.png")[..., :3]
    # 8 bits: half a step of the sRGB curve, whose slope towards linear is at most 2.4 / 1.055
    np.testing.assert_allclose(read, shown, atol=0.51 / 255 * 2.4 / 1.055)


@pytest.mark.parametrize(("name", "text"), [("p.txt", "0 0\n0.5 -0.5\n1 0\n"), ("p.csv", "0,0\n0.5,-0.5\n1,0\n")])
def test_a_file_of_points(tmp_path, name, text):
    (tmp_path / name).write_text(text)
    assert main(["simulate", str(tmp_path / name), str(tmp_path / "t.npz"), *SMALL]) == 0
    expected = profiles.simulate(profiles.shape("vGroove", depth=0.5), resolution=8, rays=16)
    np.testing.assert_allclose(image.read_layers(tmp_path / "t.npz")[0]["mirror"], expected.mirror, atol=1e-5)


@pytest.mark.parametrize(
    ("source", "text", "message"),
    [
        ("p.txt", "0 0\n1 nan\n", "points"),
        ("p.txt", "0 0\nb 1\n", "p.txt"),
        ("p.txt", "1 0\n0 0\n", "points"),
    ],
)
def test_points_at_fault_are_1(tmp_path, capsys, source, text, message):
    (tmp_path / source).write_text(text)
    assert main(["simulate", str(tmp_path / source), str(tmp_path / "t.npz"), *SMALL]) == 1
    assert message in capsys.readouterr().err
    assert not (tmp_path / "t.npz").exists()


def test_what_is_neither_shape_nor_file(tmp_path, capsys):
    assert main(["simulate", "quartik", str(tmp_path / "t.npz")]) == 2
    assert "quartic" in capsys.readouterr().err


@pytest.mark.parametrize(
    ("argv", "message"),
    [
        (["quartic", "t.tif"], ".npz"),
        (["quartic", "t.npz", "--depth", "nan"], "depth"),
        (["quartic", "t.npz", "--resolution", "0"], "resolution"),
        (["quartic", "t.npz", "--sampler", "best"], "stratified"),
        (["quartic", "t.npz", "--maxBounces", "0"], "max_bounces"),
        (["quartic", "t.npz", "--metal", "lead"], "copper"),
        (["quartic", "t.npz", "--ior", "0"], "ior"),
        (["quartic", "t.npz", "--metal", "gold", "--ior", "1.5"], "exclude"),
        (["quartic", "t.npz", "--thetaModel", "linear"], "quadratic"),
    ],
)
def test_arguments_that_cannot_be_are_wrong_usage(tmp_path, monkeypatch, capsys, argv, message):
    monkeypatch.chdir(tmp_path)
    assert main(["simulate", *argv]) == 2
    assert message in capsys.readouterr().err and not list(tmp_path.iterdir())


def test_an_empty_file_and_a_layer_that_is_not_there(tmp_path, capsys, recwarn):
    (tmp_path / "p.txt").write_text("\n")
    assert main(["simulate", str(tmp_path / "p.txt"), str(tmp_path / "t.npz")]) == 1
    assert "p.txt: the file is empty" in capsys.readouterr().err and not recwarn.list
    stage = author(tmp_path)[0]
    assert main(["simulate", str(stage), str(tmp_path / "t.npz"), "--layer", "nope"]) == 2
    assert "--layer 'nope' is none of" in capsys.readouterr().err


def test_plot_writes_a_picture_beside_the_table(tmp_path):
    """The picture is colour, the table holds the theta model asked for."""
    out, plot = tmp_path / "q.npz", tmp_path / "q.png"
    words = ["simulate", "quartic", str(out), "--plot", str(plot), "--resolution", "32", "--rays", "16", "--quiet"]
    assert main([*words, "--metal", "iron", "--thetaModel", "table"]) == 0
    assert plot.stat().st_size > 1000
    assert np.load(out)["rho"].shape == (32, 32, 3)
