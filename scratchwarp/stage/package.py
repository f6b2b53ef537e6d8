"""usdz packages from strangers: what USD's own rules leave in them, and no more."""

import zipfile
from pathlib import Path, PurePosixPath

from scratchwarp.scene import StageError


def check_package(path: str | Path) -> None:
    """StageError where a usdz holds what no usdz may: compressed or encrypted files, files that claim to be larger
    than the package, names that lead out of it. Nothing is unpacked."""
    try:
        with zipfile.ZipFile(path) as archive:
            found = archive.infolist()
    except (zipfile.BadZipFile, ValueError, NotImplementedError) as error:
        raise StageError(f"{path}: is no USD package that can be read ({error})") from None
    held = Path(path).stat().st_size
    for entry in found:
        where = PurePosixPath(entry.filename)
        if entry.compress_type != zipfile.ZIP_STORED or entry.flag_bits & 1:
            raise StageError(f"{path}: {entry.filename} is compressed or encrypted, which no file in a usdz may be")
        if where.is_absolute() or ".." in where.parts or "\\" in entry.filename:
            raise StageError(f"{path}: {entry.filename!r} names a file outside of the package")
    claimed = sum(entry.file_size for entry in found)
    if claimed > held:
        raise StageError(f"{path}: its files claim {claimed} bytes, the package has {held}; it is damaged or a bomb")
