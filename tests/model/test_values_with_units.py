"""Every number that is declared may have a unit, as a string or as a quantity of pint, in Python as in files."""

from __future__ import annotations

import math
import pickle
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import clutchwork as cw
from clutchwork.base.classes import PLAIN
from clutchwork.declare.node import Component, Node
from clutchwork.declare.schema import Role, Spec, specs
from clutchwork.declare.to_si import PARTNERS
from clutchwork.declare.units import parse
from clutchwork.model.components import component_problems
from clutchwork.model.fields import object_problems
from clutchwork.model.numbers import At
from clutchwork.model.problems import NODE_FIELDS
from support.other_units import UREG, WAYS, other, text
from support.samples import ELEMENT_ROLES, declared, driveline, fields, nodes, number, value

# a string has the digits of what pint converted to; both conversions round their factor and their product: 4 roundings
CLOSE = 4 * np.finfo(float).eps

SORTS = ("param", "option", "signal", "alternative", "curve", "numbers")
CLASSES = declared(*ELEMENT_ROLES, Role.LAW, Role.SIGNAL)
FIELDS = [
    pytest.param(cls, item.name, spec, id=f"{cls.__name__}.{item.name}")
    for cls in CLASSES
    for item, spec in specs(cls, *SORTS)
    if not (spec.flag or spec.choices or spec.whole or spec.unit == "*")
]
DRIVEN = [case for case in FIELDS if case.values[2].what in ("signal", "alternative")]


def made(cls: type, on_masses: bool = False, **changes: Any) -> Any:
    """An object of a class whose other fields are samples; of two ways to give an input the one that changes."""
    joined = nodes()
    if on_masses:
        joined |= {name: cw.Node(name, cw.Domain.TRANSLATION, 1.0) for name in ("rotation", "other", "translation")}
    values = fields(cls, joined)
    for item, spec in specs(cls, "alternative"):
        if item.name in changes:
            values.pop(spec.instead_of, None)
    values |= changes
    return cls("x", **values) if issubclass(cls, Component) else cls(**values)


def si(cls: type, name: str, spec: Spec) -> Any:
    """A value in SI for a field."""
    if spec.what in ("curve", "numbers"):
        return value(name, spec, nodes())
    return 330.0 if spec.unit == "K" else number(name, spec)


def given_as(way: Callable[[float, str], Any], plain: Any, spec: Spec) -> Any:
    """A value of a field with units."""
    if spec.what == "curve":
        return [(way(x, spec.unit_x), way(y, spec.unit)) for x, y in plain]
    if spec.what == "numbers":
        return [given_as(way, row, spec) if isinstance(row, list | tuple) else way(row, spec.unit) for row in plain]
    return way(plain, spec.unit)


def problems(thing: Any) -> list[Any]:
    if isinstance(thing, Component):
        return list(component_problems(thing))
    return list(object_problems(thing, At("x", "", "Pa")))


def numbers_in(thing: Any) -> list[Any]:
    return [leaf for row in thing for leaf in numbers_in(row)] if isinstance(thing, list | tuple) else [thing]


@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize(("cls", "name", "spec"), FIELDS)
def test_every_field_takes_another_unit(cls: type, name: str, spec: Spec, way: str) -> None:
    plain = si(cls, name, spec)
    thing = made(cls, **{name: given_as(WAYS[way], plain, spec)})
    found, wanted = numbers_in(getattr(thing, name)), numbers_in(plain)
    assert {type(one) for one in found} == {float}
    # zero degrees are not zero kelvin: round-off is that of the larger number
    least = 300.0 if "K" in (spec.unit, spec.unit_x) else 0.0
    for one, other_one in zip(found, wanted, strict=True):
        assert one == pytest.approx(other_one, rel=CLOSE, abs=CLOSE * least)
    if not problems(made(cls, **{name: plain})):
        assert not problems(thing)


