"""The codes of the core are written from the layout that Python reads."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from clutchwork.declare.layout import CAUSES, METHODS, MODES, STATISTICS, STATUS
from support import project
from support.refused import HEADERS


def words_of(text: str, enum: str) -> dict[str, int]:
    """The enumerators of a generated enum."""
    inside = re.search(rf"enum (?:class )?{enum} : int {{ (.*) }};", text)
    assert inside, enum
    return {name: int(number) for name, number in re.findall(r"(\w+) = (-?\d+)", inside[1])}


def test_the_codes_of_the_core_are_those_of_the_layout(tmp_path: Path) -> None:
    project.generate(project.ROOT, tmp_path)
    text = (tmp_path / "layout.gen.hpp").read_text()
    assert words_of(text, "Status") == {name: number for number, (name, *_) in enumerate(STATUS)}
    assert words_of(text, "Mode") == {name: number for number, name in MODES.items()}
    causes = {word.replace(" ", "_"): number for number, (word, _) in CAUSES.items()}
    assert words_of(text, "Cause") == {"initial": 0, **causes}
    assert words_of(text, "Method") == {name.replace("auto", "auto_"): number for name, number in METHODS.items()}
    assert re.findall(r"std::int64_t (\w+) = 0;  ///<", text) == [name for name, _ in STATISTICS]


@pytest.mark.parametrize(
    ("enum", "names"),
    [
        ("Cause", [word.replace(" ", "_") for word, _ in CAUSES.values()]),
        ("Status", [name for name, *_ in STATUS]),
    ],
)
def test_the_core_has_a_use_for_every_code(enum: str, names: list[str]) -> None:
    text = "".join(path.read_text() for path in (project.ROOT / "cpp").rglob("*.hpp"))
    text += "".join(path.read_text() for path in (project.ROOT / "cpp").rglob("*.cpp"))
    assert [name for name in names if f"{enum}::{name}" not in text] == []


def test_the_c_interface_lists_the_counters_and_methods() -> None:
    text = (project.ROOT / HEADERS / "c_api.h").read_text()
    assert f"Counters: {', '.join(name for name, _ in STATISTICS)}." in text
    assert f"cw_statistics(const cw_run* run, int64_t counts[{len(STATISTICS)}])" in text
