"""Pages of the documentation that are made of the code: one an effect, the gallery of presets, the reference.

``mkdocs build --config-file mkdocs.yml`` calls these functions; what they make is never written into docs/.
"""

import logging
import re
import sys
import tomllib
from pathlib import Path
from types import SimpleNamespace
from typing import Any

from mkdocs.structure.files import File

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))
FIRST = ("index.md", "conventions.md", "pipelines.md", "farm.md", "look.md", "adding.md")
ROOMS = (
    "optics",
    "scene",
    "stage",
    "profiles",
    "scratches",
    "reflectance",
    "lights",
    "plan",
    "render",
    "image",
    "study",
)


def on_startup(**_: Any) -> None:
    """Two pairs of brackets in a docstring, such as a shape and a unit, are no reference that is missing."""
    for name in ("plugin", "references"):
        logging.getLogger(f"mkdocs.plugins.mkdocs_autorefs._internal.{name}").addFilter(
            lambda record: "api/" not in record.getMessage()
        )


def on_config(config: Any) -> Any:
    """The navigation: the pages of docs/ by their order here, then by name; effects, gallery and reference."""
    docs = Path(config["docs_dir"])
    pages = [name for name in FIRST if (docs / name).is_file()]
    pages += sorted(path.name for path in docs.glob("*.md") if path.name not in FIRST)
    effects = [{"All of them": "effects/index.md"}, *({name: f"effects/{name}.md"} for name in effect_names())]
    api = [{room: f"api/{room}.md"} for room in ROOMS]
    config["nav"] = [*pages, {"Gallery": "gallery.md"}, {"Effects": effects}, {"Reference": api}]
    return config


def on_files(files: Any, config: Any) -> Any:
    """Add the pages that are made."""
    for name, text in made_pages(Path(config["docs_dir"])).items():
        files.append(File.generated(config, name, content=text))
    return files


def on_page_markdown(markdown: str, page: Any, config: Any, files: Any) -> str:
    """Links to files of the repository outside of docs/ become their names."""
    if "/" in page.file.src_uri:  # a page that is made, whose links are right
        return markdown
    return re.sub(r"\[([^\]]+)\]\(\.\./([^)]+)\)", r"\1 (`\2`)", markdown)


def effect_names() -> list[str]:
    """Every effect that a plan decides."""
    from scratchwarp.plan.effects import EFFECTS

    return list(EFFECTS)


def made_pages(docs: Path) -> dict[str, str]:
    """Path -> text of every page that is made."""
    pages = {f"effects/{name}.md": effect(name, docs) for name in effect_names()}
    pages["effects/index.md"] = effect_index()
    pages["gallery.md"] = gallery(docs)
    return pages | {f"api/{room}.md": reference(room) for room in ROOMS}


def told() -> dict[str, dict[str, Any]]:
    """What effects.toml says: family -> picture, pictures, source, page, schema, effects."""
    return tomllib.loads((Path(__file__).parent / "effects.toml").read_text(encoding="utf-8"))


def summary(name: str) -> str:
    """One sentence on an effect: that of effects.toml, or why an empty scene has it not."""
    known = told().get(name.split(".")[0], {}).get("effects", {}).get(name)
    return known or f"An effect of {name.split('.')[0]}; `scratchwarp explain STAGE` says whether a stage calls for it."


def effect(name: str, docs: Path) -> str:
    """The page of one effect."""
    from scratchwarp.plan.knobs import KNOBS

    family = told().get(name.split(".")[0], {})
    picture = family.get("pictures", {}).get(name, family.get("picture", "ball.png"))
    lines = [f"# {name}", "", summary(name), ""]
    if (docs / picture).is_file():
        lines += [f"![{name.split('.')[0]}](../{picture})", ""]
    lines += [
        "## Switch",
        "",
        f"`scratchwarp explain STAGE` says whether a stage calls for it, and why. `--effect {name}=off` and "
        f"`--effect {name}=on` force it, as do `Settings(effects={{{name!r}: False}})` and the render settings' "
        "`scratch:render:enableEffects` and `disableEffects`. An effect that is off leaves no code in the kernel and "
        "no data on the device.",
        "",
        "## Parameters",
        "",
    ]
    knobs = [k for k in KNOBS.values() if name in k.effects or any(name in v for v in k.switches.values())]
    if knobs:
        lines += [
            "| knob | values, the cheapest first | default | goes wrong at cheap values | source |",
            "|---|---|---|---|---|",
        ]
        lines += [
            f"| `{k.name}` | {', '.join(map(str, k.values))} | {k.default} | {k.error} | {k.source or 'ours'} |"
            for k in knobs
        ]
    else:
        lines += ["No knob turns it."]
    if "schema" in family:
        lines += ["", f"Authored by the attributes of `{family['schema']}`:", ""]
        lines += ["| attribute | range | unit | what it is |", "|---|---|---|---|"]
        lines += [
            f"| `{name}` | {limits} | {unit} | {doc} |" for name, limits, unit, doc in attributes(family["schema"])
        ]
    lines += ["", "## Source", "", f"{family.get('source', 'This renderer')}.", "", "## Price", "", price(name), ""]
    page = family.get("page")
    if page and (docs / page).is_file():
        lines += [f"More on it: [{page.removesuffix('.md')}](../{page})."]
    return "\n".join(lines) + "\n"