@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize(("cls", "name", "spec"), FIELDS)
def test_every_field_refuses_another_quantity(cls: type, name: str, spec: Spec, way: str) -> None:
    """With the name of the field, what was given, what is wanted, and an example of it."""
    powers = {parse(unit).powers for unit in (spec.unit, *spec.units)}
    unit = next(unit for unit in ("bar", "rpm", "kg") if parse(unit).powers not in powers)
    wrong = f"3 {unit}" if way == "text" else UREG.Quantity(3.0, unit)
    plain = si(cls, name, spec)
    given_value = [(plain[0][0], wrong)] if spec.what == "curve" else [wrong] if spec.what == "numbers" else wrong
    found = [problem for problem in problems(made(cls, **{name: given_value})) if problem.quantity.startswith(name)]
    assert found, f"nothing is said about {given_value}"
    assert "has a unit that does not fit" in found[0].message
    assert unit in str(found[0].value) or "revolutions_per_minute" in found[0].value or "kilogram" in found[0].value
    allowed = [f"[{one}]" for one in (spec.unit, *spec.units)]
    assert any(one in found[0].remedy for one in allowed)
    assert spec.unit == "1" or "such as" in found[0].remedy


def signals(way: Callable[[float, str], Any], unit: str) -> Iterator[tuple[cw.Signal, cw.Signal]]:
    """Signals of all kinds with units, and the same in SI."""

    def rise(size: float) -> Any:
        # a difference of temperatures has no zero in degrees
        return (f"{size!r} K" if way is text else UREG.Quantity(size, "K")) if unit == "K" else way(size, unit)

    later, at = way(0.25, "s"), way(400.0, unit)
    yield cw.Constant(at), cw.Constant(400.0)
    yield cw.Step(height=rise(3.0), start=later, offset=at), cw.Step(height=3.0, start=0.25, offset=400.0)
    yield (
        cw.Ramp(height=rise(3.0), duration=later, offset=at),
        cw.Ramp(height=3.0, duration=0.25, offset=400.0),
    )
    yield (
        cw.Pulse(height=rise(3.0), period=way(1.0, "s"), width=later, offset=at),
        cw.Pulse(height=3.0, period=1.0, width=0.25, offset=400.0),
    )
    yield (
        cw.Sine(amplitude=rise(3.0), frequency=way(5.0, "Hz"), phase=way(0.5, "rad"), offset=at),
        cw.Sine(amplitude=3.0, frequency=5.0, phase=0.5, offset=400.0),
    )
    yield cw.Table([(0.0, at), (later, at)]), cw.Table([(0.0, 400.0), (0.25, 400.0)])


@pytest.mark.parametrize("way", WAYS)
@pytest.mark.parametrize(("cls", "name", "spec"), DRIVEN)
def test_signals_take_the_unit_of_what_they_drive(cls: type, name: str, spec: Spec, way: str) -> None:
    for unit in (spec.unit, *spec.units):
        on_masses = PARTNERS.get(spec.unit) == unit
        for signal, plain in signals(WAYS[way], unit):
            found, wanted = (getattr(made(cls, on_masses, **{name: one}), name) for one in (signal, plain))
            for one, other_one in zip(found.segments(), wanted.segments(), strict=True):
                # a slope is a quotient of differences of rounded numbers
                assert tuple(one) == pytest.approx(tuple(other_one), rel=1e-13, abs=1e-12)


@pytest.mark.parametrize(("cls", "name", "spec"), DRIVEN)
def test_signals_with_another_quantity_are_refused_where_they_drive(cls: type, name: str, spec: Spec) -> None:
    powers = {parse(unit).powers for unit in (spec.unit, *spec.units)}
    unit = next(unit for unit in ("bar", "rpm", "kg") if parse(unit).powers not in powers)
    for signal, where in (
        (cw.Step(height=f"3 {unit}"), "height"),
        (cw.Table([(0, 0), ("10 ms", f"3 {unit}")]), "points, point 2"),
        (cw.Constant(3 * UREG(unit)), "value"),
        (cw.Step(height=1.0, start="3 bar"), "start"),
    ):
        found = [str(problem) for problem in problems(made(cls, **{name: signal}))]
        assert any(f"{name}.{where} = " in one and "has a unit that does not fit" in one for one in found), found


