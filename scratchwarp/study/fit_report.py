"""The report of a fit as a folder: index.html, the numbers as fit.json, and its pictures."""

import html
import json
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

import numpy as np

from .. import image
from ..reflectance.measured.rivals import Rival
from ..whole import whole
from . import fit_pictures as pictures
from .fit_candidates import Candidate
from .fit_metrics import source

_METRICS = {"delta_e": "Delta E", "rmse": "RMSE", "psnr": "PSNR [dB]", "ssim": "SSIM"}
_LEAST = ("delta_e", "rmse")  # of these the smallest is best
_STYLE = """
body { font: 16px/1.5 system-ui, sans-serif; max-width: 76rem; margin: 2rem auto; padding: 0 1rem; color: #222; }
h1 { font-size: 1.6rem; } h2 { font-size: 1.2rem; margin-top: 2.4rem; }
table { border-collapse: collapse; margin: 1rem 0; }
th, td { padding: .3rem .8rem; text-align: right; border-bottom: 1px solid #ddd; }
th:first-child, td:first-child { text-align: left; }
td.best { font-weight: 700; }
.row { display: flex; flex-wrap: wrap; gap: 1rem; }
figure { margin: 0; width: 22rem; } figure img { width: 100%; image-rendering: pixelated; display: block; }
figcaption { color: #555; font-size: .9rem; }
.swatch { display: inline-block; width: 1em; height: 1em; vertical-align: -.15em; border: 1px solid #999; }
svg { max-width: 48rem; width: 100%; }
"""


def record(found: Candidate) -> dict[str, Any]:
    """A candidate as what JSON can hold: its metrics and every number of its model."""
    if isinstance(found.model, Rival):
        numbers: dict[str, Any] = {"lobes": found.model.lobes, "kd": found.model.kd, "ks": found.model.ks}
    else:
        numbers = asdict(found.model)
    return {
        "model": found.name,
        "lobes": found.lobes,
        "parameters": found.parameters,
        "seconds": round(found.seconds, 4),
        "metrics": {name: value if np.isfinite(value) else str(value) for name, value in found.metrics.items()},
        "numbers": numbers,
    }


def write(
    folder: Path | str, title: str, reference: Any, found: Sequence[Candidate], notes: Sequence[str] = ()
) -> Path:
    """Write the report of ``candidates`` (the stencil model first) on ``reference`` and return its index.html.

    ``folder`` is made when it is not there; each file in it appears whole or not at all. ``notes``: sentences that the
    report begins with. Raises OSError where the folder cannot be written.
    """
    target = Path(folder)
    try:
        target.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise OSError(f"{target}: no folder can be made there ({error.strerror}); choose another --report") from error
    values = np.maximum(np.asarray(reference, np.float64), 0.0)
    shown = pictures.white(values)
    measured = pictures.unfolded(values, shown)
    _picture(target / "measurement.png", measured)
    for one in found:
        own = pictures.unfolded(one.values, shown)
        off = pictures.difference(values, one.values, shown)
        _picture(target / f"{one.name}.png", own)
        _picture(target / f"{one.name}_difference.png", off)
        if one is found[0]:
            _picture(target / "side_by_side.png", pictures.beside(measured, own, off))
    chart = pictures.slice_chart({"measurement": values, **{one.label: one.values for one in found}})
    _text(target / "slice.svg", chart)
    rows = {"title": title, "metrics_by": source(), "candidates": [record(one) for one in found], "notes": [*notes]}
    _text(target / "fit.json", json.dumps(rows, indent=1, default=_plain) + "\n")
    page = target / "index.html"
    _text(page, _page(title, found, notes, shown, chart))
    return page


def table(found: Sequence[Candidate]) -> str:
    """The comparison as text, one line a model."""
    head = f"{'model':28s}{'parameters':>11s}" + "".join(f"{name:>11s}" for name in _METRICS.values()) + f"{'s':>8s}"
    lines = [head]
    for one in found:
        numbers = "".join(f"{one.metrics[name]:11.4g}" for name in _METRICS)
        lines.append(f"{one.label:28s}{one.parameters:11d}{numbers}{one.seconds:8.2f}")
    return "\n".join(lines)


