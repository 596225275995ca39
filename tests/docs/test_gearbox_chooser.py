"""The documentation has the live page of every gearbox of the catalogue, and a list that chooses one."""

from __future__ import annotations

import re
import sys
from html import unescape
from pathlib import Path

import clutchwork as cw
from support.project import ROOT

sys.path.append(str(ROOT / "tools"))
sys.path.append(str(ROOT / "docs" / "figures"))

import live

import gearbox_page


def test_every_gearbox_can_be_chosen_by_its_name() -> None:
    options = re.findall(r'<option value="([^"]*)"( selected)?>([^<]*)</option>', gearbox_page.chooser())
    boxes = {f"../live/{name}.html": box.title for name, box in cw.catalogue().items()}
    assert {value: unescape(title) for value, _, title in options} == boxes
    assert [value for value, selected, _ in options if selected] == [gearbox_page.LIVE.format(gearbox_page.FIRST)]
    # by their titles, as readers look for them
    titles = [title.lower() for _, _, title in options]
    assert titles == sorted(titles)


def test_the_chooser_has_a_label_and_asks_for_nothing_else() -> None:
    made = gearbox_page.chooser()
    assert '<label for="gearbox">' in made
    assert '<select id="gearbox">' in made
    assert not re.search(r"https?:|//", re.sub(r"^\s*//.*$", "", made, flags=re.MULTILINE))
    assert "](../../tools/gearbox_page.py)" in (ROOT / "docs/guide/gearboxes.md").read_text(encoding="utf-8")


def test_the_pages_are_those_of_the_catalogue() -> None:
    assert set(cw.catalogue()) <= set(live._names())
    page = gearbox_page.page()
    assert all(f'href="../live/{name}.html"' in page for name in cw.catalogue())


def test_what_is_not_built_says_so(tmp_path: Path, monkeypatch) -> None:
    monkeypatch.setattr(live, "missing", lambda: ["core.wasm"])
    made = live.write(tmp_path)
    assert {path.read_text() for path in made} == {live.NOT_BUILT}
    assert {path.stem for path in made} == set(live._names())
