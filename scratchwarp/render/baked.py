"""Tables simulated beforehand, beside the stage: found again by the hash of all that decides them, never used stale.

``cup.usda`` has its tables in the folder ``cup.bake``: one file each, named by its key, and ``bake.json`` with the
SHA-256 of every file and the keys of every layer. Coverage lies beside them, see ``plan.coverage``.
"""

import hashlib
import io
import json
import zipfile
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from ..plan.coverage import bake_folder
from ..profiles import Table
from ..profiles.cache import read_table, write_table
from ..whole import whole

INDEX = "bake.json"
SUFFIX = ".profile.npz"


@dataclass
class Baked:
    """Tables of a bake, as a store for ``profiles.simulate``.

    Attributes:
        folder: where they lie. files: key -> SHA-256. users: layers of each -> keys.
        missed: keys asked for in vain since ``note`` was called last.
        warnings: what was stale or damaged.
    """

    folder: Path
    files: Mapping[str, str]
    users: Mapping[str, list[str]]
    missed: list[str] = field(default_factory=list)
    warnings: list[str] = field(default_factory=list)

    def table(self, key: str, simulate: Callable[[], Table]) -> Table:
        """The table under ``key`` where it is there and whole, else a simulated one."""
        if key in self.files:
            try:
                data = (self.folder / f"{key}{SUFFIX}").read_bytes()
                if hashlib.sha256(data).hexdigest() == self.files[key]:
                    return read_table(io.BytesIO(data))
            except (OSError, ValueError, KeyError, EOFError, zipfile.BadZipFile) as error:
                self._say(f"{self.folder}: {key}{SUFFIX} cannot be read ({error}) and was simulated again")
            else:
                self._say(f"{self.folder}: {key}{SUFFIX} is not the file that was baked and was simulated again")
        self.missed.append(key)
        return simulate()

    def note(self, users: Iterable[str]) -> bool:
        """Say so where a table of ``users`` was not there; whether it was."""
        missed, self.missed = self.missed, []
        if not missed:
            return True
        name = ", ".join(users)
        if any(key not in self.files for key in missed):
            what = "is stale" if name in self.users else "is missing"
            self._say(f"{self.folder}: the bake of {name} {what}; it was simulated, run scratchwarp bake again")
        return False

    def _say(self, text: str) -> None:
        if text not in self.warnings:
            self.warnings.append(text)


def find(stage: str | Path) -> Baked | None:
    """The bake of a stage, None where there is none; one whose index cannot be read is empty and says so."""
    folder = bake_folder(stage) if str(stage) else None
    if folder is None or not (folder / INDEX).is_file():
        return None
    try:
        index = json.loads((folder / INDEX).read_text(encoding="utf-8"))
        files = {str(key): str(digest) for key, digest in index["files"].items()}
        users = {str(name): [str(key) for key in keys] for name, keys in index["users"].items()}
    except (OSError, ValueError, KeyError, AttributeError, TypeError) as error:
        said = f"{folder / INDEX}: cannot be read ({error}); run scratchwarp bake again"
        return Baked(folder, {}, {}, warnings=[said])
    return Baked(folder, files, users)


@dataclass
class Oven:
    """Simulates every table that it is asked for and keeps it in ``folder``; ``close`` writes the index.

    ``asked``: keys since ``note`` was called last.
    """

    folder: Path
    files: dict[str, str] = field(default_factory=dict)
    users: dict[str, list[str]] = field(default_factory=dict)
    asked: list[str] = field(default_factory=list)

    def table(self, key: str, simulate: Callable[[], Table]) -> Table:
        """Simulate and keep a table."""
        self.asked.append(key)
        target = self.folder / f"{key}{SUFFIX}"
        self.folder.mkdir(parents=True, exist_ok=True)
        made, held = simulate(), io.BytesIO()
        write_table(made, held)
        if key not in self.files:
            with whole(target) as draft:
                draft.write_bytes(held.getvalue())
            self.files[key] = hashlib.sha256(held.getvalue()).hexdigest()
        return made

    def note(self, users: Iterable[str]) -> bool:
        """Remember whose tables the last ones are."""
        known = self.users.setdefault(", ".join(users), [])
        known += [key for key in self.asked if key not in known]
        self.asked = []
        return False

    def close(self, about: Mapping[str, Any]) -> None:
        """Write the index with ``about`` in it, and remove tables of an earlier bake that are not in it."""
        self.folder.mkdir(parents=True, exist_ok=True)
        index = {**about, "files": dict(sorted(self.files.items())), "users": dict(sorted(self.users.items()))}
        with whole(self.folder / INDEX) as draft:
            draft.write_text(json.dumps(index, indent=1) + "\n", encoding="utf-8")
        for file in self.folder.glob(f"*{SUFFIX}"):
            if file.name.removesuffix(SUFFIX) not in self.files:
                file.unlink()
