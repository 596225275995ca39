"""CSV: a head `name [unit]` for each column, numbers with all their digits."""

from __future__ import annotations

import csv
from pathlib import Path

from clutchwork.exchange.content import Content


def write(content: Content, path: Path) -> None:
    """One line for each instant, the time first."""
    heads, cells = list[str](), list[list[object]]()
    for signal in (content.instants, *content.signals()):
        heads.append(f"{signal.name} [{signal.unit}]" if signal.unit else signal.name)
        cells.append(signal.values.tolist())
    with path.open("w", encoding="utf-8", newline="") as file:
        # names may hold commas and quotes
        csv.writer(file, lineterminator="\n").writerow(heads)
        file.writelines(",".join(map(str, line)) + "\n" for line in zip(*cells, strict=True))
