"""Every element has a page: an example that runs and reports it, its picture, what it reads, what its gain is."""

from __future__ import annotations

import re
import sys
from pathlib import Path
from typing import Any

import pytest

from clutchwork.declare.schema import specs
from support import samples

ROOT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT / "tools"))
pytest.importorskip("matplotlib").use("agg")

import element_figures  # noqa: E402
import element_pages  # noqa: E402
import element_programs  # noqa: E402

ELEMENTS = samples.declared(*samples.ELEMENT_ROLES)


def _name(cls: Any) -> str:
    return cls.__name__


@pytest.fixture(scope="module")
def pages() -> dict[str, str]:
    """Text of all pages by name; their pictures are those of `make docs` where nothing has changed."""
    return dict(element_pages.pages())


@pytest.mark.parametrize("cls", ELEMENTS, ids=_name)
def test_the_example_of_a_page_runs(cls: Any) -> None:
    made = element_programs.performed(element_programs.program(cls), cls.__name__)
    assert made["run"].status == "done"
    assert cls in {type(element) for element in made["d"].elements}


@pytest.mark.parametrize("cls", ELEMENTS, ids=_name)
def test_an_element_without_words_of_its_own_has_an_example_that_runs(cls: Any) -> None:
    made = element_programs.performed(element_programs.made(cls), cls.__name__)
    assert made["run"].status == "done"
    assert cls in {type(element) for element in made["d"].elements}


@pytest.mark.parametrize("cls", ELEMENTS, ids=_name)
def test_a_page_shows_example_picture_fields_and_results(cls: Any, pages: dict[str, str]) -> None:
    text = pages[f"elements/{cls.kind}"]
    assert f"py:class:: {cls.__name__}(" in text
    assert f"cw.{cls.__name__}(" in text
    assert f"{{figure}} {cls.kind}.svg" in text
    assert [item.name for item, _ in specs(cls) if f"| `{item.name}` |" not in text] == []
    rows = re.search(r"## Results\n.*?\n\|---\|---\|---\|\n(.*?)\n\n", text + "\n\n", re.DOTALL)
    assert rows
    # every signal has a meaning
    assert [row for row in rows[1].splitlines() if row.endswith("|  |")] == []
    assert f"(elements/{cls.kind}.md)" in pages["elements"]


@pytest.mark.parametrize("cls", ELEMENTS, ids=_name)
def test_what_has_a_gain_says_how_it_follows_from_the_geometry(cls: Any, pages: dict[str, str]) -> None:
    has_gain = isinstance(vars(cls).get("gain"), property) or any(
        item.name == "gain" and spec.unit == "m3" for item, spec in specs(cls)
    )
    section = re.search(r"^## Gain\n(.*?)^## ", pages[f"elements/{cls.kind}"], re.DOTALL | re.MULTILINE)
    if has_gain:
        assert section
        assert r"\text{gain} =" in section[1]


@pytest.mark.parametrize("kind", ["disk_clutch", "clutch", "brake", "cone_clutch", "band_brake", "synchroniser"])
def test_linings_have_typical_coefficients_with_their_source(kind: str, pages: dict[str, str]) -> None:
    text = pages[f"elements/{kind}"]
    assert "## Typical coefficients" in text
    assert "Source: " in text.partition("## Typical coefficients")[2]


def test_words_are_those_of_an_element() -> None:
    known = {cls.kind for cls in ELEMENTS}
    written = {path.stem for path in element_programs.WORDS.glob("*.md") if not path.stem.startswith("_")}
    assert written <= known


def test_a_picture_is_drawn_again_only_when_its_program_changes(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(element_figures, "KEPT", tmp_path)
    (cls,) = [cls for cls in ELEMENTS if cls.kind == "damper"]
    source = element_programs.program(cls)
    first = element_figures.example(cls, source).picture
    drawn = first.stat().st_mtime_ns
    assert element_figures.example(cls, source).picture.stat().st_mtime_ns == drawn
    other = element_figures.example(cls, source.replace("0.3", "0.4")).picture
    assert other != first
    assert sorted(tmp_path.glob("*.svg")) == [other]
    # the machine is nobody's business
    assert str(Path.home()) not in other.read_text()
    assert str(ROOT) not in other.read_text()


DOCS = ROOT / "docs"
# what is made by the build is not looked at, nor the files of the package in extend.md, which have its width
MADE = {DOCS / "extend.md", *(DOCS / "reference").rglob("*.md")}
PAGES = [ROOT / "README.md", *sorted({*DOCS.rglob("*.md")} - MADE)]


@pytest.mark.parametrize("path", PAGES, ids=lambda path: str(path.relative_to(ROOT)))
def test_no_line_of_code_is_wider_than_a_page_shows(path: Path) -> None:
    found = re.findall(
        r"^```(?:python|toml|cpp|c|sh)\n(.*?)^```", path.read_text(encoding="utf-8"), re.DOTALL | re.MULTILINE
    )
    assert [line for block in found for line in block.splitlines() if len(line) > 88] == []