ABSOLUTE = [case for case in FIELDS if case.values[2].unit == "K"]


@pytest.mark.parametrize(("cls", "name", "spec"), ABSOLUTE)
def test_degrees_are_temperatures(cls: type, name: str, spec: Spec) -> None:
    for given_value, kelvin in (
        ("90 degC", 363.15),
        ("90 °C", 363.15),
        ("90 C", 363.15),
        ("-5.5 DegC", 267.65),
        ("212 degF", 373.15),
        (UREG.Quantity(90, "degC"), 363.15),
        (UREG.Quantity(212, "degF"), 373.15),
    ):
        found = getattr(made(cls, **{name: [given_value] if spec.what == "numbers" else given_value}), name)
        assert numbers_in(found) == [pytest.approx(kelvin, rel=CLOSE)]
    # a difference is none
    wrong = UREG.Quantity(10, "delta_degC")
    wrong_value = [wrong] if spec.what == "numbers" else wrong
    assert any("difference of temperatures" in str(p) for p in problems(made(cls, **{name: wrong_value})))


@pytest.mark.parametrize(("cls", "name", "spec"), [case for case in FIELDS if case not in ABSOLUTE])
def test_degrees_are_nothing_else(cls: type, name: str, spec: Spec) -> None:
    """Neither another quantity, nor a part of a unit such as that of a conductance."""
    for wrong in ("10 degC", f"10 {spec.unit.replace('K', 'degC')}"):
        if wrong == f"10 {spec.unit}":
            continue
        plain = si(cls, name, spec)
        given_value = [(plain[0][0], wrong)] if spec.what == "curve" else [wrong] if spec.what == "numbers" else wrong
        found = [str(p) for p in problems(made(cls, **{name: given_value})) if p.quantity.startswith(name)]
        assert found
        assert "is in degC, which has another zero" in found[0]


def test_a_difference_of_temperatures_has_no_zero_in_degrees() -> None:
    d = cw.Driveline()
    d.shaft("a", inertia=1.0)
    d.ambient("air", temperature=cw.Step(height="10 degC", offset="20 degC"))
    (problem,) = d.check()
    assert "ambient \"air\": temperature.height = '10 degC': is in degC" in str(problem)
    assert "give it in [K]; a difference of 1 degC, or of 1.8 degF, is 1 K" in str(problem)
    d = cw.Driveline()
    d.shaft("a", inertia=1.0)
    air = d.ambient("air", temperature=cw.Step(height=UREG.Quantity(10, "delta_degC"), offset="20 degC"))
    assert d.check() == []
    assert (air.temperature.height, air.temperature.offset) == (10.0, 293.15)


def test_nodes() -> None:
    d = cw.Driveline()
    for way in WAYS.values():
        for make, domain in ((d.shaft, Node("").domain), (d.mass, cw.Domain.TRANSLATION)):
            for place, (name, spec) in zip(("inertia", "speed", "angle"), NODE_FIELDS[domain].items(), strict=True):
                node = make("n", **{name: way(0.75, spec.unit)})
                assert getattr(node, place) == pytest.approx(0.75, rel=CLOSE)
                assert type(getattr(node, place)) is float
        plates = d.thermal("plates", capacity=way(900.0, "J/K"), temperature=way(350.0, "K"))
        assert (plates.capacity, plates.temperature) == (pytest.approx(900.0, rel=CLOSE), pytest.approx(350.0))
        assert d.ambient("air", temperature=way(350.0, "K")).temperature == pytest.approx(350.0, rel=CLOSE)


