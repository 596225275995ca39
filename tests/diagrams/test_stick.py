"""Stick diagrams of every box in every gear: members are joined and do not touch others, nothing overlaps."""

from __future__ import annotations

from typing import Any
from xml.etree import ElementTree

import pytest
from hypothesis import given, settings

from clutchwork.diagrams.marks import Label, Polyline
from clutchwork.diagrams.picture import svg_text
from clutchwork.diagrams.power import sources
from clutchwork.diagrams.shown import of_gear
from clutchwork.diagrams.stick.layout import _best, layout
from clutchwork.diagrams.stick.lines import needed
from clutchwork.diagrams.stick.looks import Scene
from clutchwork.diagrams.stick.paint import painted
from support import drawings
from support.amount import part
from support.drawn_gearboxes import BOXES, definitions

ALL = sorted(BOXES)


def unkept(box: Any) -> Any:
    """The layout, sought anew."""
    _best.cache_clear()
    return layout(box)


@pytest.mark.sampled
@pytest.mark.parametrize("name", ALL)
def test_box(name: str) -> None:
    box, plan = BOXES[name], layout(BOXES[name])
    assert {member: drawings.parts(box, plan, member) for member in box.members} == dict.fromkeys(box.members, 1)
    assert drawings.faulty_crossings(plan) == []
    assert drawings.covered(plan) == []
    wanted = [*(one.name for one in box.sets), *(one.name for one in box.elements), "input", "output"]
    # sets that share planets share a wheel
    teeth = {(one.name, name): str(number) for one in box.sets for name, number in one.teeth.items()}
    wanted += [teeth[bar.source] for body in plan.bodies for bar in body.bars if bar.source in teeth]
    wanted += [teeth[one.teeth] for body in plan.bodies for one in body.planets if one.teeth in teeth]
    assert {source for body in plan.bodies for source in body.pieces} == {
        (s.name, port) for s in box.sets for port in s.members
    }
    for now in (None, *box.states().values()):
        marks = painted(box, plan, now)
        assert drawings.overlapping_labels(marks) == []
        assert drawings.struck_labels(marks) == []
        assert drawings.touching_members(box, marks) == []
        # sets that share planets have one label
        texts = [text for mark in marks if isinstance(mark, Label) for text in mark.text.split(" + ")]
        assert [text for text in wanted if texts.count(text) < wanted.count(text)] == []
        assert min(mark.size for mark in marks if isinstance(mark, Label)) >= 9.0
        assert {mark.what for mark in marks if isinstance(mark, Polyline)} >= set(box.members)
        assert ElementTree.fromstring(svg_text(name, marks)).tag.endswith("svg")


def test_the_same_box_has_the_same_bytes() -> None:
    box = BOXES["ford-10r80"]
    texts = {svg_text("", painted(box, find(box), box.state("3"))) for find in (layout, unkept) for _ in (1, 2)}
    assert len(texts) == 1


@pytest.mark.parametrize("name", ALL)
def test_power_of_each_member_adds_up_to_nothing(name: str) -> None:
    """What the widths of lines are made of: a line carries what one side of it takes up."""
    for state in BOXES[name].states().values():
        if any(torque != torque for torque in state.torques.values()):
            continue
        for member, power in sources(BOXES[name], of_gear(state)).items():
            # sums of a few terms of order 1 to 10
            assert abs(sum(power.values())) < 1e-9, member


@settings(max_examples=part(10))
@given(definitions())
def test_random_boxes(box: Any) -> None:
    plan = layout(box)
    marks = painted(box, plan, None)
    assert all(drawings.parts(box, plan, member) <= 1 for member in box.members)
    assert drawings.faulty_crossings(plan) == []
    assert drawings.covered(plan) == []
    assert drawings.overlapping_labels(marks) == []
    assert drawings.struck_labels(marks) == []
    assert drawings.touching_members(box, marks) == []


def test_lines_that_lead_nowhere_are_not_drawn() -> None:
    box, plan = BOXES["eight-speed"], layout(BOXES["eight-speed"])
    roots = {piece.root for body in plan.bodies for piece in body.pieces.values()}
    for member in box.members:
        edges = needed(Scene(box, plan, None), member)
        ends = {node for edge in edges for node in edge if sum(node in other for other in edges) == 1}
        assert ends <= roots | set(plan.ends)