def _page(title: str, found: Sequence[Candidate], notes: Sequence[str], shown: float, chart: str) -> str:
    best = {name: (min if name in _LEAST else max)(one.metrics[name] for one in found) for name in _METRICS}
    rows = []
    for one in found:
        cells = "".join(
            f'<td class="best">{one.metrics[name]:.4g}</td>'
            if one.metrics[name] == best[name]
            else f"<td>{one.metrics[name]:.4g}</td>"
            for name in _METRICS
        )
        rows.append(f"<tr><td>{one.label}</td><td>{one.parameters}</td>{cells}<td>{one.seconds:.2f}</td></tr>")
    head = "".join(f"<th>{name}</th>" for name in ("Model", "Numbers", *_METRICS.values(), "Seconds"))
    figures = [_figure("measurement.png", "Measurement")]
    figures += [_figure(f"{one.name}.png", one.label) for one in found]
    differences = [_figure(f"{one.name}_difference.png", one.label) for one in found]
    said = "".join(f"<p>{html.escape(note)}</p>" for note in notes)
    return f"""<!doctype html>
<html lang="en">
<head><meta charset="utf-8"><title>{html.escape(title)}</title><style>{_STYLE}</style></head>
<body>
<h1>{html.escape(title)}</h1>
{said}
<h2>How close each model is</h2>
<table><thead><tr>{head}</tr></thead><tbody>
{"".join(rows)}
</tbody></table>
<p>Metrics by {source()}, over the unfolded BRDF in linear Rec.709: mean CIE 1976 colour difference under D65, root mean
square error, peak signal-to-noise ratio with the largest measured value for peak, structural similarity of luminance
(Gaussian window, sigma 1.5). The best of each column is bold.</p>
<h2>Unfolded into a picture</h2>
<p>From top to bottom the light stands at 0, 15, ... 75 degrees from the normal, from left to right the viewer; in each
block azimuths run through a whole turn. White is {shown:.3g} 1/sr.</p>
<div class="row">{"".join(figures)}</div>
<h2>Differences, {pictures.DIFFERENCE:g} times as bright</h2>
<div class="row">{"".join(differences)}</div>
<h2>One slice</h2>
<p>Luminance with the light at 75 degrees and azimuth 0, seen at 60 degrees from all around.</p>
{chart}
<h2>The model's numbers</h2>
{_numbers(found[0].model)}
</body>
</html>
"""


def _figure(file: str, caption: str) -> str:
    text = html.escape(caption)
    return f'<figure><a href="{file}"><img src="{file}" alt="{text}"></a><figcaption>{text}</figcaption></figure>'


def _numbers(model: Any) -> str:
    names = ("axis [degrees]", "width", "a", "b", "kd", "ks", "alpha", "colour")
    rows = []
    for number, mode in enumerate(model.modes, 1):
        most = max(*mode.color, 1e-12)
        tint = ", ".join(str(round(255 * (c / most) ** (1 / 2.2))) for c in mode.color)
        color = ", ".join(f"{c:.3g}" for c in mode.color)
        cells = [f"{np.degrees(mode.azimuth):.2f}"]
        cells += [f"{getattr(mode, name):.4g}" for name in ("width", "a", "b", "kd", "ks", "alpha")]
        cells.append(f'<span class="swatch" style="background: rgb({tint})"></span> {color}')
        rows.append(f"<tr><td>{number}</td>{''.join(f'<td>{cell}</td>' for cell in cells)}</tr>")
    head = "".join(f"<th>{name}</th>" for name in ("Mode", *names))
    betas = ", ".join(f"{b:.3g}" for b in model.beta) or "none"
    return f"""<table><thead><tr>{head}</tr></thead><tbody>{"".join(rows)}</tbody></table>
<p>Translucency at crossings: {betas}. Background: {model.background:.4g}. Specular factor: {model.k:.4g}, exponent
{model.specular_alpha:.4g}.{" Highlights return to the light." if model.retro else ""}</p>"""


def _picture(path: Path, pixels: np.ndarray) -> None:
    image.write_layers({"color": pixels}, path)


def _text(path: Path, text: str) -> None:
    with whole(path) as draft:
        draft.write_text(text, encoding="utf-8")


def _plain(value: Any) -> Any:
    return value.tolist() if hasattr(value, "tolist") else str(value)
