"""Pictures of stages and image files, in grids and on web pages."""

import argparse
import base64
import html
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

Array = Any  # of NumPy, which loads when a pipeline runs

STAGES = (".usda", ".usdc", ".usd", ".usdz")
_STYLE = """body { font: 16px/1.5 system-ui, sans-serif; margin: 2rem; color: #222; }
.row { display: flex; flex-wrap: wrap; gap: 1rem; } figure { margin: 0; }
figure img { display: block; image-rendering: pixelated; max-width: 46rem; width: 100%; }
table { border-collapse: collapse; } th, td { padding: .2rem .8rem .2rem 0; text-align: left; }"""


def add_rendering(parser: argparse.ArgumentParser, width: int = 320, spp: int = 16) -> None:
    """How stages are rendered."""
    parser.add_argument("--imageWidth", "-w", type=int, default=width, metavar="PIXELS", help=f"[{width}]")
    parser.add_argument("--spp", type=int, default=spp, help=f"samples a pixel [{spp}]")
    parser.add_argument("--quality", help="draft, preview, final or reference [as the stage says]")
    parser.add_argument("--camera", "-cam", metavar="NAME", help="camera prim, by path or name [the stage's]")


def settings(options: argparse.Namespace) -> Any:
    """The Settings that ``add_rendering`` was parsed into; ValueError naming what is out of range."""
    import scratchwarp as sw

    return sw.Settings(width=options.imageWidth, spp=options.spp, quality=options.quality)


def film(scene: Any, options: argparse.Namespace, title: str) -> Any:
    """The Film of a scene, with a progress bar."""
    import scratchwarp as sw
    from scratchwarp.render import bar

    with bar(options.quiet or options.json, title) as progress:
        return sw.render(scene, sw.make_plan(scene, settings(options)), progress=progress)


def picture(source: Path | str, options: argparse.Namespace, **reading: Any) -> Array:
    """Linear Rec.709 [h, w, 3] of a stage, rendered, or of an image file; ``reading``: of ``scratchwarp.read``.

    Raises ValueError and OSError naming the file.
    """
    import numpy as np

    import scratchwarp as sw
    from scratchwarp import image

    path = Path(source)
    suffix = path.suffix.lower()
    if suffix in STAGES:
        return np.asarray(film(sw.read(path, camera=options.camera, **reading), options, path.name)["color"])
    if not path.is_file():
        raise FileNotFoundError(f"{path}: no such file")
    if suffix in (".exr", ".npz"):
        layers, _ = image.read_layers(path)
        if "color" not in layers:
            raise ValueError(f"{path}: has no layer color, only {', '.join(layers)}")
        pixels = np.asarray(layers["color"], np.float32)
        return np.ascontiguousarray(pixels[..., :3])
    return np.ascontiguousarray(image.read_texture(str(path), "auto")[..., :3])


def grid(pictures: Sequence[Array], columns: int = 0, gap: int = 4) -> Array:
    """Pictures in rows, each in a cell as large as the largest, float32 [h, w, 3]; 0 columns: as square as it gets."""
    import numpy as np

    columns = min(columns or int(np.ceil(np.sqrt(len(pictures)))), len(pictures))
    high, wide = (max(p.shape[axis] for p in pictures) for axis in (0, 1))
    rows = -(-len(pictures) // columns)
    sheet = np.full((rows * (high + gap) - gap, columns * (wide + gap) - gap, 3), 0.18, np.float32)
    for i, pixels in enumerate(pictures):
        top, left = (i // columns) * (high + gap), (i % columns) * (wide + gap)
        sheet[top : top + pixels.shape[0], left : left + pixels.shape[1]] = pixels
    return sheet


def page(title: str, figures: Mapping[str, Array], rows: Sequence[tuple[str, str]] = ()) -> str:
    """A web page of one file: captions -> linear pictures, and a table above them."""
    from scratchwarp.image import quick

    table = "".join(f"<tr><th>{html.escape(name)}</th><td>{html.escape(value)}</td></tr>" for name, value in rows)
    shown = []
    for caption, pixels in figures.items():
        data = base64.b64encode(quick.png(quick.eight_bit(pixels))).decode("ascii")
        alt = html.escape(caption, quote=True)
        shown.append(
            f'<figure><img alt="{alt}" src="data:image/png;base64,{data}"><figcaption>{html.escape(caption)}'
            "</figcaption></figure>"
        )
    return (
        f'<!doctype html>\n<html lang="en"><head><meta charset="utf-8"><title>{html.escape(title)}</title>\n'
        f"<style>{_STYLE}</style></head><body>\n<h1>{html.escape(title)}</h1>\n<table>{table}</table>\n"
        f'<div class="row">\n{chr(10).join(shown)}\n</div>\n</body></html>\n'
    )


def write_page(path: Path, text: str) -> None:
    """Write a page whole or not at all; OSError where it cannot be written."""
    from scratchwarp.whole import whole

    with whole(path) as draft:
        draft.write_text(text, encoding="utf-8")


def check_out(out: str | Path, inputs: Sequence[str | Path]) -> None:
    """ValueError where ``out`` would replace one of ``inputs``."""
    for one in inputs:
        if Path(out).resolve() == Path(one).resolve():
            raise ValueError(f"{out}: is read and cannot be written; choose another name")
