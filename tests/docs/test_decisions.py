"""Every decision has its number in its title and its line in the list."""

from __future__ import annotations

import re

from support.project import ROOT

PAGES = sorted((ROOT / "decisions").glob("0*.md"))


def test_titles_begin_with_their_numbers() -> None:
    assert [page.name for page in PAGES if not page.read_text(encoding="utf-8").startswith(f"# {page.name[:4]} ")] == []


def test_the_list_has_all_of_them_in_order() -> None:
    listed = (ROOT / "decisions" / "README.md").read_text(encoding="utf-8")
    assert re.findall(r"^\| \[(\d+)\]\(\1-", listed, re.MULTILINE) == [page.name[:4] for page in PAGES]
    # numbers that are left out are said to be
    given = {int(page.name[:4]) for page in PAGES}
    missing = [f"{number:04}" for number in range(1, max(given)) if number not in given]
    assert [number for number in missing if f"The number {number} was never given" not in listed] == []
