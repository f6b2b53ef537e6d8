"""Stages rendered in a process of their own, which is ended where one takes too long: a hang is a failure and no end.

    python -m tests.stability.apart < NUMBERS_AND_FOLDERS

A kernel that runs on and on hears no alarm, so the process that waits for it has to end it.
"""

import json
import os
import select
import subprocess
import sys
import time
from dataclasses import asdict
from pathlib import Path

from .fuzz import COMPILING, LIMIT, Outcome, every, plain, run_one, spent

PATIENCE = 2 * LIMIT + 2 * COMPILING
"""Seconds of its own that a process may take over a stage: what the alarm allows, compiling, and once more as shipped;
twenty times as long by the clock."""


class Apart:
    """Renders stages one after another by ``argv``, a command that reads and writes as this module does."""

    def __init__(self, argv: tuple[str, ...] = (sys.executable, "-m", "tests.stability.apart"), patience=PATIENCE):
        self.argv, self.patience = argv, patience
        self.child: subprocess.Popen | None = None

    def run(self, seed: int, folder: Path) -> Outcome:
        """What became of a stage; "hang" or "crash" where the process did not live to tell."""
        if self.child is None or self.child.poll() is not None:
            self.child = subprocess.Popen(self.argv, stdin=subprocess.PIPE, stdout=subprocess.PIPE, bufsize=0)
        child, told = self.child, b""
        assert child.stdin is not None and child.stdout is not None
        before, started = spent(child.pid), time.monotonic()
        child.stdin.write(json.dumps([seed, str(folder)]).encode() + b"\n")
        while not told.endswith(b"\n"):
            if select.select([child.stdout], [], [], 0.2)[0]:
                part = os.read(child.stdout.fileno(), 1 << 16)
                if not part:
                    return Outcome(seed, "crash", f"status {child.wait()}")
                told += part
            elif spent(child.pid) - before > self.patience or time.monotonic() - started > 20 * self.patience:
                self.close()
                return Outcome(seed, "hang", f"more than {self.patience} s")
        return Outcome(**json.loads(told))

    def close(self) -> None:
        """End the process."""
        if self.child is not None:
            self.child.kill()
            self.child.wait()
            for pipe in (self.child.stdin, self.child.stdout):
                if pipe is not None:
                    pipe.close()
            self.child = None


def main(kernels: int = 1) -> None:
    """Numbers of stages and folders, one pair a line, to outcomes, one a line; ``kernels``: that may be compiled."""
    answer = os.fdopen(os.dup(1), "w")
    os.dup2(2, 1)  # what the renderer prints is no answer
    compiled: set = set()
    for line in sys.stdin:
        seed, folder = json.loads(line)
        print(json.dumps(asdict(run_one(seed, folder, compiled, kernels, plain if kernels == 1 else every))),
              file=answer, flush=True)  # fmt: skip


if __name__ == "__main__":
    main()
