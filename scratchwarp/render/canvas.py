"""The image while it is rendered: the sums of its pixels, and how many samples each tile has."""

from collections.abc import Mapping, Sequence

import numpy as np

from .checkpoint import Checkpoint
from .shoot import Sums, blank, part
from .tiles import Tile, tiles
from .trace import Job


class Canvas:
    """Sums of a window of pixels. Attributes: tiles; sums: name -> [h, w] or [h, w, 3]; samples [n]: of each tile."""

    def __init__(self, width: int, height: int, edge: int) -> None:
        self.tiles: Sequence[Tile] = tiles(width, height, edge)
        self.sums: Sums = blank(width, height)
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
        return [Job(t, n, samples - n, part(self.sums, t) if n else None) for t, n in missing]

    def put(self, job: Job, sums: Mapping[str, np.ndarray], checkpoint: Checkpoint | None) -> None:
        """Take the result of a job, and keep it on disk."""
        number = self._position[job.tile]
        for name, values in part(self.sums, job.tile).items():
            values[...] = sums[name]
        self.samples[number] = job.first + job.count
        if checkpoint is not None:
            checkpoint.keep(number, job.first + job.count, sums)

    def before(self, earlier: Mapping[int, tuple[int, np.ndarray]], begun: int) -> tuple[np.ndarray, int] | None:
        """(color sums, samples) of the pass before the one to ``begun`` samples, in which some tiles are already.

        ``earlier``: tile number -> (samples, color) of its pass before. None where a tile has none.
        """
        color, counts = self.sums["color"].copy(), set()
        for number, tile in enumerate(self.tiles):
            count = int(self.samples[number])
            if count == begun:
                if number not in earlier:
                    return None
                count, values = earlier[number]
                color[tile.y : tile.y + tile.height, tile.x : tile.x + tile.width] = values
            counts.add(count)
        return (color, counts.pop()) if len(counts) == 1 else None

    def samples_of_pixels(self) -> np.ndarray:
        """Samples [h, w] of each pixel."""
        found = np.zeros(self.sums["alpha"].shape, np.int64)
        for tile, count in zip(self.tiles, self.samples.tolist(), strict=True):
            found[tile.y : tile.y + tile.height, tile.x : tile.x + tile.width] = count
        return found
