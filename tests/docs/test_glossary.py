"""docs/glossary.md: a class name stands in one room, or in its table with the reason why it stands in several."""

from __future__ import annotations

import ast
import re
from collections import defaultdict

from support.project import ROOT

SRC = ROOT / "src" / "clutchwork"
PAGE = (ROOT / "docs" / "glossary.md").read_text(encoding="utf-8")
ROW = re.compile(r"^\| `(\w+)` \| (`\w+`(?:, `\w+`)*) \| (.*\w.*) \|$", re.MULTILINE)


def rooms_by_class() -> dict[str, set[str]]:
    """Class name -> folders of src/clutchwork that define it, private ones and those inside of functions too."""
    found = defaultdict[str, set[str]](set)
    for path in sorted(SRC.rglob("*.py")):
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.ClassDef):
                found[node.name].add(path.relative_to(SRC).parts[0])
    return dict(found)


def excepted() -> dict[str, set[str]]:
    """Names in the table of the page, with their rooms."""
    table = PAGE.partition("## Class names in several rooms")[2]
    return {name: set(re.findall(r"`(\w+)`", rooms)) for name, rooms, _ in ROW.findall(table)}


def test_a_class_name_stands_in_one_room_or_has_a_reason() -> None:
    assert {name: rooms for name, rooms in rooms_by_class().items() if len(rooms) > 1} == excepted()


def test_the_search_sees_classes_of_all_rooms() -> None:
    known = rooms_by_class()
    assert known["CalibrationProblem"] == {"calibration"}
    assert known["Problem"] == {"base"}
    assert len(set().union(*known.values())) > 20


def test_a_term_has_a_meaning_and_an_existing_page() -> None:
    terms = re.findall(r"^\| ([^`|]+) \| ([^|]+) \| \[[^]]+\]\(([^)]+)\) \|$", PAGE, re.MULTILINE)
    assert {"contact", "guard", "knot", "word"} <= {term for term, _, _ in terms}
    assert [path for _, _, path in terms if not (ROOT / "docs" / path).is_file()] == []