def price(name: str) -> str:
    """What the cost model of the planner has for an effect."""
    from scratchwarp.plan import cost

    kind = name.partition(".")[2]
    tables = {"lights": getattr(cost, "LIGHT", {}), "scratches": getattr(cost, "SET", {})}
    found = getattr(cost, "OTHER", {}).get(name, tables.get(name.split(".")[0], {}).get(kind))
    if found is None and name == "shadows":
        found = getattr(cost, "SHADOW_RAY", None)
    if found is None:
        return "It has no price of its own: it changes what others cost. `scratchwarp study STAGE DIR` measures it."
    return (
        f"About {found:g} ns for each camera sample that meets it, on one core of 2 GHz; an estimate by which the "
        "planner ranks effects. `scratchwarp explain STAGE` says its share of a stage's time, `scratchwarp study STAGE "
        "DIR` measures it."
    )


def attributes(schema: str) -> list[tuple[str, str, str, str]]:
    """(name, range, unit, first sentence of its documentation) of a schema's attributes, from schema.usda."""
    text = (ROOT / "usd_schemas" / "schema.usda").read_text(encoding="utf-8")
    body = text[text.index(f'class "{schema}"') :]
    end = re.search(r"^class ", body[10:], re.MULTILINE)
    body = body[: end.start() + 10] if end else body
    prefix = "scratch:layer:NAME:" if schema == "ScratchLayerAPI" else ""
    found = []
    declared = r"^    (?:uniform )?(?:rel|[\w\[\]]+) ([\w:]+)(?: = [^\n]*?)? \(\n(.*?)^    \)"
    for match in re.finditer(declared, body, re.DOTALL | re.MULTILINE):
        doc = re.search(r'doc = "{1,3}(.*?)"{1,3}\n', match[2] + "\n", re.DOTALL)
        said = doc[1] if doc else ""
        limits, unit = (re.search(rf"{name}: (.*)", said) for name in ("Range", "Units"))
        sentence = re.split(r"(?<=\.) (?=[A-Z])", " ".join(said.split()))[0].replace("<", "&lt;").replace("|", "&#124;")
        found.append((prefix + match[1], limits[1] if limits else "", unit[1] if unit else "", sentence))
    return found


def effect_index() -> str:
    """All effects with a sentence each."""
    lines = ["# Effects", "", "A plan decides each of these for every stage, with a reason that names the prim.", ""]
    lines += ["| effect | what it is |", "|---|---|"]
    return "\n".join([*lines, *(f"| [{name}]({name}.md) | {summary(name)} |" for name in effect_names())]) + "\n"


def gallery(docs: Path) -> str:
    """The presets with what they say of themselves."""
    lines = ["# Gallery of presets", "", "`scratchwarp author ASSET OUT --preset NAME` puts one on an asset.", ""]
    if (docs / "presets.png").is_file():
        lines += ["![All presets](presets.png)", ""]
    for file in sorted((ROOT / "pipelines" / "presets").glob("*.usda")):
        doc = re.search(r'doc = "{1,3}(.*?)"{1,3}\n', file.read_text(encoding="utf-8"), re.DOTALL)
        lines += [f"## {file.stem}", "", " ".join(doc[1].split()) if doc else "", ""]
    lines += ["`python -m scratchwarp.pipelines.preset_gallery gallery` writes a stage and a picture of each."]
    return "\n".join(lines) + "\n"


def reference(room: str) -> str:
    """The modules of a room, for mkdocstrings; device code has a compiler of its own and stays out."""
    folder = ROOT / "scratchwarp" / room
    files = [f for f in sorted(folder.rglob("*.py")) if not re.search(r"_(device|kernels?)$", f.stem)]
    lines = [f"# scratchwarp.{room}", ""]
    for file in files:
        parts = file.relative_to(ROOT).with_suffix("").parts
        name = ".".join(parts[:-1] if parts[-1] == "__init__" else parts)
        lines += [f"::: {name}", "    options:", "      heading_level: 2", ""]
    return "\n".join(lines)


if __name__ == "__main__":  # what the pages say, without mkdocs
    print(SimpleNamespace(pages=sorted(made_pages(ROOT / "docs"))).pages)
