"""From a file to an open stage, or a message that says what is wrong with the file."""

import re
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path

from pxr import Sdf, Tf, Usd, UsdGeom, UsdUtils

from scratchwarp.scene import StageError, TooLarge

from .package import check_package
from .reading import Warnings

_FORMATS = "usd, usda, usdc or usdz"


@contextmanager
def gathered_diagnostics(path: str | Path, warn: Warnings) -> Iterator[None]:
    """What USD would print on stderr meanwhile becomes warnings about ``path``."""
    delegate = UsdUtils.CoalescingDiagnosticDelegate()
    try:
        yield
    finally:
        for diagnostic in delegate.TakeUncoalescedDiagnostics():
            warn(path, _short(diagnostic.commentary))
        del delegate


@contextmanager
def usd_errors(path: str | Path) -> Iterator[None]:
    """An error that USD raises meanwhile becomes a StageError about ``path``; one about a prim of it names it too."""
    try:
        yield
    except Tf.ErrorException as error:
        raise StageError(f"{path}: USD gives up on it ({_first_error(error)})") from None
    except ValueError as error:
        if str(path) in str(error):
            raise
        kind = TooLarge if isinstance(error, TooLarge) else StageError
        raise kind(f"{path}: {error}") from None


def open_stage(
    path: str | Path,
    session_layer: str | Path | None = None,
    mask: str | Iterable[str] | None = None,
    keep: Iterable[str] = (),
) -> Usd.Stage:
    """Open a stage, loading all payloads.

    ``session_layer``: file whose opinions are stronger than the stage's. ``mask``: prim paths, as a sequence or one
    string with commas or blanks between; only they, their ancestors and descendants, what they are bound to and the
    prims of the absolute paths in ``keep`` exist.

    Raises StageError when the file is missing, is no USD, or holds no prim.
    """
    root = _layer(path)
    session = Sdf.Layer.CreateAnonymous("session") if session_layer is None else _layer(session_layer)
    with usd_errors(path):
        if mask is None:
            stage = Usd.Stage.Open(root, session)
        else:
            stage = Usd.Stage.OpenMasked(root, session, _mask([*_paths(mask), *(k for k in keep if k.startswith("/"))]))
            stage.ExpandPopulationMask()
    if not stage.GetPseudoRoot().GetAllChildren():
        wanted = "no prim matches the mask" if mask else "the stage has no prims"
        raise StageError(f"{path}: {wanted}; there is nothing to render")
    if mask is not None:
        for wanted in _paths(mask):
            if not stage.GetPrimAtPath(wanted):
                raise StageError(f"{path}: mask names {wanted}, but there is no such prim")
    return stage


def metres_per_unit(path: str | Path, stage: Usd.Stage) -> float:
    """The stage's metersPerUnit; StageError unless it is positive and finite."""
    metres = UsdGeom.GetStageMetersPerUnit(stage)
    if not 0 < metres < float("inf"):
        raise StageError(f"{path}: metersPerUnit is {metres}; author a positive length such as 1 or 0.01")
    return metres


def up_axis(path: str | Path, stage: Usd.Stage) -> str:
    """The stage's upAxis, Y or Z; StageError for any other, which USD has no meaning for."""
    axis = str(UsdGeom.GetStageUpAxis(stage))
    if axis not in ("Y", "Z"):
        raise StageError(f"{path}: upAxis is {axis!r}; author 'Y' or 'Z' and turn the scene's root instead")
    return axis


def _layer(path: str | Path) -> Sdf.Layer:
    text = str(path)
    plain = not text.startswith("anon:") and "[" not in text
    if plain and not Path(text).exists():
        raise StageError(f"{text}: no such file; give the path of a {_FORMATS} file")
    if plain and not Path(text).is_file():
        raise StageError(f"{text}: is a folder; give the path of a {_FORMATS} file")
    if plain and text.lower().endswith(".usdz"):
        check_package(text)
    try:
        layer = Sdf.Layer.FindOrOpen(text)
    except Tf.ErrorException as error:
        raise StageError(f"{text}: is no USD file that can be read ({_first_error(error)})") from None
    if layer is None:
        raise StageError(f"{text}: cannot be read; give the path of a {_FORMATS} file")
    return layer


def _paths(mask: str | Iterable[str]) -> list[str]:
    return mask.replace(",", " ").split() if isinstance(mask, str) else [str(p) for p in mask]


def _mask(paths: Iterable[str]) -> Usd.StagePopulationMask:
    population = Usd.StagePopulationMask()
    for path in paths:
        if not Sdf.Path.IsValidPathString(path) or not Sdf.Path(path).IsAbsoluteRootOrPrimPath():
            raise StageError(f"mask names {path!r}; expected absolute prim paths such as /World/ball")
        population.Add(path)
    return population


def _first_error(error: Exception) -> str:
    """The sentence inside USD's own report."""
    found = re.findall(r": '(.*?)'\s*$", str(error), re.M | re.S)
    return _bare(found[0] if found else str(error))


def _bare(message: str) -> str:
    return " ".join(message.split())


def _short(message: str) -> str:
    """A composition error without its tail about internals."""
    return _bare(re.sub(r" \((?:instantiating|recomposing) stage.*$", "", re.sub(r"^In <[^>]*>: ", "", message)))
