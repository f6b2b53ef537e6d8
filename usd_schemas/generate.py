"""Make the generated schema files from schema.usda, or check that they are fresh.

    python usd_schemas/generate.py            writes scratchSchema/resources
    python usd_schemas/generate.py --check    exit status 1 and the names of the files that differ

OpenUSD's own usdGenSchema (it needs jinja2) does the work. It leaves comments in plugInfo.json and drops the
documentation of every attribute; this script makes the one strict JSON and puts the other back, so that a user
interface finds units and ranges at run time.
"""

import argparse
import inspect
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent
LIBRARY = "scratchSchema"
UNITS = {
    "appliesTo": ["attributes"],
    "displayGroup": "Scratch",
    "documentation": "Absolute unit of a scratch attribute, for example micrometer or degree.",
    "type": "token",
}


def plug_info() -> dict:
    """The part of plugInfo.json that is written by hand: usdGenSchema keeps it and adds the types."""
    plugin = {
        "Info": {"SdfMetadata": {"scratchUnits": UNITS}},
        "LibraryPath": "",
        "Name": LIBRARY,
        "ResourcePath": ".",
        "Root": ".",
        "Type": "resource",
    }
    return {"Plugins": [plugin]}


def strict_json(text: str) -> str:
    """``text`` without comment lines and trailing blanks, keys sorted."""
    lines = [line for line in text.splitlines() if not line.lstrip().startswith("#")]
    return json.dumps(json.loads("\n".join(lines)), indent=4, sort_keys=True) + "\n"


def with_documentation(generated: str, source: str) -> str:
    """The generated layer with the documentation that the source gives each class and property."""
    from pxr import Sdf

    written, read = Sdf.Layer.CreateAnonymous(".usda"), Sdf.Layer.CreateAnonymous(".usda")
    written.ImportFromString(generated)
    read.ImportFromString(source)
    for cls in written.rootPrims:
        original = read.GetPrimAtPath(cls.path)
        prefix = original.customData.get("propertyNamespacePrefix", "")
        cls.documentation = inspect.cleandoc(original.documentation)
        for prop in cls.properties:
            name = prop.name.removeprefix(f"{prefix}:__INSTANCE_NAME__:")
            prop.documentation = inspect.cleandoc(original.properties[name].documentation)
    return written.ExportToString()


def generate() -> dict[str, str]:
    """The text of each generated file by its path relative to this folder.

    Raises:
        RuntimeError: usdGenSchema failed; the message holds what it said.
    """
    source = (ROOT / "schema.usda").read_text()
    with tempfile.TemporaryDirectory() as folder:
        out = Path(folder)
        (out / "plugInfo.json").write_text(json.dumps(plug_info()))
        # The plugin path makes the metadata scratchUnits known, to the tool and (below) to this process.
        environ = {**os.environ, "PXR_PLUGINPATH_NAME": folder}
        command = [sys.executable, "-m", "pxr.Usd.usdGenSchema", str(ROOT / "schema.usda"), folder]
        done = subprocess.run(command, env=environ, cwd=folder, capture_output=True, text=True)
        if done.returncode != 0:
            raise RuntimeError(f"usdGenSchema failed on {ROOT / 'schema.usda'}: {done.stdout}{done.stderr}")
        from pxr import Plug

        if Plug.Registry().GetPluginWithName(LIBRARY) is None:
            Plug.Registry().RegisterPlugins(folder)
        generated = with_documentation((out / "generatedSchema.usda").read_text(), source)
        plugins = strict_json((out / "plugInfo.json").read_text())
    resources = f"{LIBRARY}/resources"
    return {
        f"{resources}/generatedSchema.usda": generated,
        f"{resources}/plugInfo.json": plugins,
        f"{resources}/{LIBRARY}/schema.usda": source,
    }


def stale(files: dict[str, str]) -> list[str]:
    """Paths whose file is missing or differs from the text given."""
    return [path for path, text in files.items() if not (ROOT / path).is_file() or (ROOT / path).read_text() != text]


def main(argv: list[str] | None = None) -> int:
    """Write the generated files, or with ``--check`` name those that are stale; returns the exit status."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--check", action="store_true", help="write nothing; exit 1 if a generated file is stale")
    arguments = parser.parse_args(argv)
    files = generate()
    if arguments.check:
        names = stale(files)
        for name in names:
            print(f"stale: {name}; run python {Path(__file__).name}", file=sys.stderr)
        return 1 if names else 0
    for path, text in files.items():
        (ROOT / path).parent.mkdir(parents=True, exist_ok=True)
        (ROOT / path).write_text(text)
        print(f"wrote {path}")
    return 0


if __name__ == "__main__":
    sys.exit(main())
