"""Pictures of the pages are committed: all that are shown, small, described, and drawn from what is there now."""

from __future__ import annotations

import re
import sys
from pathlib import Path

import pytest

from support.project import ROOT

sys.path.append(str(ROOT / "docs" / "figures"))

import committed
import groups
import included

LIMIT = 6_000_000  # bytes of all pictures
PAGES = committed.pages()


def test_no_picture_is_missing_or_stale() -> None:
    assert not (found := [words for _, words in committed.faults()]), "make pictures: " + "; ".join(found)


def test_every_committed_picture_is_shown() -> None:
    assert committed.unused() == []
    assert set(committed.record()) == set(groups.GROUPS) == set(committed.shown())
    assert all(committed.shown().values())


def test_pictures_are_small_and_run_nothing() -> None:
    files = [path for path in committed.FOLDER.rglob("*") if path.is_file()]
    assert sum(path.stat().st_size for path in files) < LIMIT
    drawings = [path.read_text(encoding="utf-8") for path in files if path.suffix == ".svg"]
    assert [text[:80] for text in drawings if re.search(r"<script|\bon\w+=|javascript:|href=.https?:", text)] == []


@pytest.mark.parametrize("path", PAGES, ids=lambda path: path.name)
def test_a_page_shows_pictures_that_are_there_and_says_what_is_seen(path: Path) -> None:
    for words, link in re.findall(r"!\[([^\]]*)\]\(([^)]*)\)", path.read_text(encoding="utf-8")):
        assert (path.parent / link).is_file(), link
        # more than a title
        assert len(words.split()) >= 5, f"{link}: {words}"


@pytest.mark.parametrize("name", groups.GROUPS)
def test_a_group_is_made_from_files_that_are_there(name: str) -> None:
    group = groups.GROUPS[name]
    for pattern in group.files:
        # examples need not have files of every kind
        assert list(ROOT.glob(pattern)) or pattern.startswith("examples/"), pattern
    assert ROOT / "docs" / "figures" / f"{group.module}.py" in group.made_from()


def test_a_change_of_what_a_picture_is_made_from_is_seen(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(groups, "ROOT", tmp_path)
    source = tmp_path / "docs" / "figures" / "one.py"
    source.parent.mkdir(parents=True)
    source.write_text("# a word\nx = 1\n")
    group = groups.Group("one", ("*.toml",))
    first = group.fingerprint()
    source.write_text("# another word\n\nx = 1\n")
    assert group.fingerprint() == first
    source.write_text("x = 2\n")
    second = group.fingerprint()
    (tmp_path / "model.toml").write_text("a = 1\n")
    assert len({first, second, group.fingerprint()}) == 3


def test_what_is_wrong_with_a_picture_is_said(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(committed, "FOLDER", tmp_path)
    monkeypatch.setattr(committed, "RECORD", tmp_path / "made_from.json")
    monkeypatch.setattr(committed, "shown", lambda: {"rig": ["rig/a.png"]})
    assert [words for _, words in committed.faults()] == ["docs/pictures/rig/a.png is missing"]
    (tmp_path / "rig").mkdir()
    (tmp_path / "rig" / "a.png").write_bytes(b"1")
    assert "not as it was drawn" in next(committed.faults())[1]
    known = {"rig": committed.now("rig", ["rig/a.png"])}
    monkeypatch.setattr(committed, "record", lambda: known)
    assert list(committed.faults()) == []
    known["rig"]["made from"] = "something else"
    assert "is stale" in next(committed.faults())[1]


@pytest.mark.parametrize("path", PAGES, ids=lambda path: path.name)
def test_texts_that_a_page_includes_are_as_they_are_there(path: Path) -> None:
    assert included.updated(path) == path.read_text(encoding="utf-8"), "make pictures"


def test_the_source_of_a_class_is_included(tmp_path: Path) -> None:
    (tmp_path / "a.py").write_text("import os\n\n\n@made\nclass A:\n    x = 1\n\n\ny = 2\n")
    page = tmp_path / "page.md"
    page.write_text("<!-- from a.py: A -->\n```py\nold\n```\n\nand\n\n```py\nas it is\n```\n")
    included.update(page)
    assert (
        page.read_text()
        == "<!-- from a.py: A -->\n```py\n@made\nclass A:\n    x = 1\n```\n\nand\n\n```py\nas it is\n```\n"
    )