def test_all_mistakes_of_a_model_come_at_once() -> None:
    d = cw.Driveline("two discs")
    engine = d.shaft("engine", inertia="0.2 kg m", speed="955 rmp")
    load = d.shaft("load", inertia=0.8 * UREG("kg * m**2"))
    d.add(
        cw.Clutch(
            "c1",
            base=engine,
            follower=load,
            friction=cw.Coulomb(static="12 m", kinetic=0.1),
            gain="5e-4 m",
            pressure=cw.Table([(0, "0 bar"), (0.2, "2 rpm")]),
        )
    )
    found = [str(problem) for problem in d.check()]
    for words in (
        "shaft \"engine\": inertia = '0.2 kg m': has a unit that does not fit; give it in [kg m2], such as '0.2 kg m2'",
        "shaft \"engine\": speed = '955 rmp': has the unknown unit 'rmp'; did you mean 'rpm'? give it in [rad/s]",
        "cw.Clutch(\"c1\"): friction.static = '12 m': has a unit that does not fit",
        "cw.Clutch(\"c1\"): gain = '5e-4 m': has a unit that does not fit; give it in [m3], such as '5e-4 m3'",
        "cw.Clutch(\"c1\"): pressure.points, point 2 = '2 rpm': has a unit that does not fit; give it in [Pa]",
    ):
        assert any(words in one for one in found), found
    assert len(found) == 5
    with pytest.raises(cw.ModelError) as caught:
        d.assemble()
    assert [str(problem) for problem in caught.value.problems] == found


@pytest.mark.parametrize("cls", declared(*ELEMENT_ROLES), ids=lambda cls: cls.__name__)
def test_a_model_with_units_runs_as_the_same_in_si(cls: type, tmp_path: Any) -> None:
    """All fields of an element at once, through a run and through a file, bit for bit once the numbers are the same."""
    d = driveline(cls)
    (element,) = d.elements
    united = {
        item.name: given_as(text, getattr(element, item.name), spec)
        for item, spec in specs(cls, "param", "option")
        if type(getattr(element, item.name)) is float and not spec.whole
    }
    d._model.elements[0] = cw_replaced(element, united)
    found = d.elements[0]
    assert [p for p in d.check() if "unit" in str(p)] == []
    e = driveline(cls)
    e._model.elements[0] = cw_replaced(e.elements[0], {name: getattr(found, name) for name in united})
    assert d.assemble().to_bytes() == e.assemble().to_bytes()
    d.save(tmp_path / "m.toml")
    assert cw.Driveline.load(tmp_path / "m.toml").assemble().to_bytes() == e.assemble().to_bytes()


def cw_replaced(element: Any, values: dict[str, Any]) -> Any:
    from dataclasses import replace

    return replace(element, **values)


def test_files_and_python_read_alike() -> None:
    d = cw.Driveline("driveline")
    a, b = d.shaft("a", inertia="2000 kg cm2", speed="955 rpm"), d.shaft("b", inertia=0.8)
    law = cw.Coulomb(static="12 %", kinetic="10 %")
    pressure = cw.Table([(0, "0 bar"), ("200 ms", "2 bar")])
    d.add(cw.Clutch("c", base=a, follower=b, friction=law, gain="500 cm3", pressure=pressure))
    data = {
        "shaft": [
            {"name": "a", "inertia": "2000 kg cm2", "speed": "955 rpm"},
            {"name": "b", "inertia": 0.8},
        ],
        "element": [
            {
                "name": "c",
                "type": "clutch",
                "base": "a",
                "follower": "b",
                "friction": {"type": "coulomb", "static": "12 %", "kinetic": "10 %"},
                "gain": "500 cm3",
                "pressure": {"type": "table", "points": [[0, "0 bar"], ["200 ms", "2 bar"]]},
            }
        ],
    }
    assert cw.Driveline.from_dict(data).assemble().to_bytes() == d.assemble().to_bytes()
    assert d.elements[0].pressure.points == ((0, 0.0), (0.2, 2e5))
    assert d.to_dict()["element"][0]["pressure"]["points"] == [[0.0, 0.0], [0.2, 2e5]]


