"""Messages, help and pages are in the English of the field: phrases that only a translation uses stay out."""

from __future__ import annotations

import ast
import re
from collections.abc import Iterator
from pathlib import Path

import pytest

from support.project import ROOT

# what it should be
BANNED = {
    r"\bstands? twice\b": "appears twice",
    r"(?<!there )\b(?:is|are|was|were) no (?!longer\b|more\b|less\b)": "is not a",
    r"\b(?:a|no|as) text\b": "string",
    r"\b(?:tells?|told)\b(?! (?:\w+ ){0,2}apart)": "reports, shows",
    r"\bmend(?:s|ed)?\b": "fix",
    r"\bfor ever\b": "indefinitely, permanently",
    r"\bhand(?:s|ed)? (?:\w+ )?(?:back|on)\b": "returns, exports",
    r"\ba way of slip\b": "slip distance",
    r"\bas ever\b": "as usual",
    r"\bwithout unit\b": "has no unit",
    r"\bof unusual size\b": "of unusual magnitude",
    r"\bhas not\b(?! [a-z]+(?:ed|n)\b)": "does not have",
    r"\bwhatever the\b.{0,30}\bsays\b": "regardless of",
    r"(?<!anything )(?<!nothing )(?<!all )\bbut for\b(?! an? )": "except for, up to",
    r"\ball the same\b(?! (?:size|length|kind|value)s?\b)": "nevertheless",
    r"\b(?:for good|once and for all)\b": "permanently",
    r"\bturn(?:s|ed|ing)? round\b": "reverses",
    r"\bthe other way round\b": "vice versa",
    r"\bmakes of (?:it|them|the|a)\b": "the result, the effect of",
    r"\bnothing burns\b": "there is no combustion",
    r"\bswing(?:s|ing)?\b (?:with|twice|about|slowly|faster)": "oscillates",
}
FOLDERS = ("", "docs", "docs/elements", "docs/guide", "docs/theory", "decisions", "examples/*")
PAGES = [path for folder in FOLDERS for path in sorted(ROOT.glob(f"{folder}/*.md" if folder else "*.md"))]
PAGES = [path for path in PAGES if path.name != "CHANGELOG.md"]
PROGRAMS = sorted([*(ROOT / "src").rglob("*.py"), *(ROOT / "tools").glob("*.py")])
OTHERS = [ROOT / "Makefile", ROOT / "tools" / "prerequisites.sh", *(ROOT / "cpp" / "include").rglob("c_api.h")]


def strings(path: Path) -> Iterator[str]:
    """All strings of a program, docstrings among them; names in braces are left out."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.Constant) and isinstance(node.value, str):
            yield node.value


def faults(text: str) -> list[str]:
    """Phrases of a text that should be others."""
    flat = " ".join(re.sub(r"```.*?```", "", text, flags=re.DOTALL).split())
    found = ((match, better) for phrase, better in BANNED.items() for match in re.finditer(phrase, flat, re.IGNORECASE))
    return [f"...{flat[max(0, m.start() - 30) : m.end() + 20]}...: {better}" for m, better in found]


@pytest.mark.parametrize("path", PAGES + OTHERS, ids=lambda path: str(path.relative_to(ROOT)))
def test_words_of_pages(path: Path) -> None:
    assert faults(path.read_text(encoding="utf-8")) == []


def test_words_of_messages() -> None:
    found = [
        f"{path.relative_to(ROOT)}: {fault}" for path in PROGRAMS for text in strings(path) for fault in faults(text)
    ]
    assert found == []


def test_phrases_are_found() -> None:
    """The list itself works: each phrase is found, and what it should be is not."""
    for wrong in ("x stands twice", "c1 is no signal", "it is a text", "the table tells", "mend it", "has not x"):
        assert faults(wrong), wrong
    for right in ("it is no longer so", "it has not ended", "appears twice", "is not a signal", "a string"):
        assert not faults(right), right
