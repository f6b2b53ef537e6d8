"""Pictures of one stage by several models."""

import numpy as np
import pytest

from scratchwarp import image
from scratchwarp.pipelines import compare_models
from scratchwarp.pipelines.author_demo import author


def test_sheet_and_numbers():
    wanted = np.full((2, 3, 3), 0.5, np.float32)
    pictures = {"singleBounce": 0.5 * wanted, "fullTable": wanted}
    assert compare_models.differences(pictures, "fullTable") == {"singleBounce": (0.5, 0.5), "fullTable": (1.0, 0.0)}
    sheet = compare_models.sheet(pictures, "fullTable")
    assert sheet.shape == (4, 6, 3)
    np.testing.assert_allclose(sheet[2:, :3], 8 * 0.25)
    assert (sheet[2:, 3:] == 0.0).all()


def test_a_stage(tmp_path, capsys):
    stage = author(tmp_path, 0.1, ["ball"])[0]
    arguments = [str(stage), str(tmp_path / "out"), "--models", "singleBounce,mirror", "--reference", "table"]
    assert compare_models.main([*arguments, "--width", "16", "--spp", "4"]) == 0
    printed = [line for line in capsys.readouterr().out.splitlines() if " light " in line]
    assert [line.split()[0] for line in printed] == ["singleBounce", "mirror", "table"]
    light = {line.split()[0]: float(line.split()[2]) for line in printed}
    assert light["singleBounce"] <= 1.001 and light["mirror"] >= light["singleBounce"] and light["table"] == 1.0
    assert sorted(p.name for p in (tmp_path / "out").iterdir()) == [
        "mirror.png", "models.png", "singleBounce.png", "table.png"
    ]  # fmt: skip
    assert image.read_texture(tmp_path / "out" / "models.png", "sRGB").shape[1] == 3 * 16


@pytest.mark.parametrize("models", ["glitter", "singleBounce"])
def test_refusals(tmp_path, capsys, models):
    stage = author(tmp_path, 0.1, ["plain"])[0]
    assert compare_models.main([str(stage), str(tmp_path / "out"), "--models", models, "--width", "8"]) == 1
    assert ("glitter" if models == "glitter" else "scratched") in capsys.readouterr().err
