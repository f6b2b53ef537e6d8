"""The report of a study as one HTML file that needs no other."""

import base64
import html
import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from ..image import quick
from ..plan.knobs import KNOBS
from .chart import chart
from .measurement import PARTS
from .report import Report, Row, machine

DIFFERENCE = 4.0
"""Differences are shown so many times brighter."""
MOST = 6
"""Lines of one plot."""
LITTLE = 1e-3
"""Biases below so much of the error of the defaults are not drawn."""
PAPERS = (
    "B. Raymond, G. Guennebaud, P. Barla: Multi-Scale Rendering of Scratched Materials using a Structured SV-BRDF "
    "Model. ACM Transactions on Graphics 35 (4), 2016.",
    "Z. Velinov, S. Werner, M. Hullin: Real-Time Rendering of Wave-Optical Effects on Scratched Surfaces. Computer "
    "Graphics Forum 37 (2), 2018.",
    "C. Bosch, X. Pueyo, S. Mérillou, D. Ghazanfarpour: A Resolution Independent Approach for the Accurate Rendering "
    "of Grooved Surfaces. Computer Graphics Forum 27 (7), 2008.",
    "P. Andersson, J. Nilsson, T. Akenine-Möller, M. Oskarsson, K. Åström, M. Fairchild: FLIP: A Difference Evaluator "
    "for Alternating Images. Proceedings of the ACM on Computer Graphics and Interactive Techniques 3 (2), 2020.",
    "F. Rousselle, C. Knaus, M. Zwicker: Adaptive Rendering with Non-Local Means Filtering. ACM Transactions on "
    "Graphics 31 (6), 2012 (relative mean square error).",
    "E. Veach: Robust Monte Carlo Methods for Light Transport Simulation. PhD thesis, Stanford University, 1997.",
)
_STYLE = """
body { font: 16px/1.5 system-ui, sans-serif; max-width: 76rem; margin: 2rem auto; padding: 0 1rem; color: #222; }
h1 { font-size: 1.6rem; } h2 { font-size: 1.2rem; margin-top: 2.4rem; } h3 { font-size: 1rem; margin-bottom: .3rem; }
table { border-collapse: collapse; margin: 1rem 0; font-size: .85rem; }
th, td { padding: .2rem .5rem; text-align: right; border-bottom: 1px solid #ddd; white-space: nowrap; }
th:first-child, td:first-child { text-align: left; white-space: normal; }
tr.front td { font-weight: 700; }
.note { border-left: .25rem solid #d55e00; padding-left: .7rem; }
.covered { color: #888; font-weight: 400; }
.row { display: flex; flex-wrap: wrap; gap: .6rem; }
figure { margin: 0; width: 9.9rem; } figure img { width: 100%; display: block; image-rendering: pixelated; }
figcaption { color: #555; font-size: .8rem; }
.large figure { width: 18rem; }
svg { max-width: 52rem; width: 100%; }
.wide { overflow-x: auto; }
"""


