"""Finished tiles on disk as they end, so that a render that was ended in any way goes on, to the same bits.

A file has a header (what is rendered, as named parts) and two slots a tile, each with the sums of that tile and a check
sum. Passes over a tile are written to one slot and the other in turn: whatever a process was at when it was killed, the
slot that it did not write to is whole.
"""

import json
import struct
import zlib
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import BinaryIO

import numpy as np

from ..kernels import kernel_key
from ..plan import EffectPlan
from ..scene import Scene
from ..whole import whole
from .described import described
from .tiles import Tile

MAGIC = b"scratchwarp checkpoint 2\n"
FINISHED = b"scratchwarp finished it 2\n"  # in its place once the image is written
_HEAD = struct.Struct("<I")
_SLOT = struct.Struct("<IQ")  # check sum, samples

Sums = dict[str, np.ndarray]


class Checkpoint:
    """An open checkpoint of one render. ``samples`` [n]: of each tile that are in it."""

    def __init__(
        self,
        path: str | Path,
        about: Mapping[str, str],
        tiles: Sequence[Tile],
        sums: Mapping[str, np.ndarray],
        fresh: bool = True,
    ) -> None:
        """A new checkpoint in place of any file at ``path``, or where not ``fresh`` the file that is there. ``about``:
        what is rendered, part by part; ``sums``: of the window, for their types."""
        self.path, self._tiles = Path(path), tuple(tiles)
        self._kinds = {name: (v.dtype, v.shape[2:]) for name, v in sums.items()}
        pixel = sum(kind.itemsize * int(np.prod(shape)) for kind, shape in self._kinds.values())
        self._slot = _SLOT.size + pixel * max((t.width * t.height for t in tiles), default=0)
        self.samples = np.zeros(len(self._tiles), np.int64)
        self._next = np.zeros(len(self._tiles), np.int64)
        described = {"about": dict(about), "tiles": len(self._tiles), "slot": self._slot}
        header = json.dumps(described, sort_keys=True).encode()
        if fresh:
            with whole(self.path) as draft:
                draft.write_bytes(MAGIC + _HEAD.pack(len(header)) + header)
        self._file: BinaryIO = self.path.open("r+b", buffering=0)
        self._file.seek(len(MAGIC))
        (length,) = _HEAD.unpack(self._file.read(_HEAD.size))
        self._start = len(MAGIC) + _HEAD.size + length

    @classmethod
    def resume(
        cls, path: str | Path, about: Mapping[str, str], tiles: Sequence[Tile], sums: Mapping[str, np.ndarray]
    ) -> "Checkpoint":
        """The checkpoint at ``path``, its tiles filled into ``sums``; a new one where there is no file.

        Raises ValueError where the file is no checkpoint, or is of another render, naming what differs.
        """
        if not Path(path).exists() or _check(path, about) == FINISHED:
            return cls(path, about, tiles, sums)
        made = cls(path, about, tiles, sums, fresh=False)
        for number, tile in enumerate(tiles):
            found = [made._read(number, slot) for slot in (0, 1)]
            samples = [-1 if f is None else f[0] for f in found]
            best = int(np.argmax(samples))
            known = found[best]
            if known is not None:
                made.samples[number], made._next[number] = known[0], 1 - best
                for name, values in known[1].items():
                    sums[name][tile.y : tile.y + tile.height, tile.x : tile.x + tile.width] = values
        return made

    def keep(self, number: int, samples: int, sums: Mapping[str, np.ndarray]) -> None:
        """Write the sums of tile ``number`` over ``samples`` of each of its pixels."""
        body = b"".join(np.ascontiguousarray(sums[name]).tobytes() for name in self._kinds)
        self._file.seek(self._place(number, int(self._next[number])))
        record = _SLOT.pack(zlib.crc32(body, samples & 0xFFFFFFFF), samples) + body
        rest = memoryview(record)
        while len(rest):  # a signal may cut a write short
            written = self._file.write(rest)
            if not written:
                raise OSError(f"{self.path}: cannot be written to its end; is the disk full?")
            rest = rest[written:]
        self.samples[number] = samples
        self._next[number] = 1 - self._next[number]

    def close(self) -> None:
        """Close the file and leave it where it is."""
        self._file.close()

    def _place(self, number: int, slot: int) -> int:
        return self._start + (2 * number + slot) * self._slot

    def _read(self, number: int, slot: int) -> tuple[int, Sums] | None:
        """(samples, sums) of a slot; None where it was never written, or not to its end."""
        tile = self._tiles[number]
        self._file.seek(self._place(number, slot))
        head = self._file.read(_SLOT.size)
        if len(head) < _SLOT.size:
            return None
        check, samples = _SLOT.unpack(head)
        pixels = tile.width * tile.height
        size = sum(kind.itemsize * int(np.prod(shape)) * pixels for kind, shape in self._kinds.values())
        body = self._file.read(size)
        if samples == 0 or len(body) < size or zlib.crc32(body, samples & 0xFFFFFFFF) != check:
            return None
        made, at = {}, 0
        for name, (kind, shape) in self._kinds.items():
            count = pixels * int(np.prod(shape))
            made[name] = np.frombuffer(body, kind, count, at).reshape(tile.height, tile.width, *shape)
            at += count * kind.itemsize
        return samples, made


def finish(path: str | Path) -> None:
    """Leave of a checkpoint whose image is written nothing but what it was of."""
    with Path(path).open("rb") as file:
        file.seek(len(MAGIC))
        head = file.read(_HEAD.size)
        about = file.read(*_HEAD.unpack(head))
    with whole(Path(path)) as draft:
        draft.write_bytes(FINISHED + head + about)


def is_finished(path: str | Path, scene: Scene, plan: EffectPlan) -> bool:
    """Whether ``finish`` was called on the checkpoint of this render; ValueError where it is of another one."""
    return Path(path).is_file() and _check(path, described(scene, plan, kernel_key(scene, plan))) == FINISHED


def _check(path: str | Path, about: Mapping[str, str]) -> bytes:
    """How a file begins; ValueError where it is not the checkpoint of a render described by ``about``."""
    try:
        with Path(path).open("rb") as file:
            magic = file.readline(64)
            if magic not in (MAGIC, FINISHED):
                raise ValueError("it does not begin like one")
            (length,) = _HEAD.unpack(file.read(_HEAD.size))
            found = json.loads(file.read(min(length, 1 << 24)))["about"]
            there = {str(name): str(value) for name, value in found.items()}
    except (OSError, ValueError, KeyError, TypeError, AttributeError, struct.error) as error:
        raise ValueError(f"{path}: not a checkpoint of scratchwarp ({error})") from None
    if {**there, "stage": ""} != {**about, "stage": ""}:  # the same content under another name is the same
        raise ValueError(
            f"{path}: the checkpoint is of another stage, settings or version: {differences(about, there)}; delete it "
            "or leave out --resume"
        )
    return magic


def differences(here: Mapping[str, str], there: Mapping[str, str]) -> str:
    """What differs between two renders, part by part; hashes are not shown.

    >>> differences({"spp": "4", "meshes": "#a"}, {"spp": "8", "meshes": "#b"})
    'spp is 4 here and 8 there, other meshes'
    """
    said = []
    for name in dict.fromkeys([*here, *there]):
        mine, its = here.get(name, "nothing"), there.get(name, "nothing")
        if mine != its:
            said.append(f"other {name}" if "#" in mine[:1] + its[:1] else f"{name} is {mine} here and {its} there")
    return ", ".join(said)