def test_a_name_that_looks_like_a_quantity_stays_a_name() -> None:
    data = {
        "shaft": [{"name": "2 bar", "inertia": 1.0}],
        "ambient": [{"name": "20 degC", "temperature": "30 degC"}],
        "thermal": [{"name": "plates", "capacity": 1.0}],
        "element": [
            {"name": "3 s", "type": "torque", "shaft": "2 bar", "torque": "1 N m"},
            {"name": "k", "type": "conduction", "hot": "plates", "cold": "20 degC", "conductance": "1 W/K"},
        ],
    }
    names = {item.name for item, _ in specs(cw.Conduction, "thermal")}
    data["element"][1] = {"name": "k", "type": "conduction", "conductance": "1 W/K"} | dict(
        zip(sorted(names), ("20 degC", "plates"), strict=True)
    )
    d = cw.Driveline.from_dict(data)
    assert d.nodes[0].name == "2 bar"
    assert d.thermal_nodes[1].name == "20 degC"
    column = cw.Column("2 bar", "3 s", time="4 ms")
    assert (column.path, column.column, column.time) == ("2 bar", "3 s", "4 ms")


def test_arrays_of_pint() -> None:
    temperatures = UREG.Quantity(np.array([20.0, 120.0]), "degC")
    slips = [0, 500] * UREG.rpm
    rows = [[0.15, 0.14], [0.14, 0.13]]
    law = cw.FrictionMap(temperatures=temperatures, speeds=slips, kinetic=rows, static=[0.2, 0.2])
    assert law.temperatures == pytest.approx((293.15, 393.15), rel=CLOSE)
    assert law.speeds == pytest.approx((0.0, 500 * math.pi / 30), rel=CLOSE)
    wrong = cw.FrictionMap(temperatures=[1, 2] * UREG.bar, speeds=slips, kinetic=rows, static=[0.2, 0.2])
    assert any("does not fit" in str(p) or "list of numbers" in str(p) for p in problems(wrong))


def test_a_signal_is_shared_by_two_quantities() -> None:
    """It has no unit of its own: each of those that take it reads it."""
    d = cw.Driveline()
    a = d.shaft("a", inertia=1.0)
    step = cw.Step(height="50 %", start="10 ms")
    law = cw.Coulomb(static=0.2, kinetic=0.1)
    clutch = cw.Brake("one", shaft=a, friction=law, gain="2 kNm", normal_force=step)
    drag = cw.WetDrag("two", base=d.housing, follower=a, peak="5 N m", speed="100 rpm", scale=step)
    assert clutch.normal_force == drag.scale == cw.Step(height=0.5, start=0.01)
    assert step.height == "50 %"


