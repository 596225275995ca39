"""A study that takes some seconds, also in a process of its own: python -m support.slow_study FOLDER THREADS [LOG]."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Any

import clutchwork as cw
from support import scattered

COUNT, CHUNK = 600, 30
# short steps make slow runs
HOW: dict[str, Any] = {"t_end": 3.0, "max_step": 3e-3, "outputs": [*scattered.OUTPUTS, cw.peak("c1.slip")]}


def asked() -> dict[str, Any]:
    """What a sweep or a study of it takes."""
    return {**HOW, "vary": scattered.design(COUNT, method="sobol")}


def study(folder: Path, **how: Any) -> cw.Study:
    """All variants."""
    return cw.study(scattered.discs(), folder=folder, **{"chunk": CHUNK, **asked(), **how})


def logged(folder: Path, log: Path, **how: Any) -> cw.Study:
    """The same with a function that writes down every run."""

    def seen(run: cw.Trajectory) -> float:
        with log.open("a") as file:
            file.write("x")
        return float(run["load.speed"][-1])

    return study(folder, outputs={"seen": seen}, max_step=None, **how)


if __name__ == "__main__":
    if len(sys.argv) > 3:
        logged(Path(sys.argv[1]), Path(sys.argv[3]), threads=1)
    else:
        study(Path(sys.argv[1]), threads=int(sys.argv[2]))
