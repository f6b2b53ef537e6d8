"""The image while it is rendered: the sums of its pixels, and how many samples each tile has."""

from collections.abc import Mapping, Sequence

import numpy as np

from .checkpoint import Checkpoint
from .launch import SUMS
from .shoot import Sums, blank, part
from .target import APART, KEPT
from .tiles import Tile, tiles
from .trace import Job


class Canvas:
    """Sums of a window of pixels. Attributes: tiles; sums: name -> [h, w] or [h, w, 3]; samples [n]: of each tile.

    Where ``remembers``, sums have what the image was after earlier passes, too: ``passes`` [h, w, KEPT, 4], the sums of
    color and their samples, the latest first.
    """

    def __init__(self, width: int, height: int, edge: int, remembers: bool = False) -> None:
        self.tiles: Sequence[Tile] = tiles(width, height, edge)
        self.sums: Sums = blank(width, height)
        if remembers:
            self.sums["passes"] = np.zeros((height, width, KEPT, 4), np.float32)
        self.samples = np.zeros(len(self.tiles), np.int64)
        self._position = {tile: i for i, tile in enumerate(self.tiles)}
        self._areas = np.array([t.width * t.height for t in self.tiles], np.int64)

    @property
    def done(self) -> int:
        """Samples of all pixels together."""
        return int(self._areas @ self.samples)

    @property
    def pixels(self) -> int:
        """Pixels of the window."""
        return int(self._areas.sum())

    def jobs(self, samples: int) -> list[Job]:
        """What is missing to ``samples`` of every pixel."""
        missing = [(t, n) for t, n in zip(self.tiles, self.samples.tolist(), strict=True) if n < samples]
        kept = {name: self.sums[name] for name in SUMS}
        return [Job(t, n, samples - n, part(kept, t) if n else None) for t, n in missing]

    def put(self, job: Job, sums: Mapping[str, np.ndarray], checkpoint: Checkpoint | None) -> None:
        """Take the result of a job, and keep it on disk."""
        number = self._position[job.tile]
        own = part(self.sums, job.tile)
        if "passes" in own:
            sums = {**sums, "passes": _remembered(own["passes"], own["color"], job.first)}
        for name, values in own.items():
            values[...] = sums[name]
        self.samples[number] = job.first + job.count
        if checkpoint is not None:
            checkpoint.keep(number, job.first + job.count, sums)

    def passes(self) -> list[tuple[np.ndarray, int]]:
        """(color sums [h, w, 3], samples) after earlier passes, where all tiles have as many samples."""
        known = self.sums.get("passes")
        if known is None or known.size == 0:
            return []
        counts = known[0, 0, :, 3].astype(int).tolist()
        return [(known[:, :, k, :3], count) for k, count in enumerate(counts) if count]

    def samples_of_pixels(self) -> np.ndarray:
        """Samples [h, w] of each pixel."""
        found = np.zeros(self.sums["alpha"].shape, np.int64)
        for tile, count in zip(self.tiles, self.samples.tolist(), strict=True):
            found[tile.y : tile.y + tile.height, tile.x : tile.x + tile.width] = count
        return found


def _remembered(passes: np.ndarray, color: np.ndarray, samples: int) -> np.ndarray:
    """``passes`` of a tile with ``color`` of so many samples before those that are there, where it is far enough from
    the latest."""
    latest = float(passes[0, 0, 0, 3])
    if samples == 0 or samples < APART * latest:
        return passes
    own = np.concatenate([color, np.full((*color.shape[:2], 1), samples, np.float32)], axis=-1)
    return np.concatenate([own[:, :, None].astype(np.float32), passes[:, :, :-1]], axis=2)