def test_what_turns_has_other_units_than_what_moves_on_a_line() -> None:
    """5 kN are no torque, though a torque element may be on a mass; files say the same."""
    d = cw.Driveline()
    a, b, m = d.shaft("a", inertia=1.0), d.shaft("b", inertia=1.0), d.mass("m", mass=2.0)
    law = cw.Coulomb(static=0.2, kinetic=0.1)
    d.add(cw.Torque("t1", shaft=a, torque="5 kN"))
    d.add(cw.Torque("t2", shaft=m, torque=cw.Step(height="5 kNm")))
    d.add(cw.Spring("s", base=a, follower=b, stiffness="5 N/mm"))
    d.add(cw.Brake("b1", shaft=m, friction=law, gain="5 cm3", pressure="2 bar"))
    d.add(cw.Brake("b2", shaft=a, friction=law, gain="5 cm2", pressure="2 bar", tolerance="1 mm/s"))
    found = {str(problem).partition(" = ")[0]: problem.remedy.partition(",")[0] for problem in d.check()}
    assert found == {
        'cw.Torque("t1"): torque': "give it in [N m]",
        'cw.Torque("t2"): torque.height': "give it in [N]",
        'cw.Spring("s"): stiffness': "give it in [N m/rad]",
        'cw.Brake("b1"): gain': "give it in [m2]",
        'cw.Brake("b2"): gain': "give it in [m3]",
        'cw.Brake("b2"): tolerance': "give it in [rad/s]",
    }
    data = {
        "shaft": [{"name": "a", "inertia": 1.0}],
        "mass": [{"name": "m", "mass": 1.0}],
        "element": [
            {"name": "t1", "type": "torque", "shaft": "a", "torque": "5 kN"},
            {"name": "t2", "type": "torque", "shaft": "m", "torque": {"type": "step", "height": 5, "unit": "kNm"}},
            {"name": "t3", "type": "torque", "shaft": "m", "torque": {"type": "step", "height": "5 kN"}},
        ],
    }
    with pytest.raises(cw.ModelError) as caught:
        cw.Driveline.from_dict(data)
    assert [problem.remedy.partition(",")[0] for problem in caught.value.problems] == [
        "give it in [N m]",
        "give it in [N]",
    ]
    system = cw.Driveline.from_dict(data | {"element": data["element"][2:]}).assemble()
    with pytest.raises(cw.ModelError, match="does not fit"):
        system.changed({"t3.torque": "5 N m"})
    assert system.changed({"t3.torque.height": "6 kN"}).source is not None


WORDS = st.sampled_from(
    ["bar", "rpm", "kg", "m2", "/", " ", "-", "1", "2,5", "%", "degC", "°", "²", "e5", ".", "(", "*"]
)
TEXTS = st.one_of(st.text(max_size=30), st.lists(WORDS, max_size=8).map("".join), WORDS.map("3 {}".format))


@given(TEXTS)
def test_any_string_is_a_number_or_a_problem(words: str) -> None:
    d = cw.Driveline()
    a = d.shaft("a", inertia=words, speed=words)
    b = d.shaft("b", inertia=1.0)
    law = cw.Coulomb(static=words, kinetic=0.1)
    pressure = cw.Table([(0, words), (1, "2 bar")])
    clutch = cw.Clutch("c", base=a, follower=b, friction=law, gain=words, pressure=pressure, heat_share=words)
    d.add(clutch)
    d.ambient("air", temperature=words)
    d.simulation["t_end"] = words
    assert d.check()
    for value_ in (a.inertia, a.speed, clutch.gain, law.static):
        assert type(value_) is float or value_ is words
    with pytest.raises(cw.ModelError):
        d.assemble()
    with pytest.raises(cw.OptionError):
        cw.Options(dt=words, max_steps=words)


def test_options_and_calls() -> None:
    d = cw.Driveline()
    d.shaft("a", inertia=1.0, speed=1.0)
    wanted = cw.simulate(d, 2.0, dt=0.5, max_step=0.1)
    for run in (
        cw.simulate(d, "2 s", dt="500 ms", max_step=100 * UREG.ms),
        cw.simulate(d, 2 * UREG.s, times=["0 s", 0.5, "1 s", 1500 * UREG.ms, "2 s"], max_step="0.1 s"),
        cw.simulate(d, "2 s", times=[0, 500, 1000, 1500, 2000] * UREG.ms, max_step="0.1 s"),
        cw.simulate(d, 2.0).at([0, 500, 1000, 1500, 2000] * UREG.ms),
    ):
        assert run.time == pytest.approx(wanted.time, rel=CLOSE)
    assert cw.simulate(d, 2.0).at("500 ms").time == [0.5]
    assert cw.Options(dt="1 ms").dt == 0.001
    for call in (
        lambda: cw.simulate(d, "2 bar"),
        lambda: cw.simulate(d, 2.0, dt="2 bar"),
        lambda: cw.simulate(d, 2.0, times=[0, "1 bar"]),
        lambda: cw.simulate(d, 2.0, times=[0, 1] * UREG.bar),
        lambda: cw.simulate(d, 2.0).at("2 bar"),
        lambda: cw.at("a.speed", "2 bar"),
    ):
        with pytest.raises(cw.OptionError, match="has a unit that does not fit"):
            call()
    with pytest.raises(cw.OptionError) as caught:
        cw.Options(dt="1 m", first_step="1 bar", rtol=5)
    assert len(caught.value.problems) == 3
    assert "rtol is 5: it must be at most 0.1" in str(caught.value)
    d.simulation = {"t_end": "2 s", "dt": 500 * UREG.ms}
    assert d.simulate().time == pytest.approx(wanted.time)
    assert d.to_dict()["simulation"] == {"t_end": 2.0, "dt": 0.5}


