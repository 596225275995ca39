"""Copy the cases that can be expressed, thinned, into the project: `python tests/reference/thin.py FOLDER_OF_MSL`."""

from __future__ import annotations

import csv
import shutil
import sys
from pathlib import Path

import numpy as np
import yaml

HERE = Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parent))

ROWS = 250


def thin(source: Path, target: Path) -> None:
    """Evenly spaced rows, those at events with their neighbours, and the extremes of every column."""
    from support import cases

    times, columns = cases.table(source / "reference.csv")
    n = len(times)
    kept = set(np.linspace(0, n - 1, min(n, ROWS)).round().astype(int).tolist())
    for row in np.flatnonzero(np.diff(times) <= 1e-9):
        kept |= {row, row + 1}
    for name, values in columns.items():
        kept |= {int(np.argmin(values)), int(np.argmax(values))}
        if name.endswith(("mode", "stuck", "startForward", "startBackward")):
            for row in np.flatnonzero(np.diff(values) != 0):
                kept |= {row, row + 1}
    target.mkdir(parents=True, exist_ok=True)
    with (source / "reference.csv").open(newline="") as file:
        header, *rows = csv.reader(file)
    with (target / "reference.csv").open("w", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(header)
        writer.writerows(rows[row] for row in sorted(kept))
    shutil.copyfile(source / "case.yaml", target / "case.yaml")


def main(source: Path) -> None:
    """All cases of a folder."""
    from reference.msl.elements import missing

    target = HERE / "cases" / "msl"
    shutil.copyfile(source / "reference_errors.csv", target / "reference_errors.csv")
    for path in sorted(source.glob("*/case.yaml")):
        if not missing(yaml.safe_load(path.read_text())):
            thin(path.parent, target / path.parent.name)
    # cases that were here and cannot be expressed
    for path in target.glob("*/case.yaml"):
        if missing(yaml.safe_load(path.read_text())):
            shutil.rmtree(path.parent)


if __name__ == "__main__":
    main(Path(sys.argv[1]))
