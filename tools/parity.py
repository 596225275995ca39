"""Write the parity table: every feature of the disc clutch and its family, and the tests that show it.

Usage: parity.py FOLDER. The documentation build calls it; its output is never committed. A test says what it shows by
the mark `feature("group: feature")`; tests are read, not run. A feature without a test stands in the table as missing,
a mark that names no feature is an error.
"""

from __future__ import annotations

import ast
import sys
from collections.abc import Iterator
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent

FEATURES = {
    "geometry": ("effective radius", "annular region", "number of friction surfaces", "engagement area"),
    "direction": ("bidirectional", "unidirectional"),
    "friction model": (
        "fixed coefficients",
        "over speed",
        "over temperature",
        "over temperature and speed",
        "any law of the friction family",
    ),
    "tables": (
        "linear interpolation",
        "smooth interpolation",
        "extrapolation linear",
        "extrapolation nearest",
        "extrapolation error",
        "at least two points for linear, three for smooth",
        "axes strictly increasing",
        "every coefficient above zero",
        "static above kinetic, element by element",
    ),
    "wear": (
        "de-rating factor",
        "a state that grows with the energy of sliding",
        "changes the de-rating and the touch point",
    ),
    "thresholds": ("velocity tolerance", "engagement pressure"),
    "inputs": ("negative pressure counts as zero", "normal force", "pedal travel over a diaphragm spring"),
    "viscous loss": ("drag coefficient", "drag that falls with speed"),
    "initial state": ("locked", "unlocked"),
    "faults": (
        "off by default",
        "triggered at a time",
        "triggered by a signal",
        "cannot transmit power",
        "cannot unlock",
        "stays for the rest of the run",
        "reported as nothing, a warning or an error",
    ),
    "thermal": (
        "port joins a network",
        "thermal mass and initial temperature",
        "slip power heats the thermal mass",
        "convection that depends on a speed",
        "oil flow",
        "plates with a gradient",
    ),
    "state machine": (
        "wait while the threshold is not reached",
        "slipping forward",
        "slipping backward",
        "lock when the slip passes zero",
        "unlock when the torque exceeds the static limit",
    ),
    "outputs": ("torque, slip, state", "capacity, power, heat, energy", "temperature"),
    "code": ("C and C++ of a model that holds the clutch",),
    "fundamental clutch": (
        "kinetic torque and static limits as signals",
        "slip and mode as outputs",
        "never locks above the velocity tolerance",
    ),
    "actuation": ("fill phase", "first-order lag", "limits of the rate", "return spring"),
    "family": (
        "disc brake",
        "cone clutch",
        "dog clutch",
        "one-way clutch",
        "sprag clutch",
        "synchroniser",
        "band brake",
        "double-shoe brake",
        "centrifugal clutch",
        "torque limiter",
    ),
    "beyond": ("several clutches at once", "events at their exact instant"),
}

HEAD = """# Parity

What a disc clutch and its relatives must be able to do, and the tests that show it. The table is made from the tests:
a line without a test is missing.

| group | feature | shown by |
|---|---|---|"""


def names() -> list[str]:
    """All features as marks name them."""
    return [f"{group}: {feature}" for group, features in FEATURES.items() for feature in features]


def marks(path: Path) -> Iterator[tuple[str, str]]:
    """(feature, name of the test) of every mark in a file."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.FunctionDef):
            for mark in node.decorator_list:
                if isinstance(mark, ast.Call) and ast.unparse(mark.func).rpartition(".")[2] == "feature":
                    yield str(ast.literal_eval(mark.args[0])), node.name


def shown(folder: Path) -> dict[str, list[str]]:
    """Tests by feature; ValueError for a mark that names none."""
    found: dict[str, list[str]] = {name: [] for name in names()}
    for path in sorted(folder.rglob("test_*.py")):
        for feature, test in marks(path):
            if feature not in found:
                raise ValueError(f"{path.name}: {test} shows {feature!r}, which is not a row of tools/parity.py")
            found[feature].append(f"`{path.stem}::{test}`")
    return found


def lines(found: dict[str, list[str]]) -> Iterator[str]:
    """The page."""
    yield HEAD
    for name, tests in found.items():
        group, _, feature = name.partition(": ")
        yield f"| {group} | {feature} | {', '.join(tests) or '**missing**'} |"
    missing = sum(not tests for tests in found.values())
    count = len({test for tests in found.values() for test in tests})
    yield f"\n{len(found) - missing} of {len(found)} features are shown, by {count} tests."


def write(folder: Path) -> Path:
    """Write the page and return its path."""
    folder.mkdir(parents=True, exist_ok=True)
    path, text = folder / "parity.md", "\n".join(lines(shown(ROOT / "tests"))) + "\n"
    # an unchanged file keeps its date, so that the documentation build stays incremental
    if not path.exists() or path.read_text(encoding="utf-8") != text:
        path.write_text(text, encoding="utf-8")
    return path


if __name__ == "__main__":
    print(write(Path(sys.argv[1])))
