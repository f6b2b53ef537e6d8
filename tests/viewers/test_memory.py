"""How much memory a stage that is looked at may take."""

import pytest

from scratchwarp.cli import main

STAGE = """#usda 1.0
def Mesh "m"
{
    int[] faceVertexCounts = [3]
    int[] faceVertexIndices = [0, 1, 2]
    point3f[] points = [(0, 0, 0), (1, 0, 0), (0, 1, 0)]
}
"""


@pytest.mark.parametrize("how", [["--web"], ["--profile"], ["--screenshot", "a.png"]])
def test_a_stage_that_would_take_more_than_it_may_is_refused(how, tmp_path, capsys, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "a.usda").write_text(STAGE)
    assert main(["view", "a.usda", "--max-memory", "1K", *how]) == 1
    assert "raise --max-memory" in capsys.readouterr().err
