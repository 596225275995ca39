"""What `repr` says of shafts, elements, laws and signals: short, on one line, with units, and of anything given."""

from __future__ import annotations

import warnings
from typing import Any

import pytest

import clutchwork as cw
from clutchwork.declare.schema import specs
from support import samples

ELEMENTS = samples.declared(*samples.ELEMENT_ROLES)
# a line of a terminal, twice; what holds a law or a table of many numbers may take more
SHORT = 160


def test_what_a_notebook_shows_of_the_last_line_of_a_cell() -> None:
    d = cw.Driveline("car")
    engine, body = d.shaft("engine", inertia=0.2, speed="100 rad/s"), d.mass("body", mass=1500.0, position=2.0)
    car = d.shaft("car", inertia=2.0)
    plates, air = d.thermal("plates", capacity=500.0, limit=500.0), d.ambient("air")
    assert repr(engine) == "<Node 'engine': inertia 0.2 kg m2, speed 100 rad/s>"
    assert repr(body) == "<Node 'body': mass 1500 kg, position 2 m>"
    assert repr(d.housing) == "<Node 'housing': does not move>"
    assert repr(plates) == "<ThermalNode 'plates': capacity 500 J/K, temperature 300 K, limit 500 K>"
    assert repr(air) == "<ThermalNode 'air': ambient, temperature 300 K>"
    lining = cw.Coulomb(static=0.3, kinetic=0.25)
    clutch = d.add(
        cw.Clutch("c1", base=engine, follower=car, friction=lining, gain=1e-4, pressure="2 bar", heat=plates)
    )
    assert repr(clutch) == (
        "<Clutch 'c1': base 'engine', follower 'car', friction Coulomb(static=0.3, kinetic=0.25), gain 0.0001 m3,"
        " pressure 200000 Pa, heat 'plates'>"
    )
    ice = cw.SpeedTorque("ice", shaft=engine, torque=[(0.0, 50.0), (300.0, 100.0)])
    assert repr(ice) == "<SpeedTorque 'ice': shaft 'engine', torque [(0.0, 50.0), (300.0, 100.0)] N m>"
    # on a mass a torque is a force
    assert repr(cw.Torque("pull", shaft=body, torque=3.0)) == "<Torque 'pull': shaft 'body', torque 3 N>"
    assert repr(cw.Torque("gear", shaft=car, torque=(clutch, "torque"))).endswith("torque 'c1'.torque>")


@pytest.mark.parametrize("cls", ELEMENTS, ids=lambda cls: cls.kind)
def test_every_element_names_what_it_joins(cls: Any) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", cw.ModelWarning)
        element = samples.driveline(cls).elements[0]
    text = repr(element)
    assert "\n" not in text
    assert text.startswith(f"<{cls.__name__} 'x'")
    for item, _ in specs(cls, "port"):
        node = getattr(element, item.name)
        assert node is None or f"{item.name} {node.name!r}" in text
    assert "Node" not in text


def test_laws_and_signals_are_written_as_they_are_called() -> None:
    """What is not a default, so that the same call makes the same again."""
    for thing in (
        cw.Stribeck(static=0.3, kinetic=0.2, speed=10.0),
        cw.LuGre(static=0.3, kinetic=0.2, speed=10.0, stiffness=1e4, damping=1.0),
        cw.Step(height=2.0, start=1.0),
        cw.Table([(0.0, 1.0), (1.0, 2.0)]),
    ):
        assert eval(repr(thing), vars(cw).copy() | {name: getattr(cw, name) for name in cw.__all__}) == thing


@pytest.mark.parametrize(
    "wrong", [None, "x", [1, 2], {}, object(), float("nan"), 10**5000], ids=lambda wrong: type(wrong).__name__
)
def test_wrong_values_are_shown_too(wrong: Any) -> None:
    for thing in (
        cw.Torque("t", shaft=wrong, torque=wrong),
        cw.Gear("g", input=wrong, output=wrong, ratio=wrong),
        cw.Node("n", inertia=wrong, speed=wrong, angle=wrong),
        cw.ThermalNode("t", capacity=wrong, temperature=wrong, limit=wrong),
        cw.Coulomb(static=wrong, kinetic=wrong),
        cw.Torque(wrong, shaft=cw.Node("a"), torque=1.0),
    ):
        assert len(repr(thing)) < 10 * SHORT
