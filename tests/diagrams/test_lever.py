"""Lever diagrams: points by the teeth, so that speeds of every gear lie on a line; nothing touches or overlaps."""

from __future__ import annotations

from fractions import Fraction
from itertools import combinations
from typing import Any

import pytest
from hypothesis import given, settings

import clutchwork as cw
from clutchwork.diagrams.lever.layout import layout
from clutchwork.diagrams.lever.paint import painted
from clutchwork.diagrams.lever.points import levers
from clutchwork.gearbox.gear_set import HOUSING, GearSet
from clutchwork.gearbox.motion import speeds
from support import drawings
from support.amount import part
from support.drawn_gearboxes import BOXES, definitions

ALL = sorted(BOXES)


@pytest.mark.sampled
@pytest.mark.parametrize("name", ALL)
@pytest.mark.parametrize("merged", [False, True])
def test_box(name: str, merged: bool) -> None:
    box = BOXES[name]
    if merged and len(levers(box.sets, merged=True)) == len(box.sets):
        # no two of its sets share two members
        assert levers(box.sets, merged=True) == levers(box.sets, merged=False)
        return
    drawn = layout(box, merged=merged)
    plan = drawn.plan
    assert {member: drawings.parts(box, plan, member) for member in box.members} == dict.fromkeys(box.members, 1)
    assert drawings.faulty_crossings(plan) == []
    assert drawings.covered(plan) == []
    for now in (None, *box.states().values()):
        marks = painted(box, drawn, now)
        assert drawings.overlapping_labels(marks) == []
        assert drawings.struck_labels(marks) == []
        assert drawings.touching_members(box, marks) == []


@pytest.mark.parametrize("name", ALL)
@pytest.mark.parametrize("merged", [False, True])
def test_speeds_of_every_gear_lie_on_a_line(name: str, merged: bool) -> None:
    box = BOXES[name]
    for gear in box.gears:
        rows = speeds(box, box.closed_in(gear))
        for lever in levers(box.sets, merged=merged):
            for column in range(len(box.members)):
                shown = {m: rows[m].get(column, Fraction(0)) if m != HOUSING else Fraction(0) for m in lever.places}
                points = [(lever.places[member], speed) for member, speed in shown.items()]
                for (x1, y1), (x2, y2), (x3, y3) in combinations(points, 3):
                    assert (x2 - x1) * (y3 - y1) == (x3 - x1) * (y2 - y1)


def test_heights_are_the_places_of_the_lever() -> None:
    for name in ("zf-9hp48", "zf-6hp26", "every-kind"):
        box = BOXES[name]
        for lever, heights in layout(box, merged=False).hung:
            low, high = min(heights.values()), max(heights.values())
            for member, height in heights.items():
                # rounded to 1e-6 px
                assert (height - low) / (high - low) == pytest.approx(float(lever.places[member]), abs=1e-7)


def test_a_single_set_has_its_carrier_between_by_the_teeth() -> None:
    one = GearSet("P", "single", {"sun": "s", "ring": "r", "carrier": "c"}, {"sun": 30, "ring": 70}, {})
    (lever,) = levers([one], merged=False)
    # zs ws + zr wr = (zs + zr) wc
    assert lever.places == {"s": 0, "c": Fraction(70, 100), "r": 1}


def test_sets_that_share_two_members_are_one_lever() -> None:
    assert len(levers(BOXES["gm-4l60"].sets, merged=True)) == 1
    assert len(levers(BOXES["gm-4l60"].sets, merged=False)) == 2


@settings(max_examples=part(10))
@given(definitions())
def test_random_boxes(box: Any) -> None:
    drawn = layout(box, merged=False)
    marks = painted(box, drawn, None)
    assert all(drawings.parts(box, drawn.plan, member) <= 1 for member in box.members)
    assert drawings.faulty_crossings(drawn.plan) == []
    assert drawings.overlapping_labels(marks) == []
    assert drawings.struck_labels(marks) == []
    assert drawings.touching_members(box, marks) == []


LOCKED = {
    "name": "locked in itself",
    "input": "X",
    "output": "C",
    "sets": {
        "P": {"type": "single", "sun": "X", "ring": "X", "carrier": "out", "teeth_sun": 30, "teeth_ring": 70},
        "Q": {"type": "single", "sun": "out", "ring": "R", "carrier": "C", "teeth_sun": 30, "teeth_ring": 70},
    },
    "elements": {"B": ["R", "housing"]},
    "gears": {"1": ["B"]},
}


@pytest.mark.parametrize("kind", ["stick", "lever", "speeds", "chart"])
def test_a_set_whose_sun_and_ring_are_one_member(kind: str) -> None:
    """It turns as one piece and has no lever; the others are drawn."""
    text = cw.diagram(cw.Gearbox.from_dict(LOCKED), kind, gear="1").svg
    # the chart shows members alone
    assert ("Q" in text) == (kind != "chart")


def test_a_gearbox_without_any_lever() -> None:
    alone = {**LOCKED, "output": "out", "sets": {"P": LOCKED["sets"]["P"]}, "elements": {}, "gears": {"1": []}}
    with pytest.raises(cw.UseError, match="no lever"):
        cw.diagram(cw.Gearbox.from_dict(alone), "lever")
