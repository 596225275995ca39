"""Print the speed table, or write it into the documentation.

python -m benchmarks                 the table
python -m benchmarks --write         the same, and into docs/benchmarks.md between its markers
python -m benchmarks shift chain     some parts only
python -m benchmarks --build --tests also the time of a clean build and of all tests
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
# builders of models are shared with the tests; run as a file, the package itself has to be found too
sys.path[:0] = [str(ROOT), str(ROOT / "tests")]

from benchmarks import (  # noqa: E402
    chain,
    coupled,
    gradients,
    instructions,
    lanes,
    launch,
    laws,
    report,
    shift,
    startup,
    stepping,
    sweeps,
)

PARTS = {
    "shift": shift.rows,
    "stepping": stepping.rows,
    "sweeps": sweeps.rows,
    "lanes": lanes.rows,
    "gradients": gradients.rows,
    "instructions": instructions.rows,
    "coupled": coupled.rows,
    "laws": laws.rows,
    "chain": chain.rows,
    "launch": launch.rows,
    "startup": startup.rows,
}


def parse(arguments: list[str] | None) -> argparse.Namespace:
    """The command line."""
    parser = argparse.ArgumentParser(prog="python -m benchmarks", description="speed against peers, paired in one run")
    parser.add_argument("parts", nargs="*", metavar="part", help=f"some of {', '.join(PARTS)}; all when none is given")
    parser.add_argument("--quick", action="store_true", help="fewer rounds")
    parser.add_argument(
        "--write", nargs="?", const=ROOT / "docs/benchmarks.md", type=Path, help="page to write the table into"
    )
    parser.add_argument("--build", action="store_true", help="time a clean build too")
    parser.add_argument("--tests", action="store_true", help="time `make test` too")
    chosen = parser.parse_args(arguments)
    unknown = [part for part in chosen.parts if part not in PARTS]
    if unknown:
        parser.error(f"no part {', '.join(unknown)}; there are {', '.join(PARTS)}")
    return chosen


def rows(chosen: argparse.Namespace) -> Iterator[report.Row]:
    """All lines, as they are measured."""
    for name, part in PARTS.items():
        if not chosen.parts or name in chosen.parts:
            yield from part(chosen.quick)
    if chosen.build:
        yield from startup.build()
    if chosen.tests:
        yield from startup.tests()


def main(arguments: list[str] | None = None) -> int:
    """Measure, print, write; 1 when a target is missed."""
    chosen = parse(arguments)
    print(report.machine())
    print(report.plain(report.Row(*report.HEAD[:3])))
    found = []
    for row in rows(chosen):
        print(report.plain(row), flush=True)
        found.append(row)
    if chosen.write:
        extra = "".join(f" --{name}" for name in ("build", "tests") if getattr(chosen, name))
        report.write(chosen.write, found, f"python -m benchmarks --write{extra}")
        print(f"written to {chosen.write}")
    return int(any(row.met is False for row in found))


if __name__ == "__main__":
    sys.exit(main())
