from scratchwarp import profiles
from scratchwarp.cli import main


def test_tables_are_counted_and_cleared(tmp_path, monkeypatch, capsys):
    monkeypatch.setenv("SCRATCHWARP_CACHE", str(tmp_path))
    store = profiles.store()
    profiles.simulate(profiles.shape("sine"), resolution=8, rays=16, store=store)
    assert main(["cache"]) == 0
    said = capsys.readouterr().out
    assert str(tmp_path) in said and "tables        1 files" in said and "kernels" in said
    assert main(["cache", "--clear"]) == 0
    assert "tables        0 files" in capsys.readouterr().out
    assert store.count == 0
