"""The report of a study as one HTML file that needs no other."""

import base64
import html
import tempfile
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from .. import image
from ..plan.knobs import KNOBS
from .chart import chart
from .report import Report, Row, machine

DIFFERENCE = 4.0
"""Differences are shown so many times brighter."""
PAPERS = (
    "B. Raymond, G. Guennebaud, P. Barla: Multi-Scale Rendering of Scratched Materials using a Structured SV-BRDF "
    "Model. ACM Transactions on Graphics 35 (4), 2016.",
    "Z. Velinov, S. Werner, M. Hullin: Real-Time Rendering of Wave-Optical Effects on Scratched Surfaces. Computer "
    "Graphics Forum 37 (2), 2018.",
    "P. Andersson, J. Nilsson, T. Akenine-Möller, M. Oskarsson, K. Åström, M. Fairchild: FLIP: A Difference Evaluator "
    "for Alternating Images. Proceedings of the ACM on Computer Graphics and Interactive Techniques 3 (2), 2020.",
    "F. Rousselle, C. Knaus, M. Zwicker: Adaptive Rendering with Non-Local Means Filtering. ACM Transactions on "
    "Graphics 31 (6), 2012 (relative mean square error).",
    "E. Veach: Robust Monte Carlo Methods for Light Transport Simulation. PhD thesis, Stanford University, 1997.",
)
_STYLE = """
body { font: 16px/1.5 system-ui, sans-serif; max-width: 76rem; margin: 2rem auto; padding: 0 1rem; color: #222; }
h1 { font-size: 1.6rem; } h2 { font-size: 1.2rem; margin-top: 2.4rem; } h3 { font-size: 1rem; margin-bottom: .3rem; }
table { border-collapse: collapse; margin: 1rem 0; font-size: .9rem; }
th, td { padding: .2rem .7rem; text-align: right; border-bottom: 1px solid #ddd; white-space: nowrap; }
th:first-child, td:first-child { text-align: left; white-space: normal; }
tr.front td { font-weight: 700; }
.row { display: flex; flex-wrap: wrap; gap: .6rem; }
figure { margin: 0; width: 10.5rem; } figure img { width: 100%; display: block; image-rendering: pixelated; }
figcaption { color: #555; font-size: .8rem; }
svg { max-width: 52rem; width: 100%; }
.wide { overflow-x: auto; }
"""


def page(report: Report) -> str:
    """The whole page; pictures are inside it."""
    about = {**report.about, **machine()}
    names = list(report.about["defaults"])
    lines = {name: rows for name in names if len(rows := report.knob_rows(name)) > 1}
    joint = [row for row in report.rows if len(row.knobs) > 1]
    says = [
        ("Stage", about["stage"]),
        ("Image", f"{about['size'][0]} x {about['size'][1]} pixels"),
        ("Machine", about["machine"]),
        ("Versions", about["versions"]),
        ("Threads", about["threads"]),
        ("Seeds", ", ".join(map(str, about["seeds"]))),
        ("Reference", ", ".join(f"{n}={v}" for n, v in about["reference"].items())),
        ("Defaults", ", ".join(f"{n}={v}" for n, v in about["defaults"].items())),
        ("Study took", f"{about['seconds']:.0f} s"),
        ("Left out for lack of time", f"{about.get('left', 0)} settings"),
        ("On", ", ".join(about["effects"])),
    ]
    facts = "".join(f"<tr><td>{html.escape(n)}</td><td style='text-align:left;white-space:normal'>"
                    f"{html.escape(str(v))}</td></tr>" for n, v in says)  # fmt: skip
    told = [row for row in report.rows if len(row.knobs) < 2 or row.front]
    more = len(report.rows) - len(told)
    others = f"<p>{more} settings of several knobs off the front are in report.csv.</p>" if more else ""
    strips = "".join(_strip(report, name, rows) for name, rows in lines.items())
    papers = "".join(f"<li>{html.escape(paper)}</li>" for paper in PAPERS)
    reference = _figure(report.reference, "reference")
    return f"""<!doctype html>
<html lang="en">
<head><meta charset="utf-8"><title>What accuracy costs: {html.escape(str(about["stage"]))}</title>
<style>{_STYLE}</style></head>
<body>
<h1>What accuracy costs: {html.escape(Path(str(about["stage"])).name)}</h1>
<div class="row">{reference}</div>
<h2>Error against time</h2>
<p>Each line turns one knob while the others stay at their defaults; grey dots turn several. Circles and the dashed
stair mark the front: nothing that was measured is both faster and closer to the reference. Further left is faster,
further down is closer; a line that falls steeply buys accuracy cheaply, a flat one costs time for nothing. Point at a
dot to see what it is.</p>
{chart(lines, joint, report.pareto())}
<h2>The front</h2>
{_table(report.pareto())}
<h2>Knob by knob</h2>
<p>Above the image of each value, below it how far it is from the reference, {DIFFERENCE:g} times as bright.</p>
{strips}
<h2>Settings</h2>
<p>Seconds are those of planning, simulating tables and tracing; compiling, which is done once, stands by itself. Rounds
render every setting in turns: a setting's seconds are its ratio to the defaults of the same round, times the defaults'
median, so that a slow moment of the machine does not count; the range is over rounds. relMSE is the mean over pixels of
the squared difference over the squared luminance of the reference (plus a hundredth of its squared mean). Bias is the
same against the knob's own reference value with the same samples: noise cancels, and what is left is what the knob
does. Tables is the share of the light that tables themselves send elsewhere, against tables at the reference values of
all knobs. FLIP is the difference seen when flipping between two images, 0 to 1.</p>
{_table(told)}{others}
<h2>How it was measured</h2>
<table>{facts}</table>
<h2>Sources</h2>
<ul>{papers}</ul>
</body>
</html>
"""


def _table(rows: Sequence[Row]) -> str:
    timed = ("Setting", "Seconds", "Range", "Plan", "Simulate", "Trace", "Compile")
    head = (*timed, "relMSE", "Range", "Bias", "FLIP", "Tables", "Rounds")
    lines = []
    for row in rows:
        parts = [f"{row.parts[name]:.3g}" for name in ("plan", "simulate", "trace", "compile")]
        bias = "" if row.bias is None else f"{row.bias:.2g}"
        flip = "" if row.flip is None else f"{row.flip:.3f}"
        tables = "" if row.table is None else f"{row.table:.2g}"
        cells = [
            html.escape(row.name), f"{row.seconds:.3g}", f"{row.fastest:.3g} to {row.slowest:.3g}", *parts,
            f"{row.error:.3g}", f"{row.least_error:.2g} to {row.most_error:.2g}", bias, flip, tables,
            str(row.rounds),
        ]  # fmt: skip
        marked = ' class="front"' if row.front else ""
        lines.append(f"<tr{marked}>{''.join(f'<td>{cell}</td>' for cell in cells)}</tr>")
    return (
        f"<div class='wide'><table><thead><tr>{''.join(f'<th>{name}</th>' for name in head)}</tr></thead>"
        f"<tbody>{''.join(lines)}</tbody></table></div>"
    )


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
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "one.png"
        image.write_layers({"color": pixels}, file)
        return "data:image/png;base64," + base64.b64encode(file.read_bytes()).decode("ascii")
