"""The README's two commands are the ones that run, and its map shows every room."""

import re
from pathlib import Path

from .house import ROOMS, modules, repository

README = repository() / "README.md"
INSTALL = "python -m pip install . && scratchwarp demo out"
TEST = 'python -m pip install -e ".[test]" && python -m pytest'


def test_the_two_commands_stand_in_the_readme():
    blocks = re.findall(r"```(?:sh|bash|console)\n(.*?)```", README.read_text(encoding="utf-8"), re.DOTALL)
    lines = [line.strip() for block in blocks for line in block.splitlines()]
    assert INSTALL in lines and TEST in lines


def test_ci_runs_the_command_of_the_readme():
    assert TEST in (repository() / ".ci" / "run").read_text(encoding="utf-8").splitlines()


def test_the_map_shows_every_room():
    text = README.read_text(encoding="utf-8")
    rooms = {m.room for m in modules()} & set(ROOMS) - {"__main__"}
    missing = [room for room in sorted(rooms) if f"{room}/" not in text and f"{room}.py" not in text]
    assert not missing


def test_files_that_the_readme_names_exist():
    targets = re.findall(r"\]\(([^)#:]+)\)", README.read_text(encoding="utf-8"))
    assert targets
    assert not [t for t in targets if not (README.parent / t).exists()]


def test_licence_and_changelog():
    assert "Apache License" in (repository() / "LICENSE").read_text(encoding="utf-8")
    changes = (repository() / "CHANGELOG.md").read_text(encoding="utf-8")
    assert re.search(r"^## Unreleased|^## 0\.1\.0", changes, re.MULTILINE)


def test_no_binary_assets():
    """Stages are written by scripts; pictures are those of the README and the docs, and small."""
    kinds = (".exr", ".hdr", ".usdc", ".usdz", ".png", ".jpg", ".npz", ".bin")
    folders = ("docs", "pipelines", "scratchwarp", "tests", "usd_schemas", "viewers")
    files = [p for folder in folders for p in (repository() / folder).rglob("*") if p.suffix in kinds]
    pictures = ("ball", "profiles_shapes", "anisotropy_bumps", "anisotropy_scratches", "models", "diffraction")
    pictures += ("grooves", "grooves_scenes", "materials", "presets", "zoom")
    assert {p.relative_to(repository()) for p in files} <= {Path(f"docs/{name}.png") for name in pictures}
    assert all(p.stat().st_size < 400_000 for p in files)


def test_the_material_of_the_readme_is_valid(tmp_path):
    """Wrapped into a stage as it stands, it gives the validator nothing to find."""
    from scratchwarp.stage.validation import validate

    (block,) = re.findall(r"```usda\n(.*?)```", README.read_text(encoding="utf-8"), re.DOTALL)
    stage = tmp_path / "stage.usda"
    head = '#usda 1.0\n(\n    defaultPrim = "World"\n    metersPerUnit = 1\n    upAxis = "Y"\n)\n'
    stage.write_text(f'{head}def Xform "World"\n{{\n{block}}}\n')
    assert [str(finding) for finding in validate(stage)] == []
