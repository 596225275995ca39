"""Diagrams are laid out once for all gears, and what shortens the search leaves every picture as it is."""

from __future__ import annotations

from typing import Any

import pytest

import clutchwork as cw
from clutchwork.diagrams.lever import layout as lever
from clutchwork.diagrams.stick import layout as stick
from clutchwork.diagrams.stick import search
from clutchwork.diagrams.stick.board import Board

BOXES = ("ford-aode", "ford-model-t", "zf-6hp26")


def pictures(name: str) -> list[str]:
    """Both diagrams of a gearbox, laid out anew."""
    stick._best.cache_clear()
    lever._laid.cache_clear()
    return [cw.diagram(name, kind).svg for kind in ("stick", "lever")]


@pytest.mark.parametrize("name", BOXES)
def test_bounds_change_no_picture(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    bounded = pictures(name)
    monkeypatch.setattr(search, "_least", lambda board, task: {})
    assert pictures(name) == bounded


@pytest.mark.parametrize("kind", ["stick", "lever"])
def test_all_gears_have_one_layout(kind: str, monkeypatch: pytest.MonkeyPatch) -> None:
    box, count = cw.Gearbox.load("ford-aode"), 0
    find = search.find

    def counted(*given: Any) -> Any:
        nonlocal count
        count += 1
        return find(*given)

    monkeypatch.setattr("clutchwork.diagrams.stick.route.find", counted)
    pictures("ford-aode")
    count = 0
    made = {cw.diagram(box, kind, gear=gear).svg for gear in box.gears}
    assert len(made) == len(box.gears)
    assert count == 0


def test_levers_with_other_teeth_are_laid_out_anew() -> None:
    content = cw.Gearbox.load("ford-aode").to_dict() | {"published": {}}
    other = content | {"sets": {"RV": content["sets"]["RV"] | {"teeth_small_sun": 24}}}
    one, two = cw.Gearbox.from_dict(content), cw.Gearbox.from_dict(other)
    assert cw.diagram(one, "lever").svg != cw.diagram(two, "lever").svg


def test_what_is_left_to_pay_is_the_way_around_what_is_solid() -> None:
    board = Board(7, 5)
    board.block([(3, 1), (3, 2), (3, 3)])
    task = search.Query(("a", "a"), [(1, 1)], [(5, 1)], limit=20.0)
    least = search._least(board, task)
    assert least[5, 1] == 0.0
    # over the wall of three
    assert least[1, 1] == 4.0 + 2.0 * 3.0
    found = search.find(board, task)
    assert found is not None
    assert len(found.before) - 1 == least[1, 1]
    # two bends before the wall and two behind it are 12 more
    assert search.find(board, search.Query(("a", "a"), [(1, 1)], [(5, 1)], limit=15.0)) is None
