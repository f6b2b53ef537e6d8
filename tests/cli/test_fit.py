"""scratchwarp fit: a measured BRDF to a material and a report, and what it says when it cannot."""

import json
import sys
from html.parser import HTMLParser

import numpy as np
import pytest

from scratchwarp import image, measured, stencils
from scratchwarp.cli import main
from scratchwarp.reflectance.stencils import Mode, Model
from scratchwarp.stage.validation import validate

TRUTH = Model((Mode(0.5, 0.7, 1.0, 0.01, 0.02, 0.3, 12.0, (0.3, 0.5, 0.9)),), background=0.02, k=1.5, specular_alpha=30)


@pytest.fixture(scope="module")
def file(tmp_path_factory):
    path = tmp_path_factory.mktemp("fit") / "made.bin"
    clean = stencils.unfolded(TRUTH)
    measured.save_utia(path, clean * (1 + 0.01 * np.random.default_rng(0).standard_normal(clean.shape)))
    return path


class _Links(HTMLParser):
    def __init__(self):
        super().__init__()
        self.found, self.open = set(), []

    def handle_starttag(self, tag, attrs):
        self.found |= {value for key, value in attrs if key in ("src", "href")}
        if tag not in ("meta", "img", "path", "polyline"):
            self.open.append(tag)

    def handle_endtag(self, tag):
        if tag not in ("meta", "img", "path", "polyline"):
            assert self.open.pop() == tag


def test_material_and_report(file, tmp_path, capsys):
    """One run: the material is valid, the page is whole, and the stencils beat every rival."""
    out, report = tmp_path / "made.usda", tmp_path / "new" / "report"
    assert main(["fit", str(file), str(out), "--report", str(report), "--json"]) == 0
    told = json.loads(capsys.readouterr().out)
    assert told["written"] == [str(out), str(report / "index.html")]
    assert [str(finding) for finding in validate(out)] == []
    rows = json.loads((report / "fit.json").read_text())["candidates"]
    assert [row["model"] for row in rows] == ["stencils", *measured.RIVALS]
    assert [row["metrics"] for row in rows] == [row["metrics"] for row in told["candidates"]]
    assert rows[0]["metrics"]["psnr"] > max(row["metrics"]["psnr"] for row in rows[1:]) + 5.0
    assert rows[0]["metrics"]["ssim"] > 0.99 and np.degrees(rows[0]["numbers"]["modes"][0]["azimuth"]) == pytest.approx(
        np.degrees(0.5), abs=0.2
    )
    page = _Links()
    page.feed((report / "index.html").read_text())
    assert not page.open
    assert page.found == {f"{n}{d}.png" for n in ("stencils", *measured.RIVALS) for d in ("", "_difference")} | {
        "measurement.png"
    }
    assert all((report / link).stat().st_size > 1000 for link in page.found)
    assert not [p for p in report.iterdir() if p.name.startswith(".")]
    pixels = image.read_texture(report / "side_by_side.png", "raw")
    wide = (pixels.shape[1] - 16) // 3
    first, second, off = (pixels[:, i * (wide + 8) :][:, :wide, :3] for i in range(3))
    # noise of 1 % of a value, 8 bits of the sRGB curve
    assert np.abs(first - second).mean() < 0.02 and first.std() > 0.1 and off.mean() < 0.2 * first.mean()


def test_without_scipy(file, tmp_path, monkeypatch, capsys):
    """It says what to install, or does without."""
    monkeypatch.setitem(sys.modules, "scipy.optimize", None)
    out = tmp_path / "made.usda"
    assert main(["fit", str(file), str(out)]) == 1
    assert "scratchwarp[study]" in capsys.readouterr().err and not out.exists()
    assert main(["fit", str(file), str(out), "--no-refine", "--modes", "1", "--report", str(tmp_path / "r")]) == 0
    told = capsys.readouterr().out
    assert "1 mode" in told and "Kurt" not in told and out.exists()
    assert "left out" in (tmp_path / "r" / "index.html").read_text()


@pytest.mark.parametrize(
    ("argv", "status", "message"),
    [
        (["{bin}", "out.png"], 2, "ends in none of .usda"),
        (["{bin}", "out.usda", "--modes", "0"], 2, "--modes 0"),
        (["missing.bin", "out.usda"], 1, "missing.bin"),
        (["cut.bin", "out.usda"], 1, "cut.bin: 1000 bytes, but a UTIA BRDF has 1990656"),
        (["{bin}", "no/such/out.usda", "--no-refine"], 1, "no/such"),
        (["{bin}", "out.usda", "--no-refine", "--report", "cut.bin"], 1, "choose another --report"),
    ],
)
def test_what_is_wrong_is_said_once(file, tmp_path, monkeypatch, capsys, argv, status, message):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "cut.bin").write_bytes(file.read_bytes()[:1000])
    assert main(["fit", *(word.replace("{bin}", str(file)) for word in argv), "--quiet"]) == status
    captured = capsys.readouterr()
    assert message in captured.err and len(captured.err.strip().splitlines()) == 1
    assert not captured.out and not [p for p in tmp_path.iterdir() if p.name.startswith(".")]


def test_a_scratched_material_seen_from_far_away(tmp_path, capsys):
    """A stage in place of a measurement; materials are asked for by name."""
    from scratchwarp.pipelines import author_demo

    stage = author_demo.author(tmp_path, 0.05, ["kettle"])[0]
    out = tmp_path / "far.usda"
    words = ["fit", str(stage), str(out), "--no-refine"]
    assert main([*words, "--material", "brass", "--json"]) == 0
    row = json.loads(capsys.readouterr().out)["candidates"][0]
    # turned scratches along u: the axis is at 0 or 180 degrees
    turn = np.degrees(row["numbers"]["modes"][0]["azimuth"]) % 180
    assert row["metrics"]["psnr"] > 30.0 and min(turn, 180 - turn) < 3.0
    assert [str(finding) for finding in validate(out)] == []
    assert main([*words, "--material", "wood"]) == 1 and "'wood' is none of" in capsys.readouterr().err
    assert main(["fit", "a.bin", str(out), "--material", "wood"]) == 2
