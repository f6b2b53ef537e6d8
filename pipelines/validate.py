"""Check a stage against the scratch schemas and OpenUSD's rules, in every combination of its variants."""

import argparse
import sys

from .command import Command, Report


def add_arguments(parser: argparse.ArgumentParser) -> None:
    """What ``scratchwarp validate`` understands."""
    parser.add_argument("stage", metavar="FILE", help="USD file")
    parser.add_argument("--strict", "-t", action="store_true", help="warnings count as errors")
    parser.add_argument("--skipVariants", "-s", action="store_true", help="only the variants that are chosen")
    parser.add_argument("--against", metavar="ASSET", help="leave out what this stage is found fault with, too")
    parser.add_argument("--fix", metavar="OUT", help="a copy beside FILE, mended where no guess is needed")


def run(options: argparse.Namespace) -> Report:
    """What ``add_arguments`` were parsed into: findings, and status 1 when there are errors (strictly: or warnings)."""
    from scratchwarp.stage.validation import validate
    from scratchwarp.stage.validation_variants import fixed_copy, validate_variants

    mended: list[str] = []
    stage = options.stage
    if options.fix:
        mended, stage = fixed_copy(stage, options.fix), options.fix
    findings, count = (validate(stage), 1) if options.skipVariants else validate_variants(stage)
    left_out = 0
    if options.against:
        known = {(f.rule, f.message) for f in validate(options.against)}
        if not options.skipVariants:
            known |= {(f.rule, f.message) for f in validate_variants(options.against)[0]}
        kept = [f for f in findings if (f.rule, f.message) not in known]
        left_out, findings = len(findings) - len(kept), kept
    rows = [
        {"severity": f.severity, "rule": f.rule, "prim": f.path, "message": f.message}
        | ({"variants": f.variants} if f.variants else {})
        for f in findings
    ]
    lines = [f"fixed: {text}" for text in mended]
    if not findings:
        combined = f" in {count} combinations of variants" if count > 1 else ""
        lines.append(f"{stage}: nothing to find fault with{combined}")
    if left_out:
        lines.append(f"{left_out} findings of {options.against} are left out")
    counted = ("error", "warning") if options.strict else ("error",)
    failed = any(f.severity in counted for f in findings)
    record = {"fixed": mended, "findings": rows} if options.fix else rows
    return Report(record, tuple(lines), int(failed), tuple(map(str, findings)))


COMMAND = Command(
    name="validate",
    says="check a stage against the scratch schemas, in all its variants",
    examples=(
        "scratchwarp validate ball.usda",
        "scratchwarp validate ball.usda --strict --json",
        "scratchwarp validate worn.usda --against cup.usda",
        "scratchwarp validate ball.usda --fix ball_fixed.usda",
    ),
    add_arguments=add_arguments,
    run=run,
)


main = COMMAND.main

if __name__ == "__main__":
    sys.exit(main())