def page(report: Report) -> str:
    """The whole page; pictures are inside it."""
    about = {**report.about, **machine()}
    names = list(report.about["defaults"])
    lines = {name: rows for name in names if len(rows := report.knob_rows(name)) > 1}
    joint = [row for row in report.rows if len(row.knobs) > 1]
    seeds = about["reference"].get("seeds", [])
    says = [
        ("Stage", about["stage"]),
        ("Image", f"{about['size'][0]} x {about['size'][1]} pixels"),
        ("Machine", about["machine"]),
        ("Versions", about["versions"]),
        ("Threads", about["threads"]),
        ("Seeds", ", ".join(map(str, about["seeds"]))),
        ("Reference", ", ".join(f"{n}={v}" for n, v in about["reference"].items() if n != "seeds")
         + (f" (seeds {', '.join(map(str, seeds))})" if seeds else "")),
        ("Defaults", ", ".join(f"{n}={v}" for n, v in about["defaults"].items())),
        ("Study took", f"{about['seconds']:.0f} s" + (f" of {b:.0f} s" if (b := about.get("budget")) else "")),
        ("Left out for lack of time", f"{about.get('left', 0)} settings"),
        ("On", ", ".join(about["effects"])),
    ]  # fmt: skip
    facts = "".join(f"<tr><td>{html.escape(n)}</td><td style='text-align:left;white-space:normal'>"
                    f"{html.escape(str(v))}</td></tr>" for n, v in says)  # fmt: skip
    told = [row for row in report.sorted_rows() if len(row.knobs) < 2 or row.front]
    more = len(report.rows) - len(told)
    others = f"<p>{more} settings of several knobs off the front are in report.csv.</p>" if more else ""
    strips = "".join(_strip(report, name, rows) for name, rows in lines.items())
    papers = "".join(f"<li>{html.escape(paper)}</li>" for paper in PAPERS)
    pictures = _figure(report.reference, "reference")
    if "defaults" in report.images:
        pictures += _figure(report.images["defaults"], "defaults")
    return f"""<!doctype html>
<html lang="en">
<head><meta charset="utf-8"><title>What accuracy costs: {html.escape(str(about["stage"]))}</title>
<style>{_STYLE}</style></head>
<body>
<h1>What accuracy costs: {html.escape(Path(str(about["stage"])).name)}</h1>
<div class="row large">{pictures}</div>
{_notes(report)}
<h2>Error against time</h2>
<p>Each line turns one knob while the others stay at their defaults; grey dots turn several. Circles and the dashed
stair mark the front: nothing that was measured is both faster and closer to the reference. Further left is faster,
further down is closer; a line that falls steeply buys accuracy cheaply, a flat one costs time for nothing. Point at a
dot to see what it is.</p>
{_charts(report, lines, joint)}
<h2>The front</h2>
{_table(report, report.pareto())}
<h2>Knob by knob</h2>
<p>Above the image of each value, below it how far it is from the reference, {DIFFERENCE:g} times as bright.</p>
{strips}
<h2>Settings</h2>
<p>Seconds are those of planning, simulating tables, building data for the device and tracing, as if each setting were
rendered alone with what profiles need known; compiling, which is done once, stands by itself. Rounds render every
setting in turns: a setting's seconds are its ratio to the defaults of the same round, times the defaults' median, so
that a slow moment of the machine does not count; the range is over rounds. relMSE is the mean over pixels of the
squared difference over the squared luminance of the reference (plus a hundredth of its squared mean). Bias is the same
against the knob's value in the reference with the same samples: noise cancels, and what is left is what the knob does.
Tables is the share of the light that tables themselves send elsewhere, against those of the reference. FLIP is the
difference seen when flipping between two images, 0 to 1. Beside relMSE stands its range over rounds, or, of one
round, its standard error as a mean over pixels. The front is in bold.</p>
{_table(report, told)}{others}
<h2>How it was measured</h2>
<table>{facts}</table>
<h2>Sources</h2>
<ul>{papers}</ul>
</body>
</html>
"""


def _notes(report: Report) -> str:
    """What must be known of the reference, and of what is not there."""
    about, said = report.about, []
    if report.floor is not None:
        said.append(
            f"The reference has an error of its own: relMSE {report.floor:.2g}, the noise of its samples, measured by "
            "its two halves. Errors below twice that, in grey with the mark *, say nothing of the setting."
        )
    shrunk = about.get("shrunk", {})
    if shrunk:
        changed = ", ".join(f"{n} {new} in place of {old}" for n, (old, new) in shrunk.items())
        said.append(
            f"For the budget of {about['budget']:.0f} s the reference was made cheaper: {changed}. Dearer values of "
            "these knobs are left out, and what they would change is in no error here; a longer budget has them."
        )
    if about.get("unmeasured"):
        said.append(f"Not measured for lack of time: {', '.join(about['unmeasured'])}. The same command with a longer "
                    "budget, or again with the same one, goes on.")  # fmt: skip
    return "".join(f"<p class='note'>{html.escape(text)}</p>" for text in said)


def _charts(report: Report, lines: Mapping[str, Sequence[Row]], joint: Sequence[Row]) -> str:
    """The errors of all knobs, and without noise what those do that are none, in plots of ``MOST`` knobs at most."""

    def reach(rows: Sequence[Row]) -> float:
        errors, seconds = [max(row.error, 1e-12) for row in rows], [max(row.seconds, 1e-6) for row in rows]
        return math.log(max(errors) / min(errors)) + math.log(max(seconds) / min(seconds))

    order = sorted(lines, key=lambda name: reach(lines[name]), reverse=True)[:MOST]
    base = next((row.error for row in report.rows if not row.knobs), 0.0)
    biases = {n: [replace(row, error=row.bias) for row in rows if row.bias and row.bias > LITTLE * base]
              for n, rows in lines.items()}  # fmt: skip
    told = sorted((n for n in biases if biases[n]), key=lambda n: max(row.error for row in biases[n]), reverse=True)
    colors = [*order, *(name for name in told[:MOST] if name not in order)]
    own = {n: lines[n] for n in lines if n in order}
    drawn = [chart(own, joint, report.pareto(), report.floor, colored=colors)]
    if others := [name for name in lines if name not in order]:
        drawn.append(f"<p>Not drawn, for they change less here: {html.escape(', '.join(others))}.</p>")
    if told:
        drawn.append(
            "<h3>Without noise</h3><p>What a knob does, told apart from noise: its bias, against its own value in the "
            "reference with the same samples. More samples do not cure it. Values that leave less than a thousandth of "
            "the error of the defaults are not drawn.</p>"
        )
        own = {n: biases[n] for n in biases if n in told[:MOST]}
        drawn.append(chart(own, axis="bias (relMSE, same samples)", colored=colors))
    return "".join(drawn)


