"""Files of measured BRDFs: UTIA .bin (read and written), MERL .binary, RGL .bsdf (read)."""

import os
import struct
from pathlib import Path
from typing import Any

import numpy as np

from ..stencils.angles import SIZE
from .brdf import Brdf, grid_values

_UTIA_BYTES = 3 * SIZE * SIZE * 8
_MERL_SHAPE = (90, 90, 180)
_MERL_BYTES = 12 + 3 * int(np.prod(_MERL_SHAPE)) * 8
_MERL_SCALE = np.array([1.0, 1.15, 1.66]) / 1500.0
_TENSOR = b"tensor_file\0"
_DTYPES = ("", "u1", "i1", "<u2", "<i2", "<u4", "<i4", "<u8", "<i8", "<f2", "<f4", "<f8")


def load(path: str | os.PathLike[str]) -> Brdf:
    """The BRDF of a file, known by its suffix or else by its contents.

    UTIA .bin: float64, plane-major 3 x 288 x 288. MERL .binary: three ints 90 90 180, then three planes of float64. RGL
    .bsdf: a tensor file with rgb. Raises OSError when the file cannot be read, ValueError naming the file and its size
    when it is truncated, foreign or holds values that are not finite.
    """
    file = Path(path)
    if not file.is_file():
        raise FileNotFoundError(f"{file}: no such file")
    data = file.read_bytes()
    kind = {".bin": "utia", ".binary": "merl", ".bsdf": "rgl"}.get(file.suffix.lower()) or _sniff(data)
    if kind == "utia":
        tables = {"values": _utia(file, data)}
    elif kind == "merl":
        tables = {"values": _merl(file, data)}
    elif kind == "rgl":
        tables = _rgl(file, data)
    else:
        raise ValueError(
            f"{file}: {len(data)} bytes are no BRDF of UTIA ({_UTIA_BYTES} bytes), of MERL ({_MERL_BYTES} bytes) and "
            "no tensor file of RGL"
        )
    return Brdf(kind, tables, str(file))


def save_utia(path: str | os.PathLike[str], brdf: Any) -> None:
    """Write a ``Brdf`` or values [288, 288, 3] as UTIA .bin; ``load`` gives back the same bits."""
    values = grid_values("brdf", brdf)
    Path(path).write_bytes(np.ascontiguousarray(np.moveaxis(values, -1, 0), "<f8").tobytes())


def _sniff(data: bytes) -> str:
    if data.startswith(_TENSOR):
        return "rgl"
    if len(data) == _UTIA_BYTES:
        return "utia"
    if len(data) >= 12 and struct.unpack("<3i", data[:12]) == _MERL_SHAPE:
        return "merl"
    return ""


def _finite(file: Path, name: str, table: np.ndarray) -> np.ndarray:
    bad = int(np.count_nonzero(~np.isfinite(table)))
    if bad:
        raise ValueError(f"{file}: {bad} of {table.size} values of {name} are not finite; the file is damaged")
    table.setflags(write=False)
    return table


def _utia(file: Path, data: bytes) -> np.ndarray:
    if len(data) != _UTIA_BYTES:
        raise ValueError(
            f"{file}: {len(data)} bytes, but a UTIA BRDF has {_UTIA_BYTES} (3 planes of 288 x 288 float64); the file "
            f"is {'truncated' if len(data) < _UTIA_BYTES else 'another format'}"
        )
    planes = np.frombuffer(data, "<f8").reshape(3, SIZE, SIZE)
    return _finite(file, "the BRDF", np.ascontiguousarray(np.moveaxis(planes, 0, -1), np.float64))


def _merl(file: Path, data: bytes) -> np.ndarray:
    if len(data) < 12 or struct.unpack("<3i", data[:12]) != _MERL_SHAPE:
        raise ValueError(f"{file}: {len(data)} bytes that do not begin with 90 90 180, so not a MERL BRDF")
    if len(data) != _MERL_BYTES:
        raise ValueError(
            f"{file}: {len(data)} bytes, but a MERL BRDF has {_MERL_BYTES}; the file is "
            f"{'truncated' if len(data) < _MERL_BYTES else 'too long'}"
        )
    planes = np.frombuffer(data, "<f8", offset=12).reshape(3, *_MERL_SHAPE)
    return _finite(file, "the BRDF", planes * _MERL_SCALE[:, None, None, None])


def _fields(file: Path, data: bytes) -> dict[str, np.ndarray]:
    """All fields of a tensor file by name."""
    if not data.startswith(_TENSOR) or len(data) < 18:
        raise ValueError(f"{file}: {len(data)} bytes that do not begin with tensor_file, so not an RGL BRDF")
    if data[12] != 1:
        raise ValueError(f"{file}: tensor file of version {data[12]}.{data[13]}, expected 1.0")
    fields = {}
    at = 18
    try:
        for _ in range(struct.unpack_from("<I", data, 14)[0]):
            (length,) = struct.unpack_from("<H", data, at)
            name = data[at + 2 : at + 2 + length].decode("utf-8", "replace")
            rank, dtype, offset = struct.unpack_from("<HBQ", data, at + 2 + length)
            at += 2 + length + 11
            shape = struct.unpack_from(f"<{rank}Q", data, at)
            at += 8 * rank
            if not 1 <= dtype < len(_DTYPES):
                raise ValueError(f"{file}: field {name!r} has the unknown type {dtype}; the file is damaged")
            size = int(np.prod([float(n) for n in shape])) * np.dtype(_DTYPES[dtype]).itemsize
            if offset + size > len(data):
                raise ValueError(
                    f"{file}: {len(data)} bytes, but field {name!r} ends at {offset + size}; the file is truncated"
                )
            count = size // np.dtype(_DTYPES[dtype]).itemsize
            fields[name] = np.frombuffer(data, _DTYPES[dtype], count, offset).reshape(shape)
    except struct.error:
        raise ValueError(f"{file}: {len(data)} bytes end inside the list of fields; the file is truncated") from None
    return fields


def _rgl(file: Path, data: bytes) -> dict[str, np.ndarray]:
    fields = _fields(file, data)
    if "rgb" not in fields and "spectra" in fields:
        raise ValueError(f"{file}: holds spectra, not rgb; take the file of the same material that ends in _rgb.bsdf")
    ranks = {"phi_i": 1, "theta_i": 1, "ndf": 2, "sigma": 2, "vndf": 4, "rgb": 5}
    tables = {}
    for name, rank in ranks.items():
        if name not in fields:
            raise ValueError(f"{file}: has no field {name!r}, only {', '.join(sorted(fields)) or 'none'}")
        table = fields[name]
        if table.ndim != rank or min(table.shape) < 1 or table.dtype.kind != "f":
            raise ValueError(
                f"{file}: field {name!r} is {table.dtype} {list(table.shape)}, expected rank {rank} of floats"
            )
        tables[name] = _finite(file, name, table.astype(np.float64))
    lead = (len(tables["phi_i"]), len(tables["theta_i"]))
    for name in ("vndf", "rgb"):
        if tables[name].shape[:2] != lead or min(tables[name].shape[-2:]) < 2:
            raise ValueError(
                f"{file}: field {name!r} has shape {list(tables[name].shape)}, expected {list(lead)} first"
            )
    if tables["rgb"].shape[2] != 3 or min(*tables["ndf"].shape, *tables["sigma"].shape) < 2:
        raise ValueError(f"{file}: the shapes of rgb, ndf or sigma are not those of an RGL BRDF")
    for name in ("phi_i", "theta_i"):
        if np.any(np.diff(tables[name]) <= 0.0):
            raise ValueError(f"{file}: field {name!r} must ascend")
    return tables
