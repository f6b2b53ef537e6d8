"""What the renderer costs: threads, and effects that are off. Run it by hand on an idle machine:

    python tests/benchmarks/render.py [--repeats 7]

Every figure is a ratio of two renders of one run, taken in turn so that the machine's drift hits both alike. The bars:
two threads at least 1.8 times as fast as one; a stage without scratches within 3 % of a kernel that holds no scratch
code at all.
"""

import argparse
import ast
import importlib.util
import statistics
import sys
import tempfile
from functools import partial
from pathlib import Path

import scratchwarp as sw
from scratchwarp.pipelines.author_demo import author
from scratchwarp.render import renderer

KERNELS = Path(renderer.__file__).parent.parent / "kernels"


class Bare(ast.NodeTransformer):
    """Takes out of the kernels' source what is there for scratches, even where it is switched off."""

    FIELDS = ("scratch", "table", "row", "sin_theta")

    def visit_Attribute(self, node):
        self.generic_visit(node)
        if isinstance(node.value, ast.Name) and node.value.id == "lobe" and node.attr in self.FIELDS:
            return ast.Constant(0)
        return node

    def visit_Name(self, node):
        if node.id == "first_scratch" and isinstance(node.ctx, ast.Load):
            return ast.Constant(0)
        return node

    def visit_ClassDef(self, node):
        if node.name == "Lobe":
            node.body = [n for n in node.body if not (isinstance(n, ast.AnnAssign) and n.target.id in self.FIELDS)]
        return self.generic_visit(node)

    def visit_Assign(self, node):
        target = node.targets[0]
        if isinstance(target, ast.Attribute) and isinstance(target.value, ast.Name) and target.value.id == "lobe":
            if target.attr in self.FIELDS:
                return ast.Pass()
        if isinstance(target, ast.Name) and target.id == "first_scratch":
            return ast.Pass()
        return self.generic_visit(node)

    def visit_If(self, node):
        self.generic_visit(node)
        scratch = "key.scratches" in ast.unparse(node.test)
        constant = isinstance(node.test, ast.Compare) and isinstance(node.test.left, ast.Constant)
        if scratch:
            return node.orelse or ast.Pass()
        if constant and all(isinstance(c, ast.Constant) for c in node.test.comparators):
            taken = eval(ast.unparse(node.test))
            return (node.body if taken else node.orelse) or ast.Pass()
        return node


def bare_make_kernel(folder: Path):
    """``make_kernel`` of a copy of the kernels without scratch code."""
    package = folder / "bare_kernels"
    package.mkdir()
    for path in KERNELS.glob("*.py"):
        tree = ast.fix_missing_locations(Bare().visit(ast.parse(path.read_text())))
        source = ast.unparse(tree).replace("from ..", "from scratchwarp.")
        if path.name == "__init__.py":
            source = ""
        (package / path.name).write_text(source)
    sys.path.insert(0, str(folder))
    assert importlib.util.find_spec("bare_kernels")
    from bare_kernels.render_device import make_kernel

    return make_kernel


def seconds(scene, plan) -> float:
    film = sw.render(scene, plan)
    assert film.stats["invalid_samples"] == 0
    return film.stats["trace"]


def paired(first, second, repeats: int) -> tuple[float, float, float]:
    """Medians of both and of the ratio second / first, runs taken in turn."""
    first(), second()
    pairs = [(first(), second()) for _ in range(repeats)]
    ratio = statistics.median(b / a for a, b in pairs)
    return statistics.median(a for a, _ in pairs), statistics.median(b for _, b in pairs), ratio


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--repeats", type=int, default=7)
    parser.add_argument("--width", type=int, default=320)
    repeats = parser.parse_args().repeats
    width = parser.parse_args().width
    failures = 0
    with tempfile.TemporaryDirectory() as folder:
        stages = {Path(p).stem: str(p) for p in author(folder)}
        plain = sw.read(stages["plain"])
        for name in ("plain", "kettle"):
            scene = sw.read(stages[name])
            plans = [sw.make_plan(scene, sw.Settings(width=width, spp=16, threads=t)) for t in (1, 2)]
            one, two, ratio = paired(*(partial(seconds, scene, plan) for plan in plans), repeats)
            good = 1 / ratio >= 1.8
            failures += not good
            print(
                f"threads, {name}: 1 {one:.3f} s, 2 {two:.3f} s, {1 / ratio:.2f} times {'ok' if good else 'BELOW 1.8'}"
            )

        from scratchwarp.kernels import render_device

        ours, bare = render_device.make_kernel, bare_make_kernel(Path(folder))
        plan = sw.make_plan(plain, sw.Settings(width=width, spp=16, threads=1))

        def with_kernel(factory):
            def run() -> float:
                render_device.make_kernel = factory
                try:
                    return seconds(plain, plan)
                finally:
                    render_device.make_kernel = ours

            return run

        base, mine, ratio = paired(with_kernel(bare), with_kernel(ours), repeats)
        good = ratio <= 1.03
        failures += not good
        verdict = "ok" if good else "ABOVE 3 %"
        print(f"plain stage: bare {base:.3f} s, ours {mine:.3f} s, {100 * (ratio - 1):+.1f} % {verdict}")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
