"""Render an exported scene with Mitsuba, in a process of its own: a library of LLVM that does not suit ends it."""

import os
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

Array = Any  # of NumPy, which loads when a pipeline runs

VARIABLE = "DRJIT_LIBLLVM_PATH"
_PLACES = ("/usr/lib/*-linux-gnu", "/usr/lib64", "/usr/lib/llvm-*/lib", "/opt/homebrew/opt/llvm/lib")
_found: list[str | None] = []


def libraries() -> Iterator[str | None]:
    """Libraries of LLVM to try: the one that is set, Mitsuba's own choice (None), then what lies about, newest
    first."""
    if _found:
        yield _found[0]
        return
    yield os.environ.get(VARIABLE)
    files: dict[str, float] = {}
    roots = [p for place in _PLACES for p in Path("/").glob(place.removeprefix("/"))]
    roots += Path.home().glob(".rustup/toolchains/*/lib")
    for root in roots:
        for file in root.glob("libLLVM*.so*"):
            number = "".join(c if c.isdigit() or c == "." else " " for c in file.name.replace(".so.", " ")).split()
            files[str(file.resolve())] = max(
                (float(".".join(n.split(".")[:2])) for n in number if n[0] != "."), default=0
            )
    yield from sorted(files, key=lambda file: -files[file])[:6]


def render(folder: Path, spp: int) -> tuple[Array | None, str]:
    """(linear image [h, w, 3], "") of the scene in ``folder``, or (None, why there is none)."""
    from scratchwarp import image

    said = "no library of LLVM suits it; set DRJIT_LIBLLVM_PATH to one of version 17 or later"
    with tempfile.TemporaryDirectory() as place:
        out = Path(place) / "image.exr"
        for library in libraries():
            where = {**os.environ, **({VARIABLE: library} if library else {})}
            command = [sys.executable, str(folder / "render.py"), str(out), str(spp)]
            done = subprocess.run(command, env=where, capture_output=True, text=True)
            if done.returncode == 0 and out.is_file():
                _found[:] = [library]
                return image.read_texture(str(out), "raw")[..., :3].copy(), ""
            if "No module named" in done.stderr:
                return None, "the package mitsuba is missing (extra export)"
            if done.returncode > 0 and "LLVM" not in done.stderr:
                return None, " ".join(done.stderr.strip().splitlines()[-1:])
    return None, said
