"""Speed plans and charts: the line of each gear goes through the exact speed of every member; nothing overlaps."""

from __future__ import annotations

from itertools import pairwise
from xml.etree import ElementTree

import pytest
from hypothesis import given
from hypothesis import strategies as st

import clutchwork as cw
from clutchwork.diagrams.marks import Label, Polyline
from clutchwork.diagrams.picture import svg_text
from clutchwork.diagrams.speed import chart, plan
from clutchwork.diagrams.speed.plan import spread
from clutchwork.gearbox.gear_set import HOUSING
from support import drawings
from support.drawn_gearboxes import BOXES

# both show gears, which a power split may not have
ALL = sorted(name for name, box in BOXES.items() if box.states())


@pytest.mark.parametrize("name", ALL)
def test_lines_of_gears_go_through_the_speeds(name: str) -> None:
    box, states = BOXES[name], list(BOXES[name].states().values())
    marks = plan.painted(box, states, None)
    uprights = {
        (mark.points[0][0], mark.what)
        for mark in marks
        if isinstance(mark, Polyline) and mark.what in [*box.members, HOUSING]
    }
    ladders = plan.ladders(box, 0.0)
    _, _, scale = plan.span(ladders, states)
    assert len(uprights) == sum(len(one.columns) for one in ladders)
    for state in states:
        lines = [mark for mark in marks if isinstance(mark, Polyline) and mark.what == f"gear {state.gear}"]
        assert len(lines) == len(ladders)
        for line in lines:
            (x1, y1), (x2, y2) = line.points
            for x, member in uprights:
                if x1 <= x <= x2:
                    height = y1 + (y2 - y1) * (x - x1) / (x2 - x1)
                    # px; speeds are exact fractions as floats
                    assert height == pytest.approx(-scale * state.speeds.get(member, 0.0), abs=1e-6)


@pytest.mark.parametrize("name", ALL)
@pytest.mark.parametrize("kind", [plan, chart])
def test_nothing_overlaps(name: str, kind: object) -> None:
    box, states = BOXES[name], list(BOXES[name].states().values())
    for now in (None, states[0]):
        marks = kind.painted(box, states, now)  # type: ignore[attr-defined]
        assert drawings.overlapping_labels(marks) == []
        if kind is chart:
            assert drawings.struck_labels(marks) == []
        texts = [mark.text for mark in marks if isinstance(mark, Label)]
        assert set(box.members) <= set(texts) | (set(box.shafts) if kind is plan else set()) | _beside(box)
        assert ElementTree.fromstring(svg_text(name, marks)).tag.endswith("svg")


def _beside(box: object) -> set[str]:
    """Members without a gear stand in no ladder."""
    return set(box.members) - {m for one in box.sets for m in one.members.values()}  # type: ignore[attr-defined]


@given(st.lists(st.floats(-100, 100), min_size=1, max_size=20))
def test_labels_are_apart_and_as_near_as_may_be(wanted: list[float]) -> None:
    found = spread(wanted, 5.0)
    order = sorted(range(len(wanted)), key=lambda n: (wanted[n], n))
    assert all(found[b] - found[a] >= 5.0 - 1e-9 for a, b in pairwise(order))
    # the mean of what had to move is kept, so all together it is
    assert sum(found) == pytest.approx(sum(wanted), abs=1e-6)


def test_a_box_without_gears_and_closed_elements_without_a_name() -> None:
    """A power split has its ladder; a chart wants something closed; what is no row of the table is drawn beside it."""
    split = cw.Gearbox.from_dict(
        {
            "name": "split",
            "input": "engine",
            "output": "ring",
            "gears": {},
            "sets": {
                "P": {
                    "type": "single",
                    "sun": "MG1",
                    "ring": "ring",
                    "carrier": "engine",
                    "teeth_sun": 30,
                    "teeth_ring": 78,
                }
            },
        }
    )
    assert "MG1" in cw.diagram(split, "speeds").svg
    with pytest.raises(cw.UseError, match="split has no gears to chart"):
        cw.diagram(split, "chart")
    data = cw.Gearbox.load("zf-8hp70").to_dict()
    data["gears"] = {gear: row for gear, row in data["gears"].items() if gear != "3"}
    data["published"] = {gear: ratio for gear, ratio in data["published"].items() if gear != "3"}
    box = cw.Gearbox.from_dict(data)
    for kind in ("speeds", "chart"):
        assert ">B+C+E<" in cw.diagram(box, kind, gear=("B", "C", "E")).svg
