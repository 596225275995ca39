"""Where the reference cases lie: the shared folder when it is there, the project's own thinned copies otherwise."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np

TESTS = Path(__file__).resolve().parents[1]
OWN = TESTS / "reference" / "cases"
SHARED = TESTS.parents[1] / "shared" / "cases"


def folder(kind: str) -> Path:
    """Folder of a kind of cases, "msl" or "six_speed"."""
    return SHARED / kind if (SHARED / kind).is_dir() else OWN / kind


def table(path: Path) -> tuple[np.ndarray, dict[str, np.ndarray]]:
    """Times and columns of a reference file; its first column is the time."""
    with path.open(newline="") as file:
        rows = csv.reader(file)
        names = next(rows)
        values = np.array([[float(x) for x in row] for row in rows if row])
    return values[:, 0], {name: values[:, i] for i, name in enumerate(names) if i}
