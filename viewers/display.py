"""pyvista, and whether windows can be drawn here."""

import ctypes.util
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from scratchwarp.whole import whole

WINDOW = "VTK_DEFAULT_OPENGL_WINDOW"
OFF_SCREEN = (("EGL", "vtkEGLRenderWindow"), ("OSMesa", "vtkOSOpenGLRenderWindow"))


def pyvista() -> Any:
    """The pyvista module; ImportError saying what to install when it is missing."""
    try:
        import pyvista
    except ImportError as error:
        raise ImportError(f'pyvista is missing ({error}): pip install "scratchwarp[viewers]"') from error
    return pyvista


@contextmanager
def drawing(off_screen: bool) -> Iterator[None]:
    """While this lasts, VTK draws through what this machine has; OSError, before VTK crashes, where it has nothing.

    On Linux without a display VTK needs EGL or OSMesa for off-screen pictures. The choice of the user in
    ``$VTK_DEFAULT_OPENGL_WINDOW`` stands.
    """
    if not sys.platform.startswith("linux") or os.environ.get("DISPLAY") or os.environ.get(WINDOW):
        yield
        return
    if not off_screen:
        raise OSError("there is no display to open a window on ($DISPLAY is not set); give --screenshot FILE instead")
    found = [window for library, window in OFF_SCREEN if ctypes.util.find_library(library)]
    if not found:
        raise OSError("off-screen pictures need libEGL or libOSMesa; install libegl1 or libosmesa6")
    os.environ[WINDOW] = found[0]
    try:
        yield
    finally:
        os.environ.pop(WINDOW, None)


@contextmanager
def canvas(off_screen: bool, size: tuple[int, int], shape: tuple[int, int] = (1, 1)) -> Iterator[Any]:
    """A pyvista plotter of ``size`` pixels with rows and columns of renderers, closed for good afterwards.

    OSError as ``drawing`` has it.
    """
    pv = pyvista()
    with drawing(off_screen):
        plotter = pv.Plotter(shape=shape, off_screen=off_screen, window_size=list(size), border=False)
        try:
            yield plotter
        finally:
            plotter.close()
            plotter.deep_clean()


def check_writable(path: Path) -> None:
    """Say what is wrong with ``path`` before anything is read or rendered: ValueError or OSError."""
    if path.suffix.lower() not in (".png", ".jpg", ".jpeg", ".bmp", ".tif", ".tiff"):
        raise ValueError(f"{path}: a screenshot ends in .png, .jpg, .bmp or .tif")
    if not path.parent.is_dir():
        raise OSError(f"{path}: the folder {path.parent} does not exist")


def write(plotter: Any, path: Path) -> None:
    """Write what the plotter shows, whole or not at all."""
    with whole(path) as draft:
        plotter.screenshot(str(draft))
