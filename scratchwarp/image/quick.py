"""Pictures that follow a slider: what ``SRGB`` shows, in eight bits, without OpenColorIO's start-up; PNG in memory."""

import struct
import zlib
from functools import lru_cache

import numpy as np

_STEPS = 4096


@lru_cache(maxsize=1)
def _curve() -> np.ndarray:
    """The sRGB curve at squares of equal steps, uint8 [_STEPS]."""
    linear = np.linspace(0.0, 1.0, _STEPS) ** 2
    shown = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
    return np.rint(255.0 * shown).astype(np.uint8)


def eight_bit(pixels: np.ndarray) -> np.ndarray:
    """Linear Rec.709 [h, w, 3] as sRGB uint8, within one step of the view ``SRGB``; what is not finite is black."""
    finite = np.nan_to_num(np.asarray(pixels, np.float32), nan=0.0, posinf=1.0, neginf=0.0)
    return _curve()[(np.sqrt(np.clip(finite, 0.0, 1.0)) * (_STEPS - 1) + 0.5).astype(np.int32)]


def png(pixels: np.ndarray) -> bytes:
    """A PNG file of uint8 pixels [h, w, 3], lightly compressed."""
    height, width, channels = pixels.shape
    if channels != 3 or pixels.dtype != np.uint8:
        raise ValueError(f"pixels are {pixels.dtype} {list(pixels.shape)}, expected uint8 [h, w, 3]")
    rows = np.zeros((height, 1 + 3 * width), np.uint8)
    rows[:, 1:] = pixels.reshape(height, -1)

    def chunk(kind: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    body = zlib.compress(rows.tobytes(), 1)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", body) + chunk(b"IEND", b"")