def test_changes_and_sweeps() -> None:
    d = cw.Driveline()
    a, b = d.shaft("a", inertia=0.2, speed=100.0), d.shaft("b", inertia=0.8)
    law = cw.Coulomb(static=0.12, kinetic=0.1)
    d.add(cw.Clutch("c", base=a, follower=b, friction=law, gain=5e-4, pressure=cw.Step(height=1e5)))
    d.thermal("plates", capacity=1e3)
    system = d.assemble()
    plain = {"c.gain": 4e-4, "a.inertia": 0.3, "plates.temperature": 363.15, "c.pressure.height": 2e5}
    united = {"c.gain": "400 cm3", "a.inertia": "3000 kg cm2", "plates.temperature": "90 degC"}
    united["c.pressure.height"] = "2 bar"
    assert system.changed(united).to_bytes() == system.changed(plain).to_bytes()
    with pytest.raises(cw.ModelError) as caught:
        system.changed({"c.gain": "400 cm", "c.pressure.height": "2 rpm", "a.inertia": "1 bar"})
    assert len(caught.value.problems) == 3
    for name, values, si_values in (
        ("c.gain", ["400 cm3", "5e-4 m3"], [4e-4, 5e-4]),
        ("c.pressure", ["1 bar", 2 * UREG.bar], [1e5, 2e5]),
        ("c.pressure.height", [1, 2] * UREG.bar, [1e5, 2e5]),
        ("plates.temperature", ["20 degC", "90 degC"], [293.15, 363.15]),
        ("a.inertia", ["2000 kg cm2", 0.3], [0.2, 0.3]),
    ):
        found = cw.sweep(d, "1 s", vary={name: values}, outputs=["a.speed", cw.at("b.speed", ["500 ms"])])
        wanted = cw.sweep(d, 1.0, vary={name: si_values}, outputs=["a.speed", cw.at("b.speed", [0.5])])
        assert found.coords[name].tolist() == si_values
        for output in found.names:
            assert found[output].tobytes() == wanted[output].tobytes()
        with pytest.raises(cw.ModelError, match="has a unit that does not fit"):
            cw.sweep(d, 1.0, vary={name: ["1 kg2"]}, outputs="a.speed")


def test_a_signal_says_itself_that_it_has_units() -> None:
    # not the process, so that another process knows it and signals without units are none the slower
    plain, known = cw.Ramp(height=2e5, duration=1.0), set(PLAIN)
    united = pickle.loads(pickle.dumps(cw.Ramp(height="2 bar", duration=1.0)))
    assert (plain.has_units, united.has_units, PLAIN) == (False, True, known)
    d = cw.Driveline("pickled")
    made = cw.Brake(
        "b", shaft=d.shaft("a", inertia=1.0), friction=cw.Coulomb(static=0.1, kinetic=0.1), gain=1e-3, pressure=united
    )
    assert made.pressure == plain
    assert not made.pressure.has_units


def test_other_words_of_the_same_unit() -> None:
    assert other("N m s/rad") == "kN mm ms/deg"
