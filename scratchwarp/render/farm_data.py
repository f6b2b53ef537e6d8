"""An image as bytes: a head of its own, and parts (meshes, textures, curves, tables) that images have in common."""

import copyreg
import hashlib
import io
import pickle
from collections.abc import Mapping, MutableMapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import Any, NamedTuple

from ..kernels import KernelKey
from ..kernels.stamp import stamp
from ..plan import EffectPlan
from ..profiles import Table
from ..scene import Curves, Measured, Mesh, Scene, Texture

SHARED = (Mesh, Curves, Texture, Measured, Table)
"""Records that are parts: the frames of a sequence have most of them in common."""
PART = 1 << 16
"""Bytes that make a part worth its own sending; smaller ones travel in the head."""


class Image(NamedTuple):
    """What a worker needs to render an image, and the number of its kernel here."""

    scene: Scene
    plan: EffectPlan
    tables: Sequence[Table]
    key: KernelKey
    number: int
    device: str


@dataclass(frozen=True, eq=False)
class Packed:
    """An image as bytes, for ``unpacked`` of the same version alone. ``parts``: hash -> the large parts."""

    head: bytes
    parts: Mapping[str, bytes]

    @property
    def size(self) -> int:
        """Bytes of it all."""
        return len(self.head) + sum(len(part) for part in self.parts.values())


def packed(
    scene: Scene,
    plan: EffectPlan,
    tables: Sequence[Table],
    key: KernelKey,
    device: str,
    pickled: MutableMapping[Any, tuple[str, bytes]] | None = None,
) -> Packed:
    """An image as bytes; ``pickled``: record -> its hash and bytes, of images before, where this one's are added."""
    held = io.BytesIO()
    pickler = _WithParts(held, {} if pickled is None else pickled)
    pickler.dump(Image(scene, plan, tables, key, stamp(key), device))
    return Packed(held.getvalue(), pickler.parts)


def unpacked(head: bytes, parts: Mapping[str, bytes], known: dict[str, Any] | None = None) -> Image:
    """What ``packed`` was given. ``known``: records by hash that are there already, and are taken as they are; those
    of this image are put there, and no others stay."""
    known = {} if known is None else known
    unpickler = _FromParts(io.BytesIO(head), parts, known)
    image: Image = unpickler.load()
    for name in known.keys() - unpickler.used:
        del known[name]
    return image


def _read_only(values: Mapping[Any, Any]) -> Mapping[Any, Any]:
    return MappingProxyType(dict(values))


class _Pickler(pickle.Pickler):
    """One that knows mappings which cannot be changed."""

    dispatch_table = copyreg.dispatch_table | {MappingProxyType: lambda values: (_read_only, (dict(values),))}


class _WithParts(_Pickler):
    """One that puts shared records aside."""

    def __init__(self, held: io.BytesIO, pickled: MutableMapping[Any, tuple[str, bytes]]) -> None:
        super().__init__(held, pickle.HIGHEST_PROTOCOL)
        self.parts: dict[str, bytes] = {}
        self._pickled = pickled

    def persistent_id(self, record: Any) -> tuple[str, bytes | None] | None:
        """(hash, bytes where they travel here) of a shared record, None for what is none."""
        if not isinstance(record, SHARED):
            return None
        if record not in self._pickled:
            held = io.BytesIO()
            _Pickler(held, pickle.HIGHEST_PROTOCOL).dump(record)
            data = held.getvalue()
            self._pickled[record] = hashlib.sha256(data).hexdigest()[:32], data
        name, data = self._pickled[record]
        if len(data) < PART:
            return name, data
        self.parts[name] = data
        return name, None


class _FromParts(pickle.Unpickler):
    """One that finds them again: equal records are one object, over all images that a worker gets."""

    def __init__(self, held: io.BytesIO, parts: Mapping[str, bytes], known: dict[str, Any]) -> None:
        super().__init__(held)
        self.used: set[str] = set()
        self._parts, self._known = parts, known

    def persistent_load(self, pid: tuple[str, bytes | None]) -> Any:
        """The record of a hash."""
        name, data = pid
        self.used.add(name)
        if name not in self._known:
            self._known[name] = pickle.loads(self._parts[name] if data is None else data)
        return self._known[name]
