"""Groups of pictures on the pages: what draws each of them, and the files that its pictures are made from."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
PLOT = "src/clutchwork/plot/*.py"
SCHEMATIC = "src/clutchwork/schematic/**/*.py"
DIAGRAMS = "src/clutchwork/diagrams/**/*.py"
CATALOGUE = "src/clutchwork/gearbox/catalogue/*.toml"
STORIES = (
    "start",
    "thermal-launch",
    "wet-clutch",
    "stick-slip",
    "shift-controller",
    "learn",
    "robotics",
    "hydraulics",
)


@dataclass(frozen=True)
class Group:
    """Pictures that are drawn together, into a folder below docs/pictures."""

    module: str  # beside this file, with `write(folder)`
    files: tuple[str, ...]  # what it draws from, as patterns below the root
    guides: tuple[str, ...] = ()  # guides whose programs draw

    def made_from(self) -> list[Path]:
        """Files that its pictures are made from."""
        own = f"docs/figures/{self.module}.py"
        found = {path for one in (own, *self.files) for path in ROOT.glob(one)}
        return sorted(path for path in found if path.is_file())

    def fingerprint(self) -> str:
        """Fingerprint of these files and of the programs of its guides."""
        texts = [path.read_text(encoding="utf-8") for path in self.made_from()]
        texts += [text for name in self.guides for text in programs(name)]
        return hashlib.sha256("\0".join(map(_bare, texts)).encode()).hexdigest()[:16]


def _bare(text: str) -> str:
    """A text without empty lines and lines that are comments, which no picture shows."""
    lines = (line.rstrip() for line in text.splitlines())
    return "\n".join(
        line for line in lines if line and not line.lstrip().startswith("#")
    )


def _examples(*names: str) -> Iterator[str]:
    for name in names:
        yield from (f"examples/{name}/*.{ending}" for ending in ("py", "toml", "csv"))


GROUPS = {
    "calibrations": Group("calibrations", (*_examples("calibrate_shift"), PLOT)),
    "car": Group("launches", (*_examples("car_launch", "hill_starts", "car"), PLOT)),
    "diagrams": Group("gearboxes", (DIAGRAMS, CATALOGUE)),
    "examples": Group(
        "examples",
        (
            *_examples(
                "cosimulation",
                "engine_clutch_vehicle",
                "launch",
                "tune_launch",
                "six_speed",
                "fit",
            ),
            PLOT,
        ),
    ),
    "fixed-steps": Group(
        "fixed_steps",
        (CATALOGUE, "src/clutchwork/elements/transmission.py"),
    ),
    "linear": Group("shuffle", (PLOT,), ("linearise",)),
    "pages": Group(
        "stand_ins",
        (
            "docs/figures/live.py",
            *_examples("six_speed", "calibrate_shift"),
            PLOT,
            DIAGRAMS,
        ),
    ),
    "plots": Group("drawings", (PLOT,), ("pictures",)),
    "rig": Group("experiments", ("src/clutchwork/rig/**/*.py", PLOT)),
    "schematics": Group(
        "schematics", (SCHEMATIC, *_examples("launch", "car_launch", "six_speed"))
    ),
    "shifts": Group(
        "shifts",
        (*_examples("eight_speed"), "src/clutchwork/shifts/**/*.py", CATALOGUE, PLOT),
    ),
    "stories": Group(
        "stories",
        (
            PLOT,
            SCHEMATIC,
            *_examples(
                "six_speed",
                "shift_controller",
                "tune_launch",
                "eight_speed",
                "valve_body",
            ),
        ),
        STORIES,
    ),
    "studies": Group(
        "studies", (*_examples("million_shifts"), "src/clutchwork/studies/picture.py")
    ),
    "sweeps": Group("sweeps", tuple(_examples("shift_sweep"))),
}


def programs(guide: str) -> list[str]:
    """The Python programs of a guide."""
    text = (ROOT / "docs" / "guide" / f"{guide}.md").read_text(encoding="utf-8")
    return re.findall(r"^```python\n(.*?)^```", text, re.DOTALL | re.MULTILINE)
