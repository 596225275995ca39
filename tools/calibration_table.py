"""The table of docs/guide/calibrate.md from one run of examples/calibrate_shift.

Run it to write the table anew: `.venv/bin/python tools/calibration_table.py`. A test compares the two.
"""

from __future__ import annotations

import re
import sys
from collections.abc import Iterator
from importlib import import_module
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[1]
GUIDE = ROOT / "docs" / "guide" / "calibrate.md"
COLUMNS = (
    "shift", "jerk before", "optimum, nominal linings", "from other starts", "optimum, worst sample", "limits",
    "met by", "worst of these",
)  # fmt: skip
HEAD = f"| {' | '.join(COLUMNS)} |\n{'|---' * len(COLUMNS)}|\n"
LIMITS = {
    "six_speed": ("six-speed 3-4", "rad/s3", "jerk 850 rad/s3, heat 100 kJ, locked after 1 s"),
    "eight_speed": ("8HP70 4-5", "m/s3", "jerk 4 m/s3, heat 2500 J, locked at 1.3 s"),
}
# gearboxes that the search has not seen
OTHERS = 1000
NUMBER = re.compile(r"\d+(?:\.\d+)?(?:e[+-]?\d+)?(?=,| (?:rad|m)/s3)")


def example() -> Any:
    """The script of the example."""
    folder = str(ROOT / "examples" / "calibrate_shift")
    if folder not in sys.path:
        sys.path.append(folder)
    return import_module("calibrate_shift")


def row(shift: Any) -> str:
    """Calibrate a shift for nominal linings and for production, and run gearboxes that the search has not seen."""
    name, unit, limits = LIMITS[shift.name]
    nominal = example().calibrated(shift)
    found = example().robust(shift, nominal.system)
    seen = found.verify(OTHERS)
    held = f"{round(seen.yields * OTHERS)} of {OTHERS} other gearboxes"
    before, least, worst, others = (
        f"{one:.4g} {unit}" for one in (nominal.goal[0], nominal.goal[1], found.goal[1], max(seen.goals))
    )
    beside = ", ".join(f"{one:.4g}" for one in nominal.spread[1:]) + f" {unit}"
    return f"| {name} | {before} | {least} | {beside} | {worst} | {limits} | {held} | {others} |\n"


def table() -> str:
    """Both shifts."""
    return HEAD + "".join(row(shift()) for shift in (example().six_speed, example().eight_speed))


def shown() -> str:
    """The table of the guide."""
    found = re.search(r"^\| shift \|.*?\n(?=\n)", GUIDE.read_text(encoding="utf-8"), re.DOTALL | re.MULTILINE)
    return found[0] if found else ""


def numbers(text: str) -> Iterator[list[float]]:
    """The jerks of each line of a table."""
    for line in text.splitlines()[2:]:
        cells = line.split("|")
        yield [float(one) for cell in (*cells[2:6], cells[8]) for one in NUMBER.findall(cell)]


if __name__ == "__main__":
    made = table()
    text = GUIDE.read_text(encoding="utf-8")
    GUIDE.write_text(text.replace(shown(), made), encoding="utf-8")
    sys.stdout.write(made)
