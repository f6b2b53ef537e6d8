"""Arrays that a .usdc file claims to hold, from its tables alone: no array is read or unpacked.

Layout (OpenUSD, pxr/usd/sdf/crateFile.h, version 0.7 and later): "PXR-USDC", 8 bytes of version, the place of the table
of contents; there sections of name, start and size. Section FIELDS holds a representation of every value, packed by
LZ4: in its upper 16 bits whether it is an array, lies here itself, is packed, and its type; below them the place of its
data, which for an array begins with its number of elements.
"""

import mmap
import struct
import zipfile
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path

from pxr import Ar, Sdf, Usd

from scratchwarp.scene import Budget

_SIZES = {
    1: 1, 2: 1, 3: 4, 4: 4, 5: 8, 6: 8, 7: 2, 8: 4, 9: 8, 10: 24, 11: 8, 12: 24, 13: 32, 14: 72, 15: 128, 16: 32,
    17: 16, 18: 8, 19: 16, 20: 8, 21: 4, 22: 8, 23: 24, 24: 12, 25: 6, 26: 12, 27: 32, 28: 16, 29: 8, 30: 16,
}  # fmt: skip
_NAMES = {
    3: "int",
    4: "unsigned int",
    8: "float",
    9: "double",
    20: "GfVec2f",
    24: "GfVec3f",
    28: "GfVec4f",
    17: "GfQuatf",
}
_SAMPLES = 46
_MOST_SAMPLES = 1 << 20
Claim = tuple[int, int, str]


def check_arrays(stage: Usd.Stage, budget: Budget) -> None:
    """TooLarge naming file and attributes where an array of one of a stage's .usdc files, also of those in packages,
    claims to take more than ``budget`` has in all. Files that cannot be understood are left to USD."""
    for layer in stage.GetUsedLayers():
        size, count, kind = 0, 0, ""
        with suppress(OSError, ValueError, struct.error, IndexError, KeyError, zipfile.BadZipFile):
            size, count, kind = max(_of(layer.realPath), default=(0, 0, ""))
        if size > budget.limit:
            budget.take(size, _named(layer, kind), f"an array of {count} elements")


def _named(layer: Sdf.Layer, kind: str) -> str:
    """The file, and the attributes that may be meant."""
    found: list[str] = []

    def look(path: Sdf.Path) -> None:
        spec = layer.GetAttributeAtPath(path) if path.IsPropertyPath() else None
        if spec and str(spec.typeName.cppTypeName) == f"VtArray<{kind}>":
            found.append(str(path))

    layer.Traverse(Sdf.Path.absoluteRootPath, look)
    return f"{layer.realPath}: {' or '.join(found[:3])}" if found else layer.realPath


def _of(path: str) -> list[Claim]:
    """(bytes, elements, C++ type) of the arrays of a layer's file, or package; none for other files than .usdc."""
    outer = Path(Ar.SplitPackageRelativePathOuter(path)[0])
    if not outer.is_file():
        return []
    with open(outer, "rb") as file, mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ) as held:
        starts = [0]
        if outer.suffix.lower() == ".usdz":
            with zipfile.ZipFile(outer) as archive:
                heads = [entry.header_offset for entry in archive.infolist()]
            starts = [at + 30 + sum(struct.unpack_from("<2H", held, at + 26)) for at in heads]
        return [claim for at in starts if held[at : at + 8] == b"PXR-USDC" for claim in claims(held, at)]


def claims(held: bytes | mmap.mmap, start: int = 0) -> Iterator[Claim]:
    """(bytes, elements, C++ type or "") of the arrays of a crate that begins at ``start``. ValueError, struct.error,
    IndexError or KeyError where it is damaged."""
    if held[start + 8 : start + 11] < b"\0\x07\0":
        return
    (contents,) = struct.unpack_from("<q", held, start + 16)
    (sections,) = struct.unpack_from("<Q", held, start + contents)
    places = {}
    for i in range(min(sections, 64)):
        name, at, _ = struct.unpack_from("<16sqq", held, start + contents + 8 + 32 * i)
        places[name.rstrip(b"\0")] = start + at
    at = places[b"FIELDS"]
    count, packed = struct.unpack_from("<QQ", held, at)
    at += 16 + packed
    (packed,) = struct.unpack_from("<Q", held, at)
    values = unpacked(held[at + 8 : at + 8 + packed], 8 * count)
    for (value,) in struct.iter_unpack("<Q", values):
        yield from _claim(held, start, value)


def _claim(held: bytes | mmap.mmap, start: int, value: int) -> Iterator[Claim]:
    kind, inlined, at = value >> 48 & 0xFF, value >> 62 & 1, start + (value & (1 << 48) - 1)
    if inlined or at == start:
        return
    if value >> 63:
        (count,) = struct.unpack_from("<Q", held, at)
        yield count * _SIZES.get(kind, 8), count, _NAMES.get(kind, "")
    elif kind == _SAMPLES:
        at += struct.unpack_from("<q", held, at)[0] + 8  # behind the times
        at += struct.unpack_from("<q", held, at)[0]
        (count,) = struct.unpack_from("<Q", held, at)
        for i in range(min(count, _MOST_SAMPLES)):
            (sample,) = struct.unpack_from("<Q", held, at + 8 + 8 * i)
            if sample >> 48 & 0xFF != _SAMPLES:
                yield from _claim(held, start, sample)


def unpacked(data: bytes, size: int) -> bytes:
    """What USD has packed into ``data``: a number of chunks (0: one without its size), each a block of LZ4. ValueError
    where that are not ``size`` bytes."""
    if size > 256 * len(data):
        raise ValueError(f"{size} bytes cannot come of {len(data)}")
    made, at = bytearray(), 1
    for _ in range(max(data[0], 1)):
        long = len(data) - 1
        if data[0]:
            (long,) = struct.unpack_from("<i", data, at)
            at += 4
        begun = len(made)
        _block(data[at : at + long], made, begun, size)
        at += long
    if len(made) != size:
        raise ValueError(f"{len(made)} bytes came out, not {size}")
    return bytes(made)


def _block(data: bytes, made: bytearray, begun: int, most: int) -> None:
    """Append a block of LZ4 to ``made``."""
    at = 0

    def length(least: int) -> int:
        nonlocal at
        total = least
        while least == 15:
            total += data[at]
            at += 1
            if data[at - 1] != 255:
                break
        return total

    while at < len(data):
        token = data[at]
        at += 1
        plain = length(token >> 4)
        made += data[at : at + plain]
        at += plain
        if at >= len(data):
            return
        back = data[at] | data[at + 1] << 8
        at += 2
        again = length(token & 15) + 4
        if not 0 < back <= len(made) - begun or len(made) + again > most:
            raise ValueError("a block that is damaged")
        piece = made[-back:] if back >= again else (made[-back:] * (again // back + 1))
        made += piece[:again]
