"""Sankey pictures: nothing lies over anything else, names are safe, every door writes the same picture."""

from __future__ import annotations

import xml.etree.ElementTree as ET
from itertools import combinations
from pathlib import Path

import pytest

import clutchwork as cw
from clutchwork.command.main import main
from clutchwork.plot.sankey import amount
from clutchwork.plot.sankey_graph import graph
from clutchwork.plot.sankey_places import BAR, places
from support import random_contacts, random_large
from support.project import ROOT

SIX_SPEED = ROOT / "examples" / "six_speed" / "model.toml"
CAR = ROOT / "examples" / "car_launch" / "model.toml"


def _table(source):
    if isinstance(source, Path):
        return cw.Driveline.load(source).simulate().losses()
    make, seed = source
    return make(seed).simulate(0.5).losses()


@pytest.mark.parametrize(
    "source",
    [SIX_SPEED, CAR, *((random_contacts.driveline, seed) for seed in range(8)), (random_large.driveline, 0)],
    ids=lambda source: getattr(source, "parent", None) and source.parent.name,
)
def test_boxes_do_not_lie_over_each_other(source) -> None:
    table = _table(source)
    made = graph(table, *(table.shafts or (None, None)))
    where = places(made, 180.0)
    for one, other in combinations(where.boxes.values(), 2):
        apart_x = abs(one.x - other.x) > BAR
        apart_y = abs(one.y - other.y) >= 0.5 * (one.high + other.high)
        assert apart_x or apart_y
    for ribbon in made.ribbons:
        assert made.column[ribbon.start] < made.column[ribbon.end]
    for place in where.boxes.values():
        # round-off of mm
        assert place.y - 0.5 * place.high >= -1e-9
        assert place.y + 0.5 * place.high <= where.high + 1e-9


def test_drive_is_left_and_load_is_right() -> None:
    """When the car rolls and drives its engine too."""
    table = _table(SIX_SPEED)
    made = graph(table, *table.shafts)
    assert made.column["engine"] == 0
    assert made.column["load"] == max(made.column.values())
    d = cw.Driveline("coast")
    engine, car = d.shaft("engine", inertia=0.2, speed=300.0), d.shaft("car", inertia=5.0, speed=300.0)
    d.add(cw.SpeedTorque("drag", shaft=engine, torque=[(0.0, -10.0), (500.0, -40.0)]))
    d.add(cw.Spring("shaft", base=engine, follower=car, stiffness=1e4))
    d.add(cw.QuadraticTorque("air", shaft=car, nominal_torque=-5.0, nominal_speed=300.0, same_direction=False))
    table = d.simulate(2.0).losses()
    made = graph(table, *table.shafts)
    assert made.column["drag"] < made.column["engine"] < made.column["shaft"] < made.column["car"] < made.column["air"]


def test_names_are_shown_as_they_are(tmp_path) -> None:
    name = "<b> & $x_1$"
    d = cw.Driveline(name)
    a, b = d.shaft(name + " a", inertia=0.2, speed=10.0), d.shaft("b", inertia=0.3)
    d.add(cw.Damper("oil " + name, base=a, follower=b, damping=0.5))
    d.simulate(1.0).sankey(tmp_path / "picture.svg")
    words = [item.text for item in ET.parse(tmp_path / "picture.svg").iter() if item.tag.endswith("text")]
    assert "oil " + name in words


def test_doors(tmp_path, capsys) -> None:
    picture = tmp_path / "six.svg"
    assert main(["run", str(SIX_SPEED), "--losses", "--sankey", str(picture)]) == 0
    told = capsys.readouterr().out
    assert "share of heat" in told
    assert str(picture) in told
    assert picture.read_text(encoding="utf-8").startswith("<?xml")
    assert main(["run", str(SIX_SPEED), "--losses", "--json"]) == 0
    assert '"heat_J"' in capsys.readouterr().out
    with pytest.raises(cw.UseError, match="svg"):
        cw.Driveline.load(SIX_SPEED).simulate(0.1).sankey("picture.docx")


def test_a_notebook_shows_picture_and_table() -> None:
    shown = _table(SIX_SPEED)._repr_mimebundle_()
    assert "image/png" in shown
    assert "share of heat" in shown["text/html"]


def test_a_run_where_nothing_moves_has_an_empty_picture(tmp_path) -> None:
    d = cw.Driveline("rest")
    a = d.shaft("a", inertia=1.0)
    d.add(cw.Brake("brake", shaft=a, friction=cw.Coulomb(static=1.0, kinetic=0.8), gain=1.0, normal_force=80.0))
    d.simulate(1.0).sankey(tmp_path / "rest.png")
    assert (tmp_path / "rest.png").stat().st_size > 0


def test_numbers_have_three_digits() -> None:
    found = [amount(value, "J") for value in (0.0, 0.01234, 12.34, 999.6, 98_700.0, -1.889e6, 3.2e10)]
    assert found == ["0 J", "0.012 J", "12.3 J", "1.00 kJ", "98.7 kJ", "-1.89 MJ", "32.0 GJ"]
