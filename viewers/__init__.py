"""What people look at while they work: pyvista, one file per thing looked at.

Files:
    meshes         the scene's meshes
    directions     which way each layer's scratches run on them, and how long they are
    curves         explicit scratches, as lines on the surfaces
    camera         the camera's frustum and the lights
    profiles       each layer's cross-section
    tables         each layer's simulated table
    cross_sections profiles whose numbers can be turned
    live_profile   one of them in a window of its own, with sliders
    live_wave      the lobe of one scratch that diffracts, with sliders for it and the light
    live_brdf      a measured BRDF beside the stencils fitted to it, with sliders
    lobes          reflectance as a surface in 3D
    image          the rendered image
    colors         one colour for each layer
    display        pyvista, and whether windows can be drawn here
    sheet, marks   pictures, lines and words that are changed in place
    sliders        a slider for a number
    looking        an image that refines in a thread while its stage is edited; turning moves camera and lights
    preview        the 3D view without a window; eye puts a window's eye where the camera is
    web            the same in browsers, by trame
    window         all of it together, and the keys of the window
    live_window    the same, its image refining as sliders and the camera are dragged; overlay lays it over the 3D view

``view`` opens the window; importing this package imports neither pyvista nor pxr nor Warp.
"""

from importlib.util import find_spec
from pathlib import Path
from typing import Any

__all__ = ["BRDFS", "BRDF_KEYS", "KEYS", "PROFILE_KEYS", "view", "view_brdf", "view_lobe", "view_profile", "view_web"]

# key -> what it does in the window, as --help prints it.
KEYS = {
    "d": "scratch directions on or off",
    "c": "explicit scratches on or off",
    "l": "camera and lights on or off",
    "t": "triangle edges on or off",
    "n": "the next layers in the plots",
    "m": "the sliders move the next layer",
    "g": "the next shape for the profile of that layer",
    "h": "the next material for its scratches: the base's by another Fresnel model, metals, glass, diffuse",
    "x": "that layer on or off",
    "y": "that layer cuts through the others",
    "b": "the sliders move the next light",
    "k": "the rendered image over the 3D view, or beside it alone",
    "z": "save the edits as NAME.look.usda beside the stage",
    "o": "look through the stage's camera again",
    "q": "close the window",
}

# The same for the window of one profile.
PROFILE_KEYS = {
    "n": "the next layer of the stage, or the next shape",
    "k": "the next shape at the same depth",
    "g": "repeated for ever, or alone in flat ground",
    "q": "close the window",
}


# Endings of files that ``view_brdf`` shows.
BRDFS = (".bin", ".binary", ".bsdf")

# The same for the window of a measured BRDF.
BRDF_KEYS = {
    "n": "the sliders turn the next mode",
    "r": "the fitted model again",
    "b": "the measurement's lobe on or off",
    "m": "the model's lobe on or off",
    "q": "close the window",
}


def view_brdf(source: Path | str, screenshot: Path | str | None = None, **options: Any) -> None:
    """Show a measured BRDF unfolded beside the stencils fitted to it, their difference, lobes in 3D, sliders for modes.

    ``source`` is a UTIA .bin, MERL .binary or RGL .bsdf. ``options`` are those of
    ``scratchwarp.viewers.live_brdf.view``: modes, refine, size. Raises as ``view`` does.
    """
    from .display import pyvista

    pyvista()
    from .live_brdf import view as show

    show(source, screenshot, **options)


def view_profile(source: Path | str, screenshot: Path | str | None = None, **options: Any) -> None:
    """Show one cross-section with sliders for its numbers, and its table as it is simulated again at every step.

    ``source`` is a stage or the name of a shape. ``options`` are those of ``scratchwarp.viewers.live_profile.view``:
    layer, depth, frame, camera, max_memory, size. Raises as ``view`` does.
    """
    from .display import pyvista

    pyvista()
    from .live_profile import view as show

    show(source, screenshot, **options)


def view_lobe(screenshot: Path | str | None = None, **options: Any) -> None:
    """Show how one fine scratch diffracts: its radiance over the hemisphere of viewers, with sliders for width, depth,
    coherence radius and a spherical light. ``options``: size of the window. Raises ImportError and OSError as ``view``.
    """
    from .display import pyvista

    pyvista()
    from .live_wave import view as show

    show(screenshot, **options)


def view(stage_path: Path | str, screenshot: Path | str | None = None, **options: Any) -> None:
    """Show a stage: meshes with the directions of their scratches, each layer's profile and table, and the image,
    which refines while sliders and the camera are dragged.

    Opens a window with the keys of ``KEYS``, or writes a picture to ``screenshot`` without a display. ``options`` are
    those of ``scratchwarp.viewers.live_window.view``: frame, camera, max_memory, width, spp, size, page.

    Raises:
        ImportError: pyvista is missing.
        OSError: nothing can be drawn here (no display, no off-screen OpenGL), or the picture cannot be written.
        ValueError: the stage is at fault.
    """
    from .display import pyvista

    pyvista()  # says what to install when it is missing
    from .live_window import view as show

    show(stage_path, screenshot, **options)


def view_web(stage_path: Path | str, **options: Any) -> None:
    """Show a stage in browsers until interrupted, refined while it is edited; links are printed.

    ``options`` are those of ``scratchwarp.viewers.web.serve``: host, port, save, width, spp, browse, and of ``read``.
    Raises ImportError without trame, OSError where the address cannot be had, ValueError when the stage is at fault.
    """
    if find_spec("trame") is None:
        raise ImportError('trame is missing: pip install "scratchwarp[viewers]"')
    from .web import serve

    serve(stage_path, **options)