def _table(report: Report, rows: Sequence[Row]) -> str:
    """Columns that nothing is in are left out."""
    several = any(row.rounds > 1 for row in rows)
    columns: dict[str, list[str]] = {
        "Setting": [html.escape(row.name) for row in rows],
        "Seconds": [f"{row.seconds:.3g}" for row in rows],
        "Range": [f"{row.fastest:.3g} to {row.slowest:.3g}" if row.rounds > 1 else "" for row in rows],
    }
    for part in (*PARTS, "compile"):
        columns[part.capitalize()] = [_seconds(row.parts.get(part, 0.0)) for row in rows]
    columns |= {
        "relMSE": [_error(report, row) for row in rows],
        "Bias": ["" if row.bias is None else f"{row.bias:.2g}" for row in rows],
        "Tables": ["" if row.table is None else f"{row.table:.2g}" for row in rows],
        "FLIP": ["" if row.flip is None else f"{row.flip:.3f}" for row in rows],
        "Rounds": [str(row.rounds) if several else "" for row in rows],
    }
    shown = {name: cells for name, cells in columns.items() if any(cell not in ("", "0") for cell in cells)}
    lines = []
    for number, row in enumerate(rows):
        marked = ' class="front"' if row.front else ""
        lines.append(f"<tr{marked}>{''.join(f'<td>{cells[number]}</td>' for cells in shown.values())}</tr>")
    timed = {"Seconds", "Range", *(part.capitalize() for part in (*PARTS, "compile"))}
    head = "".join(f"<th>{name}{' [s]' if name in timed else ''}</th>" for name in shown)
    return f"<div class='wide'><table><thead><tr>{head}</tr></thead><tbody>{''.join(lines)}</tbody></table></div>"


def _seconds(seconds: float) -> str:
    return "0" if seconds < 5e-4 else f"{seconds:.3f}" if seconds < 1.0 else f"{seconds:.3g}"


def _error(report: Report, row: Row) -> str:
    """relMSE with how much it may be off: its range over rounds, or the standard error over pixels."""
    text = f"{row.error:.3g}"
    text += f" ({row.least_error:.2g} to {row.most_error:.2g})" if row.rounds > 1 else f" &plusmn; {row.doubt:.1g}"
    return f"<span class='covered'>{text} *</span>" if report.covered(row) else text


def _strip(report: Report, name: str, rows: Sequence[Row]) -> str:
    knob = KNOBS[name]
    default = report.about["defaults"][name]
    figures = []
    for row in rows:
        if row.name in report.images:
            found = report.images[row.name]
            off = DIFFERENCE * np.abs(found - report.reference)
            value = row.knobs.get(name, default)
            caption = f"{value}: {row.seconds:.3g} s, relMSE {row.error:.2g}"
            if row.bias is not None:
                caption += f", bias {row.bias:.2g}"
            if row.table is not None:
                caption += f", tables {row.table:.2g}"
            figures.append(_figure(np.concatenate([found, off.astype(np.float32)]), caption))
    source = f" ({knob.source})" if knob.source else ""
    falls = "Its error falls from value to value, within noise." if report.falls(name) else (
        "Its error does not fall from value to value here: noise or another knob covers it."
    )
    return (
        f"<h3>{html.escape(name)}</h3><p>At cheap values: {html.escape(knob.error + source)}. "
        f'Default: {html.escape(str(default))}. {falls}</p><div class="row">{"".join(figures)}</div>'
    )


def _figure(pixels: np.ndarray, caption: str) -> str:
    text = html.escape(caption)
    return f'<figure><img src="{_embedded(pixels)}" alt="{text}"><figcaption>{text}</figcaption></figure>'


def _embedded(pixels: np.ndarray) -> str:
    """A linear image as a data URI."""
    return "data:image/png;base64," + base64.b64encode(quick.png(quick.eight_bit(pixels))).decode("ascii")
