"""Mistakes in the fields of a disc clutch are named."""

from __future__ import annotations

import pytest

import clutchwork as cw
from support.disk_clutches import problems

feature = pytest.mark.feature


@feature("geometry: annular region")
def test_rings_that_are_none_are_named() -> None:
    ring = {"radius": None, "outer_diameter": 0.1}
    assert any("not below the outer diameter" in text for text in problems(**ring, inner_diameter=0.15))
    assert any("inner_diameter" in text and "missing" in text for text in problems(**ring))
    assert any("outer_diameter" in text and "missing" in text for text in problems(radius=None))
    assert any("together with a diameter" in text for text in problems(outer_diameter=0.2, inner_diameter=0.1))


def test_mistakes_of_the_law_hide_none_of_the_clutch() -> None:
    """All at once: the ring, the fault, too few points, and every place where the static coefficient is too low."""
    table = cw.FrictionTable(static=0.2, kinetic=[(0.0, 0.3), (5.0, 0.25)], interpolation="smooth")
    ring = {"radius": None, "outer_diameter": 0.1, "inner_diameter": 0.15}
    found = problems(friction=table, fault="cannot_unlock", **ring)
    for words in ("has 2 points", "at 0 rad/s", "at 5 rad/s", "not below the outer diameter", "nothing triggers it"):
        assert any(words in text for text in found), (words, found)
    # also where a value of the law makes no sense by itself
    broken = cw.FrictionTable(static=0.2, kinetic=[(0.0, 0.3), (5.0, 0.25), (5.0, 0.1)])
    found = problems(friction=broken, **ring)
    for words in ("appears twice", "not below the outer diameter"):
        assert any(words in text for text in found), (words, found)


def test_what_contradicts_itself_is_named() -> None:
    assert any("nothing triggers it" in text for text in problems(fault="cannot_unlock"))
    assert any("triggers no fault" in text for text in problems(fault_time=1.0))
    table = cw.TemperatureTable(static=[(300.0, 0.4), (400.0, 0.3)], kinetic=[(300.0, 0.3), (400.0, 0.2)])
    assert any("temperature" in text for text in problems(friction=table))
