"""Count the lines of the programs in benchmarks/first_minutes: python tools/first_minutes.py prints the table."""

from __future__ import annotations

import re
from pathlib import Path

FOLDER = Path(__file__).resolve().parents[1] / "benchmarks" / "first_minutes"
PROGRAMS = {
    "clutchwork": "with_clutchwork.py",
    "PathSim": "with_pathsim.py",
    "python-control": "with_python_control.py",
}
# section of the programs -> what it says in the table
SECTIONS = {
    "model": "the model",
    "plot": "to a plot",
    "sweep": "to a sweep of 20 gains",
    "controller": "to a controller every 10 ms",
    "file": "to a file for another tool",
}


def lines(path: Path) -> dict[str, int]:
    """Lines of each section of a program that are neither empty nor comments; its docstring is in none."""
    counts: dict[str, int] = {}
    section = ""
    for line in path.read_text(encoding="utf-8").splitlines():
        begin = re.fullmatch(r"# (\w+)", line)
        if begin and begin[1] in SECTIONS:
            section = begin[1]
            counts[section] = 0
        elif section and line.strip() and not line.lstrip().startswith("#"):
            counts[section] += 1
    return counts


def rows() -> list[str]:
    """The lines of the table, without what is counted elsewhere."""
    counts = {name: lines(FOLDER / file) for name, file in PROGRAMS.items()}
    return [
        f"| {said} | " + " | ".join(str(counts[name][section]) for name in PROGRAMS) + " |"
        for section, said in SECTIONS.items()
    ]


if __name__ == "__main__":
    print("\n".join(["| | " + " | ".join(PROGRAMS) + " |", *rows()]))
