"""The documentation builds without warnings, with a page for each effect."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from scratchwarp.plan.effects import EFFECTS

ROOT = Path(__file__).resolve().parents[2]
SITE = ROOT / "docs" / "site"


def test_every_effect_is_described():
    """Either by the family it belongs to or by a line of its own; what is described exists."""
    import tomllib

    families = tomllib.loads((SITE / "effects.toml").read_text(encoding="utf-8"))
    assert {name.split(".")[0] for name in EFFECTS} <= set(families)
    for name, family in families.items():
        assert (ROOT / "docs" / family["picture"]).is_file() and (ROOT / "docs" / family["page"]).is_file(), name
        assert set(family["effects"]) <= set(EFFECTS), name


def test_the_site_builds_without_warnings(tmp_path):
    for library in ("mkdocs", "material", "mkdocstrings"):
        pytest.importorskip(library)
    command = [sys.executable, "-m", "mkdocs", "build", "--strict", "-d", str(tmp_path / "site")]
    env = {**os.environ, "NO_MKDOCS_2_WARNING": "1"}
    done = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, env=env)
    assert done.returncode == 0, done.stderr[-3000:]
    site = tmp_path / "site"
    for name in EFFECTS:
        text = (site / "effects" / name / "index.html").read_text(encoding="utf-8")
        assert all(
            f">{part}<" in text.replace("\n", "") or f'id="{part.lower()}"' in text for part in ("Source", "Price")
        )
        assert "<img" in text, name
    assert "make_plan" in (site / "api" / "plan" / "index.html").read_text(encoding="utf-8")
    gallery = (site / "gallery" / "index.html").read_text(encoding="utf-8")
    assert gallery.count("<h2") >= 12
    assert not (site / "site").exists(), "sources of the site are not part of it"
