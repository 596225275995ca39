"""Parallel axes: what stands where, and that it can be read."""

from __future__ import annotations

from xml.etree import ElementTree

import pytest

import clutchwork as cw
from clutchwork.diagrams.axes.layout import axes, fits
from clutchwork.diagrams.axes.paint import painted
from clutchwork.diagrams.marks import Label, Polyline
from support import drawings
from support.catalogue import DUAL


@pytest.mark.parametrize("name", DUAL)
def test_box(name: str) -> None:
    box = cw.Gearbox.load(name)
    plan = axes(box)
    # each pair has a column of its own, and its wheels stand on different axes
    assert len(set(plan.columns.values())) == len(box.sets)
    for one in box.sets:
        assert abs(plan.heights[one.members["first"]] - plan.heights[one.members["second"]]) > 50.0
        first, second = plan.halves[one.name]
        sizes = [abs(size) for size in one.speeds_of_planets()]
        assert (first > second) == (sizes[0] > sizes[1])
    # what a sleeve joins stands on one axis
    for element in box.elements:
        assert abs(plan.heights[element.first] - plan.heights[element.second]) < 10.0
    for gear in (None, *box.gears):
        marks = painted(box, plan, None if gear is None else box.state(gear))
        assert drawings.overlapping_labels(marks) == []
        texts = {mark.text for mark in marks if isinstance(mark, Label)}
        assert {one.name for one in (*box.sets, *box.elements)} | {"input", "output"} <= texts
        assert {mark.what for mark in marks if isinstance(mark, Polyline)} >= set(box.members) - {"idR"}
    assert ElementTree.fromstring(cw.diagram(box, "axes", gear="R").svg).tag.endswith("svg")


def test_power_takes_the_way_of_the_gear() -> None:
    """The wheels that carry are those of the gear and of its axle."""
    box = cw.Gearbox.load("vw-dq250")
    wide = {
        mark.what
        for mark in painted(box, axes(box), box.state("5"))
        if isinstance(mark, Polyline) and mark.what and mark.width > 3.0
    }
    assert wide == {"in", "in1", "w5", "lay2", "out"}


def test_planetary_sets_are_refused() -> None:
    box = cw.Gearbox.load("zf-8hp70")
    assert not fits(box)
    with pytest.raises(cw.UseError, match="has planetary sets, and axes shows gear pairs"):
        cw.diagram(box, "axes")
