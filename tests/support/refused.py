"""Edits of a copied project, and who must refuse them with which words."""

from __future__ import annotations

from pathlib import Path

from support import project

ELEMENTS, LAWS = "src/clutchwork/elements", "src/clutchwork/laws"
HEADERS = "cpp/include/clutchwork"


def edit(path: Path, old: str, new: str) -> None:
    """Replace a text that must be there, once."""
    text = path.read_text()
    assert old in text, f"{path} has changed: the test has to follow"
    path.write_text(text.replace(old, new, 1))


def refused_by_generator(copy: Path, *words: str) -> None:
    result = project.generate(copy)
    assert result.returncode != 0
    for word in words:
        assert word in result.stderr


def refused_by_compiler(copy: Path, *words: str) -> None:
    result = project.generate(copy)
    assert result.returncode == 0, result.stderr
    result = project.compile_registry(copy)
    assert result.returncode != 0
    for word in words:
        assert word in result.stderr
