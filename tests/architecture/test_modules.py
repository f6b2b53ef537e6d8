"""What every module owes its reader."""

import ast
import re

from .house import modules

LINES = 400

# module: reason for being longer.
LONGER: dict[str, str] = {}

# module:name: reason for having no docstring of its own.
UNDOCUMENTED: dict[str, str] = {}

FORBIDDEN = re.compile(r"(^|_)(utils?|common|helpers?|managers?|core)(_|$)", re.IGNORECASE)


def test_modules_are_small():
    long = {m.name: m.text.count("\n") for m in modules() if m.text.count("\n") > LINES and m.name not in LONGER}
    assert not long, f"over {LINES} lines: {long}"


def test_public_names_are_documented():
    missing = []
    for module in modules():
        if not ast.get_docstring(module.tree) and module.text.strip():
            missing.append(f"{module.path}: the module")
        for name, node in _public(module.tree):
            if not ast.get_docstring(node) and f"{module.name}:{name}" not in UNDOCUMENTED:
                missing.append(f"{module.path}:{node.lineno}: {name}")
    assert not missing, "without a docstring:\n" + "\n".join(missing)


def test_names_come_from_the_field():
    wrong = [m.name for m in modules() if any(FORBIDDEN.search(part) for part in m.name.split("."))]
    assert not wrong


def test_warp_modules_have_real_annotations():
    """Warp reads the annotations of functions defined in closures, which the future import turns into text."""
    future = [m for m in modules() if ("__future__.annotations" in (name for name, _ in m.imports()))]
    assert not [m.path for m in future if m.decorated("wp.func", "wp.kernel", "wp.struct")]


def test_kernels_are_not_launched_where_they_are_defined():
    wrong = [m.path for m in modules() if m.decorated("wp.func", "wp.kernel") and "wp.launch" in m.text]
    assert not wrong, "host code and device code live in different files"


def test_kernels_have_no_backward_pass():
    """An adjoint doubles the compile time and nothing here asks for gradients."""
    wrong = [m.path for m in modules() if m.decorated("wp.kernel") and "enable_backward" not in m.text]
    assert not wrong


def test_nothing_is_swept_aside():
    pattern = re.compile(r"\b(TODO|FIXME|XXX)\b|except[^\n]*:\s*pass\b|#\s*noqa")
    wrong = [f"{m.path}: {found[0]!r}" for m in modules() if (found := pattern.search(m.text))]
    assert not wrong


def _public(tree: ast.Module):
    """(name, node) of public functions, classes and their public methods; the body of a function is its own affair."""
    for node in tree.body:
        if isinstance(node, ast.FunctionDef | ast.ClassDef) and not node.name.startswith("_"):
            yield node.name, node
            if isinstance(node, ast.ClassDef):
                for inner in node.body:
                    if isinstance(inner, ast.FunctionDef) and not inner.name.startswith("_"):
                        yield f"{node.name}.{inner.name}", inner
