"""A number that changes with the device code and with the key.

Warp names a compiled module by a hash of the kernel, but leaves out functions that a nested function picks by
``wp.static`` in an unrolled loop; without this stamp an edited light or distribution would run from a stale cache.
"""

import hashlib
from functools import lru_cache
from pathlib import Path

from .key import KernelKey


@lru_cache(maxsize=1)
def device_code() -> bytes:
    """Hash of every device file of the package."""
    sha = hashlib.sha256()
    package = Path(__file__).resolve().parent.parent
    for path in sorted(package.rglob("*_device.py")):
        sha.update(path.relative_to(package).as_posix().encode())
        sha.update(path.read_bytes())
    return sha.digest()


def stamp(key: KernelKey) -> int:
    """A positive 31-bit number of the device code and ``key``."""
    return int.from_bytes(hashlib.sha256(device_code() + repr(key).encode()).digest()[:4], "little") >> 1 | 1
