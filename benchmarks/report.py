"""The table that `make bench` prints and writes into the documentation."""

from __future__ import annotations

import platform
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

BEGIN = "<!-- benchmarks: begin, written by the command below -->"
END = "<!-- benchmarks: end -->"


@dataclass(frozen=True)
class Row:
    """One line: what was measured, the figure, the target, and whether it is met (None: no target)."""

    what: str
    measured: str
    target: str = ""
    met: bool | None = None

    def cells(self) -> tuple[str, str, str, str]:
        """As text."""
        return self.what, self.measured, self.target, {True: "yes", False: "NO", None: ""}[self.met]


HEAD = ("what", "measured", "target", "met")


def machine() -> str:
    """Processor and software in words."""
    name = platform.processor() or platform.machine()
    info = Path("/proc/cpuinfo")
    if info.exists():
        models = [
            line.partition(":")[2].strip() for line in info.read_text().splitlines() if line.startswith("model name")
        ]
        name = f"{len(models)} x {models[0]}" if models else name
    return f"{name}, {platform.system()}, Python {platform.python_version()}"


def markdown(rows: Sequence[Row]) -> str:
    """The table as Markdown."""
    lines = [f"| {' | '.join(HEAD)} |", "|---|---|---|---|"]
    lines += [f"| {' | '.join(row.cells())} |" for row in rows]
    return "\n".join(lines)


def plain(row: Row) -> str:
    """One line on the terminal."""
    what, measured, target, met = row.cells()
    return f"{what:<58} {measured:>42}   {target:<14} {met}"


def write(path: Path, rows: Sequence[Row], command: str) -> None:
    """Put the table between the markers of a page; a page without them gets them at its end."""
    text = path.read_text(encoding="utf-8") if path.exists() else "# Benchmarks\n"
    if BEGIN not in text:
        text = f"{text.rstrip()}\n\n{BEGIN}\n{END}\n"
    head, _, rest = text.partition(BEGIN)
    tail = rest.partition(END)[2]
    block = f"{BEGIN}\n\n`{command}` on {machine()}:\n\n{markdown(rows)}\n\n{END}"
    path.write_text(head + block + tail, encoding="utf-8")
