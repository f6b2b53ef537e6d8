"""What setuptools is told matches what lies in the folders."""

import tomllib

from .house import repository

SETTINGS = tomllib.loads((repository() / "pyproject.toml").read_text(encoding="utf-8"))


def test_every_folder_of_modules_is_packed():
    """A package missing in this list is missing in the wheel, though the editable install has it."""
    found = set()
    for folder in ("scratchwarp", "pipelines", "usd_schemas", "viewers"):
        for path in (repository() / folder).rglob("*.py"):
            name = ".".join(path.parent.relative_to(repository()).parts)
            found.add(name if folder == "scratchwarp" else f"scratchwarp.{name}")
    assert found == set(SETTINGS["tool"]["setuptools"]["packages"])


def test_every_data_file_is_packed():
    patterns = SETTINGS["tool"]["setuptools"]["package-data"]
    folders = SETTINGS["tool"]["setuptools"]["package-dir"]
    packed = set()
    for package, globs in patterns.items():
        folder = repository() / folders.get(package, package.replace(".", "/"))
        packed |= {path for pattern in globs for path in folder.glob(pattern)}
    kinds = (".csv", ".json", ".usda", ".typed", ".html", ".js", ".css")
    roots = ("scratchwarp", "pipelines", "usd_schemas", "viewers")
    data = {
        path
        for root in roots
        for path in (repository() / root).rglob("*")
        if path.suffix in kinds or path.name == "py.typed"
    }
    assert data <= packed


def test_the_version_is_said_once():
    import scratchwarp

    assert SETTINGS["project"]["version"] == scratchwarp.__version__
