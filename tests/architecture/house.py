"""The house as files and syntax trees: rooms, modules, imports."""

import ast
import functools
import importlib.util
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

# Who may import whom: a room imports only from itself and from rooms before it.
ROOMS = (
    "usd_schemas",
    "lazy",
    "whole",
    "optics",
    "scene",
    "stage",
    "profiles",
    "scratches",
    "reflectance",
    "lights",
    "plan",
    "kernels",
    "render",
    "image",
    "study",
    "frames",
    "pipeline",
    "pipelines",
    "viewers",
    "arguments",
    "sections",
    "shots",
    "studies",
    "cli",
    "__main__",
)


@dataclass(frozen=True)
class Module:
    """One source file: its dotted name below ``scratchwarp`` ("" for the package itself) and its path."""

    name: str
    path: Path

    @property
    def room(self) -> str:
        return self.name.split(".")[0]

    @functools.cached_property
    def text(self) -> str:
        return self.path.read_text(encoding="utf-8")

    @functools.cached_property
    def tree(self) -> ast.Module:
        return ast.parse(self.text, str(self.path))

    def imports(self) -> Iterator[tuple[str, int]]:
        """(dotted name, line) of everything imported anywhere in the module, relative names made absolute.

        ``from a import b`` gives ``a.b``, for ``b`` may be a module.
        """
        package = ["scratchwarp", *self.name.split(".")] if self.name else ["scratchwarp"]
        if self.path.name != "__init__.py":
            package = package[:-1]
        for node in ast.walk(self.tree):
            if isinstance(node, ast.Import):
                yield from ((alias.name, node.lineno) for alias in node.names)
            elif isinstance(node, ast.ImportFrom):
                base = package[: len(package) - node.level + 1] if node.level else []
                base = base + (node.module.split(".") if node.module else [])
                yield from ((".".join([*base, alias.name]), node.lineno) for alias in node.names)

    def decorated(self, *decorators: str) -> bool:
        """Whether anything in the module carries one of the decorators, such as ``wp.kernel``."""
        return any(
            ast.unparse(d.func if isinstance(d, ast.Call) else d) in decorators
            for node in ast.walk(self.tree)
            if isinstance(node, ast.FunctionDef | ast.ClassDef)
            for d in node.decorator_list
        )


@functools.cache
def modules() -> tuple[Module, ...]:
    """Every source file of the package, wherever its folder lives."""
    roots = {"": _folder("scratchwarp")}
    for name in ("pipelines", "usd_schemas", "viewers"):
        roots[name] = _folder(f"scratchwarp.{name}")
    found = {}
    for prefix, root in roots.items():
        for path in sorted(root.rglob("*.py")):
            parts = list(path.relative_to(root).with_suffix("").parts)
            parts = parts[:-1] if parts[-1] == "__init__" else parts
            name = ".".join(part for part in (prefix, *parts) if part)
            found[name] = Module(name, path)
    return tuple(found.values())


def _folder(package: str) -> Path:
    spec = importlib.util.find_spec(package)
    assert spec is not None and spec.submodule_search_locations, f"{package} is not installed"
    return Path(next(iter(spec.submodule_search_locations)))


def repository() -> Path:
    """The checkout that these tests lie in."""
    return Path(__file__).resolve().parents[2]
