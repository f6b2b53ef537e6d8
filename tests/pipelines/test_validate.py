"""``scratchwarp validate``: what it says, and its status."""

import json

import pytest

from scratchwarp import cli
from scratchwarp.pipelines import looks
from scratchwarp.pipelines.put_on import put_on


def test_a_worn_asset_is_valid_in_every_state_of_wear(asset, capsys):
    put_on(asset, asset.with_name("worn.usda"), looks.read_preset(looks.presets()["vinyl"]), "*")
    assert cli.main(["validate", str(asset.with_name("worn.usda")), "--strict"]) == 0
    assert "nothing to find fault with in 3 combinations of variants" in capsys.readouterr().out


@pytest.mark.parametrize("options, status", [([], 0), (["--strict"], 1), (["--strict", "--fix=fixed.usda"], 0)])
def test_status_and_json(asset, capsys, monkeypatch, options, status):
    """A property without effect is a warning, and a fix removes it."""
    monkeypatch.chdir(asset.parent)
    text = asset.read_text().replace('def Material "wood"\n        {', 'def Material "wood"\n        {\n'
                                     "            float scratch:layer:gone:width = 1")  # fmt: skip
    asset.write_text(text)
    assert cli.main(["validate", "cup.usda", "--json", *options]) == status
    record = json.loads(capsys.readouterr().out)
    if len(options) == 2:
        assert record["findings"] == [] and "gone" in record["fixed"][0]
    else:
        assert [row["severity"] for row in record] == ["warning"]
        assert cli.main(["validate", "cup.usda", "--quiet", *options]) == status
        assert capsys.readouterr().out.startswith("warning: /World/mtl/wood: scratch:layer:gone:width has no effect")
    assert asset.read_text() == text
