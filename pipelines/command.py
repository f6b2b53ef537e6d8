"""What a pipeline has in common with every other: a sub-command of scratchwarp, and a script that runs alone."""

import argparse
import json
import sys
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any


class WrongUsage(ValueError):
    """The command line contradicts itself or lacks something."""


@dataclass(frozen=True)
class Report:
    """What a pipeline did.

    Attributes:
        record: the same for programs: what ``--json`` prints.
        lines: for people, unless ``--quiet``. status: of the process, 0 or 1.
        findings: for people in any case, before the lines.
    """

    record: Mapping[str, Any] | Sequence[Any]
    lines: tuple[str, ...] = ()
    status: int = 0
    findings: tuple[str, ...] = ()


@dataclass(frozen=True)
class Command:
    """One pipeline.

    Attributes:
        name: on the command line. says: one line, beginning small. examples: command lines.
        add_arguments: gives a parser its arguments.
        run: what the parser made of them, with ``quiet`` and ``json``, to a Report; raises ValueError and OSError
            where the input is at fault.
        renders: whether kernels run.
    """

    name: str
    says: str
    examples: tuple[str, ...]
    add_arguments: Callable[[argparse.ArgumentParser], None] = field(repr=False)
    run: Callable[[argparse.Namespace], Report] = field(repr=False)
    renders: bool = False

    def main(self, argv: Sequence[str] | None = None) -> int:
        """The pipeline as a script of its own; status 1 and one message where the input is at fault."""
        parser = argparse.ArgumentParser(
            prog=f"python -m scratchwarp.pipelines.{self.name.replace('-', '_')}",
            description=f"{self.says[0].upper()}{self.says[1:]}.",
            epilog="examples:\n  " + "\n  ".join(self.examples),
            formatter_class=argparse.RawDescriptionHelpFormatter,
        )
        parser.add_argument("--quiet", action="store_true", help="say nothing but errors")
        parser.add_argument("--json", action="store_true", help="print results as JSON")
        self.add_arguments(parser)
        options = parser.parse_args(argv)
        try:
            report = self.run(options)
        except (ValueError, OSError, ImportError) as error:
            print(f"{self.name}: {error}", file=sys.stderr)
            return 2 if isinstance(error, WrongUsage) else 1
        return show(report, options)


def script(
    name: str,
    about: str | None,
    add_arguments: Callable[[argparse.ArgumentParser], None],
    run: Callable[[argparse.Namespace], Sequence[object]],
    example: str = "",
) -> Callable[..., int]:
    """``main`` of a script that is no sub-command: ``run`` makes of its options what is printed, a line each; status 1
    and one message where the input is at fault, 2 where the command line is."""

    def main(argv: Sequence[str] | None = None) -> int:
        parser = argparse.ArgumentParser(
            prog=f"python -m scratchwarp.pipelines.{name}",
            description=(about or "").strip(),
            epilog=f"example: {example}" if example else None,
            formatter_class=argparse.RawDescriptionHelpFormatter,
        )
        add_arguments(parser)
        options = parser.parse_args(argv)
        try:
            for line in run(options):
                print(line)
        except WrongUsage as error:
            parser.error(str(error))
        except (ValueError, OSError, ImportError) as error:
            print(f"{name}: {error}", file=sys.stderr)
            return 1
        return 0

    return main


def show(report: Report, options: argparse.Namespace) -> int:
    """Print a report as its options ask and return the status."""
    if options.json:
        print(json.dumps(report.record, indent=1, default=str), flush=True)
    else:
        for line in (*report.findings, *(() if options.quiet else report.lines)):
            print(line, flush=True)
    return report.status
