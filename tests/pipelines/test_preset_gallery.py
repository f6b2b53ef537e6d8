"""The gallery: every preset has a valid stage of its own."""

from scratchwarp.pipelines import looks, preset_gallery
from scratchwarp.stage.validation import validate


def test_every_preset_has_a_valid_stage(tmp_path):
    stages = preset_gallery.author(tmp_path)
    assert [stage.stem for stage in stages] == list(looks.presets())
    for stage in stages[::4]:
        assert [str(finding) for finding in validate(stage)] == []
    assert not set(preset_gallery.DISCS + preset_gallery.PLATES) - set(looks.presets())


def test_usage(tmp_path, capsys):
    assert preset_gallery.main([str(tmp_path), "--only", "chrome"]) == 1
    assert "'chrome' is none of brushed-aluminium" in capsys.readouterr().err
