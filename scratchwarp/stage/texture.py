"""Image files that a stage names, each decoded once."""

import tempfile
import zipfile
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path, PurePosixPath

from pxr import Sdf

from scratchwarp.scene import Texture, TooLarge

from .package import check_package
from .reading import Reading


class Textures:
    """Decoded images; ``records`` become ``Scene.textures``."""

    def __init__(self, reading: Reading) -> None:
        self.records: list[Texture] = []
        self._reading = reading
        self._known: dict[tuple[str, str], int] = {}

    def index(self, where: object, asset: Sdf.AssetPath | None, space: str) -> int:
        """Index of an asset decoded from colour ``space``; -1, with a warning that names ``where``, if it cannot be."""
        reading = self._reading
        authored = asset.path if asset else ""
        if not authored:
            reading.warn(where, "names no image file; its fallback is used")
            return -1
        if "<UDIM>" in authored:
            reading.warn(where, f"{authored}: UDIM tiles are not honoured; its fallback is used")
            return -1
        path = asset.resolvedPath if asset else ""
        if not path:
            reading.warn(where, f"{authored}: no such image file; its fallback is used")
            return -1
        key = (path, space)
        if key not in self._known:
            self._known[key] = self._load(where, path, space)
        return self._known[key]

    def _load(self, where: object, path: str, space: str) -> int:
        reading = self._reading
        if reading.load_texture is None:
            reading.warn(where, "textures are not loaded; its fallback is used")
            return -1
        try:
            with _file(path) as file:
                record = Texture(path, reading.load_texture(file, space))
        except TooLarge as error:
            raise TooLarge(f"{where}: {error}") from None
        except (OSError, ValueError, KeyError) as error:
            reading.warn(where, f"{error}; its fallback is used")
            return -1
        self.records.append(record)
        return len(self.records) - 1


@contextmanager
def _file(path: str) -> Iterator[str]:
    """The path itself, or of a temporary copy when it lies in a package (``asset.usdz[maps/a.png]``)."""
    if not path.endswith("]") or "[" not in path:
        yield path
        return
    package, _, inner = path[:-1].partition("[")
    with tempfile.TemporaryDirectory() as folder:
        check_package(package)
        copy = Path(folder, "texture").with_suffix(PurePosixPath(inner).suffix)
        with zipfile.ZipFile(package) as archive:
            copy.write_bytes(archive.read(inner))
        yield str(copy)
