"""What the front page claims is what other pages have, and it reads on a forge without a build."""

from __future__ import annotations

import importlib
import re
import sys
import tomllib

import pytest
import yaml
from PIL import Image

import clutchwork as cw
from support import cases
from support.pages import page, plain, table
from support.project import ROOT

sys.path.append(str(ROOT / "tools"))

README = (ROOT / "README.md").read_text(encoding="utf-8")
VALIDATION = page("validation.md")
PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"]
CORE = "clutchwork, any model"


def measured() -> dict[str, str]:
    """Lines of the table of benchmarks."""
    return {row[0]: row[1] for row in table(page("benchmarks.md"), "what")}


@pytest.mark.parametrize(("program", "time", "error"), table(README, "program"))
def test_times_and_errors_are_those_of_the_benchmarks(program: str, time: str, error: str) -> None:
    rows = measured()
    if program == CORE:
        assert rows["shift: Rodas5P, core alone"].startswith(f"{time}, ")
        assert rows["shift: largest speed error at rtol 1e-6"] == error
    else:
        assert rows[f"shift: {program}"].startswith(f"{time}, {error} = ")


def test_the_proofs_are_those_of_the_page_of_validation() -> None:
    proofs = plain(README.partition("## Proof")[2])
    folders = [path for path in (cases.OWN / "msl").iterdir() if path.is_dir()]
    assert f"- {len(folders)} cases of the Modelica Standard Library: each signal to 1e-5 of its full scale" in proofs
    for words in ("events to 1e-6 s, signals to 1e-5 of full scale", "lock and break-away times to 1e-9 s"):
        assert words in proofs
        assert words in VALIDATION
    assert "max(1e-5, 1.5 x the error of the reference)" in VALIDATION


def test_it_begins_with_a_sentence_a_picture_and_a_program() -> None:
    kinds = re.findall(r"^(!\[|```python|## Install|## Where next|## Proof)", README, re.MULTILINE)
    assert kinds == ["![", "```python", "## Install", "## Where next", "## Proof"]
    # markup of a site would be shown as it stands
    assert not re.search(r"^(:::|```\{)|<(?!!--)[a-z]", README, re.MULTILINE)


def test_pictures_are_small_and_have_words() -> None:
    pictures = re.findall(r"!\[(.*?)\]\((.*?)\)", README)
    assert pictures
    assert all(len(words) > 40 for words, _ in pictures)
    assert sum((ROOT / path).stat().st_size for _, path in pictures) < 600_000


def test_the_first_picture_is_the_way_of_a_hand_there_and_back() -> None:
    front_picture = importlib.import_module("front_picture")
    way = front_picture.way()
    assert way[0] == (0.0, 0.0)
    assert way[-1] == pytest.approx((0.0, 0.0), abs=1e-9)
    assert (min(y for _, y in way), max(y for _, y in way)) == (-front_picture.UP, front_picture.DOWN)
    with Image.open(ROOT / "docs" / "_static" / "drag.gif") as drawn:
        assert (drawn.n_frames, drawn.info["loop"]) == (len(way), 0)
    assert "front_picture.py docs/_static/drag.gif" in (ROOT / "Makefile").read_text(encoding="utf-8")


def test_guides_are_reached_from_it() -> None:
    guides = {f"docs/guide/{path.name}" for path in (ROOT / "docs" / "guide").glob("*.md")}
    assert guides - set(re.findall(r"\]\((docs/guide/[^)#]+)\)", README)) == set()


def test_pages_name_extras_that_are_there_and_one_for_pictures() -> None:
    known = set(PROJECT["optional-dependencies"]) - {"plot"}
    for path in (ROOT / "README.md", *(ROOT / "docs").glob("*.md"), *(ROOT / "docs" / "guide").glob("*.md")):
        named = re.findall(r"pip install[^`\n]*\[([a-z,]+)\]", path.read_text(encoding="utf-8"))
        assert {extra for names in named for extra in names.split(",")} <= known, path.name


def test_how_to_cite_it() -> None:
    cited = yaml.safe_load((ROOT / "CITATION.cff").read_text(encoding="utf-8"))
    assert cited["license"] == PROJECT["license"]
    assert {"cff-version", "message", "title", "authors"} <= set(cited)
    # the version stands in the package alone
    assert "version" not in cited
    assert "CITATION.cff" in README


def test_it_counts_the_gearboxes_of_the_catalogue() -> None:
    assert f"{len(cw.catalogue())} of them in the catalogue" in README
