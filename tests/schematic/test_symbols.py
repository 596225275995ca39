"""Every element has a symbol, also one that nobody has drawn yet."""

from __future__ import annotations

from typing import Any

import pytest

import clutchwork as cw
from clutchwork.declare.schema import Role, specs
from clutchwork.schematic.moment import Snapshot
from clutchwork.schematic.pen import Stroke, SymbolPen, around
from clutchwork.schematic.sheet import Sheet
from clutchwork.schematic.symbols import table
from clutchwork.schematic.symbols.contacts import clutch, cone, freewheel
from clutchwork.schematic.symbols.symbol import LEFT, RIGHT, Drawn
from support import samples, schematics

KINDS = {cls.kind: cls for cls in samples.declared(*samples.ELEMENT_ROLES)}
kinds = pytest.mark.parametrize("kind", list(KINDS))


def piece(sheet: Sheet, name: str) -> Any:
    return next(piece for piece in sheet.pieces if piece.name == name and piece.what != "heat")


@kinds
def test_each_draws_alone(kind: str) -> None:
    made = samples.driveline(KINDS[kind]).draw()
    assert schematics.overlaps(made.sheet) == []
    assert schematics.on_each_other(made.sheet) == []
    assert made._repr_svg_().startswith("<?xml")
    assert [p.name for p in made.sheet.pieces if p.what != "heat"].count("x") == 1
    box = around(piece(made.sheet, "x").marks)
    assert box.right - box.left > 10.0
    assert box.high - box.low > 10.0


@kinds
def test_each_has_a_symbol_of_its_own(kind: str) -> None:
    assert kind in table.OWN


@kinds
def test_one_without_has_that_of_its_role(kind: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(table, "OWN", {})
    made = samples.driveline(KINDS[kind]).draw()
    assert schematics.overlaps(made.sheet) == []
    assert [p.name for p in made.sheet.pieces if p.what != "heat"].count("x") == 1


@kinds
def test_its_lines_end_at_its_symbol(kind: str) -> None:
    d = samples.driveline(KINDS[kind])
    made = d.draw().sheet
    element = d.elements[0]
    names = {
        getattr(element, item.name).name for item, _ in specs(type(element), "port") if getattr(element, item.name)
    }
    if element.role is Role.FLOW:
        names = {getattr(element, item.name).name for item, _ in specs(type(element), "thermal")}
    box = around(piece(made, "x").marks)
    for name in names:
        ends = [end for wire in made.wires if wire.node == name for p in wire.pieces for end in p]
        near = [1 for x, y in ends if box.left - 0.1 <= x <= box.right + 0.1 and box.low <= y <= box.high]
        assert near, name


def test_a_symbol_says_what_is_at_the_housing() -> None:
    d = cw.Driveline("held")
    a, b = d.shaft("a", inertia=1.0), d.shaft("b", inertia=1.0)
    d.add(cw.Planetary("set", sun=a, carrier=b, ring=d.housing, ratio=2.0))
    d.add(cw.Spring("free", base=a, follower=b, stiffness=1.0))
    d.add(cw.Spring("tied", base=d.housing, follower=b, stiffness=1.0))
    made = d.draw().sheet
    # a wall is a thick line with short slanted ones
    assert _walls(piece(made, "set")) == 1
    assert _walls(piece(made, "free")) == 0
    assert _walls(piece(made, "tied")) == 1


def _walls(found: Any) -> int:
    slanted = [m for m in found.marks if isinstance(m, Stroke) and len(m.points) == 2 and m.look.width == 0.6]
    tall = [m for m in found.marks if isinstance(m, Stroke) and m.look.width == 1.3]
    return len(tall) if slanted else 0


@pytest.mark.parametrize("forward", [True, False])
def test_a_freewheel_points_from_what_drives_to_what_may_run_ahead(forward: bool) -> None:
    d = cw.Driveline("freewheel")
    a, b = d.shaft("a", inertia=1.0), d.shaft("b", inertia=1.0)
    d.add(cw.Torque("drive", shaft=a, torque=1.0))
    ends = {"base": a, "follower": b} if forward else {"base": b, "follower": a}
    d.add(cw.OneWayClutch("wheel", **ends))
    made = d.draw().sheet
    wedge = next(m for m in piece(made, "wheel").marks if isinstance(m, Stroke) and len(m.points) == 3)
    tip = wedge.points[1][0]
    back = wedge.points[0][0]
    # a stands on the left, where the torque is
    assert (tip > back) is forward


@pytest.mark.parametrize("draw", [clutch, cone, freewheel])
def test_states_differ_in_black_and_white(draw: Any) -> None:
    shapes = []
    for state in ("locked", "slipping", "open"):
        pen = SymbolPen()
        draw(pen, Drawn(None, {"a": LEFT, "b": RIGHT}, state=state))
        halo = {"#CFE6F7", "#FCE4D0"}
        strokes = [m for m in pen.marks if isinstance(m, Stroke) and m.look.fill not in halo]
        # dark areas and thin lines, whatever their colours
        dark = sum(bool(m.look.fill) and m.look.fill == m.look.colour for m in strokes)
        shapes.append((dark, len(strokes)))
    assert len(set(shapes)) == 3, shapes


def test_nothing_is_said_where_there_is_no_run() -> None:
    moment = Snapshot()
    d = cw.Driveline.from_dict(samples.driveline(cw.Clutch).to_dict())
    from clutchwork.schematic.diagram import diagram

    for thing in diagram(d._model).things:
        assert moment.node_lines(thing) == moment.element_lines(thing) == []


def test_values_have_their_units() -> None:
    d = cw.Driveline("units")
    a, b = d.shaft("a", inertia=0.2), d.shaft("b", inertia=0.3)
    m = d.mass("m", mass=1300.0)
    d.add(cw.Torque("drive", shaft=a, torque=12500.0))
    d.add(cw.SpringDamper("k", base=a, follower=b, stiffness=1165745.0, damping=1678.8))
    d.add(cw.RollingWheel("w", shaft=b, mass=m, radius=0.3))
    d.add(cw.Torque("pull", shaft=m, torque=cw.Table([(0.0, 1.0), (1.0, -30.0)])))
    shares = {"share": cw.Table([(0.0, 0.0), (1.0, 1.0)]), "newton": cw.Table([(0.0, 0.0), (1.0, 900.0)])}
    for name, load in shares.items():
        d.add(cw.Clutch(name, base=a, follower=b, friction=schematics.LINING, gain=0.25, normal_force=load))
    d.add(cw.Clutch("oil", base=a, follower=b, friction=schematics.LINING, gain=2e-3, pressure=4e5))
    made = d.draw().sheet
    written = {p.name: [t.text.replace("\u2009", " ") for t in p.text[1:]] for p in made.pieces}
    assert written["a"] == ["0.2 kg m²"]
    assert written["m"] == ["1300 kg"]
    assert written["drive"] == ["12.5 kN m"]
    assert written["k"] == ["1.166 MN m/rad", "1679 N m s/rad"]
    assert written["w"] == ["radius 0.3 m"]
    assert written["pull"] == ["force(t)"]
    assert written["share"] == ["gain 0.25 N m", "normal force(t)"]
    assert written["newton"] == ["gain 0.25 m", "normal force(t)"]
    assert written["oil"] == ["gain 0.002 m³", "400 kPa"]
