"""Tables kept on disk, one file each, under a name made from everything that decides their content.

Writers never meet: each writes a file of its own and renames it into place, and two that simulate the same table
write the same bytes. A file that cannot be read is deleted and counts as absent. The least recently used files go
when the folder outgrows its limit.
"""

import hashlib
import os
import zipfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Protocol

import numpy as np

from scratchwarp.profiles.profile import Profile
from scratchwarp.profiles.table import Table, assembled
from scratchwarp.scene import check_archive
from scratchwarp.whole import whole

# Raised whenever the same arguments would give other numbers than before.
TABLE_VERSION = 2
_SUFFIX = ".profile.npz"
_FOLDER_VARIABLE = "SCRATCHWARP_CACHE"
_UNREADABLE = (OSError, ValueError, KeyError, EOFError, zipfile.BadZipFile)


def default_folder() -> Path:
    """``$SCRATCHWARP_CACHE``, else scratchwarp/profiles in the user's cache folder ($XDG_CACHE_HOME or ~/.cache)."""
    own = os.environ.get(_FOLDER_VARIABLE)
    base = Path(own) if own else Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "scratchwarp"
    return base / "profiles"


class TableStore(Protocol):
    """Whatever keeps tables."""

    def table(self, key: str, simulate: Callable[[], Table]) -> Table:
        """The table under ``key``, simulated where it is not there."""
        ...


@dataclass(frozen=True)
class Store:
    """A folder of tables. ``path``: the folder, made when first written to; ``limit``: bytes it may hold."""

    path: Path
    limit: int = 1 << 30

    @property
    def size(self) -> int:
        """Bytes held now."""
        return sum(size for _, size, _ in self._files())

    @property
    def count(self) -> int:
        """Tables held now."""
        return len(self._files())

    def clear(self) -> int:
        """Delete every table; how many there were."""
        files = self._files()
        for file, _, _ in files:
            file.unlink(missing_ok=True)
        return len(files)

    def load(self, key: str) -> Table | None:
        """The table kept under ``key``, or None. A damaged file is deleted."""
        file = self.path / (key + _SUFFIX)
        try:
            table = read_table(file)
        except FileNotFoundError:
            return None
        except _UNREADABLE:
            file.unlink(missing_ok=True)
            return None
        os.utime(file)
        return table

    def keep(self, key: str, table: Table) -> None:
        """Write ``table`` under ``key``, then drop the least recently used files over the limit (never the one just
        written)."""
        self.path.mkdir(parents=True, exist_ok=True)
        with whole(self.path / (key + _SUFFIX)) as draft, draft.open("wb") as stream:
            write_table(table, stream)
        self._trim(key + _SUFFIX)

    def table(self, key: str, simulate: Callable[[], Table]) -> Table:
        """The table under ``key``, simulated and kept if it is not there."""
        found = self.load(key)
        if found is None:
            found = simulate()
            self.keep(key, found)
        return found

    def _files(self) -> list[tuple[Path, int, float]]:
        """(file, bytes, last use) of every table, oldest use first."""
        found = []
        for file in self.path.glob("*" + _SUFFIX) if self.path.is_dir() else ():
            try:
                status = file.stat()
            except FileNotFoundError:
                continue
            found.append((file, status.st_size, status.st_mtime))
        return sorted(found, key=lambda entry: (entry[2], entry[0].name))

    def _trim(self, spared: str) -> None:
        files = self._files()
        total = sum(size for _, size, _ in files)
        for file, size, _ in files:
            if total <= self.limit:
                break
            if file.name != spared:
                file.unlink(missing_ok=True)
                total -= size


def store(path: str | os.PathLike[str] | None = None, limit: int = 1 << 30) -> Store:
    """The on-disk cache of tables: ``store().path``, ``.size`` [bytes], ``.count``, ``.clear()``; pass it to
    ``simulate(store=...)``.

    ``path``: a folder, by default ``default_folder()``. ``limit``: most bytes it may hold. ValueError on a limit of 0
    or less.
    """
    if limit <= 0:
        raise ValueError(f"limit must be above 0 bytes, got {limit}")
    return Store(default_folder() if path is None else Path(path), int(limit))


def table_key(profile: Profile, fresnel: Any, **arguments: Any) -> str:
    """Name of a table: a digest of the profile's points, the reflector, every argument of ``simulate`` and the
    version of this code."""
    reflector = "none" if fresnel is None else fresnel.token
    parts = [
        f"version={TABLE_VERSION}",
        profile.token,
        reflector,
        *(f"{k}={arguments[k]!r}" for k in sorted(arguments)),
    ]
    return hashlib.sha256("\n".join(parts).encode()).hexdigest()[:40]


def write_table(table: Table, target: Any) -> None:
    """A table as NPZ (to a path or a binary stream): what cannot be derived from the rest."""
    arrays: dict[str, Any] = {"by_bounce": table.by_bounce, "lost": table.lost, "rays": np.array(table.rays)}
    arrays |= {"flagged": np.array(table.gamma_flagged), "theta_model": np.array(table.theta_model)}
    if table.slices is not None and table.gamma is not None and table.slice_cosines is not None:
        arrays |= {"slices": table.slices, "gamma": table.gamma, "slice_cosines": table.slice_cosines}
    for name, value in table.metadata.items():
        arrays["metadata." + name] = np.array(value)
    np.savez(target, **arrays)


def read_table(source: Any) -> Table:
    """The table that ``write_table`` wrote. Raises OSError, ValueError, KeyError or BadZipFile on anything else."""
    check_archive(source)
    with np.load(source, allow_pickle=False) as held:
        arrays = {name: held[name] for name in held.files}
    metadata = {name.split(".", 1)[1]: value.item() for name, value in arrays.items() if name.startswith("metadata.")}
    return assembled(
        arrays["by_bounce"],
        arrays["lost"],
        slices=arrays.get("slices"),
        gamma=arrays.get("gamma"),
        slice_cosines=arrays.get("slice_cosines"),
        theta_model=str(arrays["theta_model"]),
        gamma_flagged=float(arrays["flagged"]),
        rays=int(arrays["rays"]),
        metadata=metadata,
    )
