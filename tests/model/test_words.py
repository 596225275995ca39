"""What messages and tables say: bounds with a remedy, near names, counts, signs, and what `print` shows."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

import clutchwork as cw
from clutchwork.base.errors import UnknownName
from clutchwork.base.plural import counted
from clutchwork.base.quote import measured
from clutchwork.declare.schema import REGISTRY, Role, specs
from clutchwork.model.components import component_problems
from clutchwork.results.energy import EnergyBalance
from clutchwork.results.events import Event, Events
from support import samples


def _driveline(**changes: object) -> cw.Driveline:
    d = cw.Driveline("two discs")
    engine, load = d.shaft("engine", inertia=0.2, speed=10.0), d.shaft("load", inertia=0.8)
    given = {"friction": cw.Coulomb(static=0.12, kinetic=0.1), "gain": 0.1, "pressure": 1e3}
    d.add(cw.Clutch("c1", base=engine, follower=load, **given | changes))
    return d


@pytest.mark.parametrize(
    ("field", "value", "words"),
    [
        ("gain", -0.1, "gain = -0.1 m3: must be > 0 m3; give a positive value (torque per unit of pressure"),
        ("tolerance", -1.0, "must be >= 0 rad/s; give zero or a positive value (slip below which"),
        ("heat_share", 2.0, "must be >= 0 and <= 1; lower it (share"),
        ("gain", "3", "gain = '3': has no unit; remove the quotes or add one, such as '3 m3'"),
    ],
)
def test_a_bound_comes_with_what_to_do(field: str, value: object, words: str) -> None:
    (problem,) = _driveline(**{field: value}).check()
    assert words in str(problem)


def test_what_print_shows() -> None:
    d = _driveline(gain=-0.1)
    assert repr(d) == "<Driveline 'two discs': 2 shafts and masses, 0 thermal nodes, 1 element>"
    assert repr(d.check()).startswith('[<Problem cw.Clutch("c1"): gain = -0.1 m3: must be > 0 m3; ')


def test_units_answer_a_misspelt_signal_with_near_ones() -> None:
    units = _driveline().simulate(0.1).units
    assert units["c1.torque"] == "N m"
    with pytest.raises(UnknownName, match=r"^no signal 'c1.torqe'; did you mean 'c1.torque'\? `run.names` lists all"):
        units["c1.torqe"]
    with pytest.raises(UnknownName, match=r"^no signal 'zzz'; `run.names` lists all"):
        units["zzz"]


@pytest.mark.parametrize(
    ("count", "plural", "said"),
    [
        (1, "events", "1 event"),
        (0, "events", "0 events"),
        (1, "shafts and masses", "1 shaft or mass"),
        (1, "processes", "1 process"),
        (2, "processes", "2 processes"),
        (1, "gear rows", "1 gear row"),
    ],
)
def test_one_is_singular(count: int, plural: str, said: str) -> None:
    assert counted(count, plural) == said


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"pressure": "0.2 mpa"}, "'mpa'; did you mean 'MPa'?"),
        ({"pressure": "2 mps"}, "'mps'; did you mean 'psi'?"),
        ({"speed": "1000 U/mn"}, "'mn'; did you mean 'min'?"),
        ({"inertia": "0.2 kgm^2"}, "'kgm^2'; did you mean 'kg m2'?"),
        ({"inertia": "0.2 kgm2"}, "'kgm2'; did you mean 'kg m2'?"),
        ({"inertia": -0.2}, "give zero or a positive value (moment of inertia, zero only where no torque on it jumps)"),
    ],
)
def test_a_remedy_is_one_for_the_quantity(given: dict[str, Any], said: str) -> None:
    d = cw.Driveline()
    engine = d.shaft("engine", inertia=given.get("inertia", 0.2), speed=given.get("speed", 100.0))
    lining, pressure = cw.Coulomb(static=0.1, kinetic=0.1), given.get("pressure", 1e5)
    d.add(cw.Brake("b1", shaft=engine, friction=lining, gain=1e-3, pressure=pressure))
    with pytest.raises(cw.ModelError) as caught:
        d.simulate(1.0)
    assert said in str(caught.value)


def test_numbers_that_would_look_alike_have_more_digits() -> None:
    ratios = (0.0, 0.5, 0.9999999)
    d = cw.Driveline()
    pump, turbine = d.shaft("pump", inertia=0.2), d.shaft("turbine", inertia=0.2)
    curve = {"speed_ratio": ratios, "capacity": (1e-3, 5e-4, 0.0), "density": 850.0, "diameter": 0.3}
    d.add(cw.FluidCoupling("fc", base=pump, follower=turbine, **curve))
    with pytest.raises(cw.ModelError, match=r"speed_ratio ends at 0\.9999999, must end at 1"):
        d.simulate(1.0)
    assert [measured(0.5, unit) for unit in ("1", "", "Pa")] == ["0.5", "0.5", "0.5 Pa"]
    assert (measured(1.0000001, "s", 1.0), measured(2.0, "s", 2.0)) == ("1.0000001 s", "2 s")


def test_numbers_that_do_not_rise_differ_and_have_no_unit_of_one() -> None:
    torque = cw.Table([(0.0, 0.0), (1.0, 1.0), (0.9999999, 2.0)])
    with pytest.raises(cw.ModelError, match=r"pressure\.points, point 3 = 0\.9999999 s: comes after 1 s;"):
        _driveline(pressure=torque).simulate(1.0)
    d = cw.Driveline()
    pump, turbine = d.shaft("pump", inertia=0.2), d.shaft("turbine", inertia=0.2)
    curve = {"capacity": (1e-3, 5e-4, 0.0, 0.0), "density": 850.0, "diameter": 0.3}
    d.add(cw.FluidCoupling("fc", base=pump, follower=turbine, speed_ratio=(0.0, 0.5, 0.4, 1.0), **curve))
    with pytest.raises(cw.ModelError, match=r"speed_ratio, number 3 = 0\.4: comes after 0\.5;"):
        d.simulate(1.0)


def test_names_that_are_given_apart_want_a_list() -> None:
    with pytest.raises(cw.UseError, match=r"names are given apart; write a list of all, such as \['F1\.gain', 'b'\]"):
        cw.together("a", "b", factor=(0.9, 1.1))  # type: ignore[misc]


def test_no_table_shows_minus_zero() -> None:
    event = Event(0.0, "c1", "forward", "locked", "slip zero", -0.0, -0.0, 0.0, 1.0, 1.0)
    assert "-0" not in str(Events([event]))
    assert "-0.000" not in str(EnergyBalance({"t": -1e-9}, -1e-9, -1e-9, {"c1": -1e-9}, 0.0))


def test_a_model_file_that_is_missing(tmp_path: Path) -> None:
    (tmp_path / "gearbox.toml").write_text("")
    for path, words in (
        ("gearbx.toml", "file: does not exist; did you mean 'gearbox.toml'?"),
        ("other.toml", "file: does not exist; check the path; in its folder: gearbox.toml"),
        ("none/gearbox.toml", "file: does not exist; check the path: there is no folder"),
    ):
        with pytest.raises(cw.ModelError) as caught:
            cw.Driveline.load(tmp_path / path)
        assert words in str(caught.value)


PRESSED = [
    (cls, item.name)
    for role in (Role.CONTACT, Role.COMPOSITE)
    for cls in REGISTRY[role].values()
    for item, spec in specs(cls, "signal", "alternative")
    if spec.presses
]


def test_every_pressure_and_force_on_a_contact_presses() -> None:
    loads = {
        (cls, item.name)
        for cls in samples.declared(Role.CONTACT, Role.COMPOSITE)
        for item, spec in specs(cls, "signal", "alternative")
        if spec.unit in ("Pa", "N") and spec.at_least is None
    }
    # a negative pressure closes the plates of a synchroniser's other side; ports of a pump press nothing
    assert {cls for cls, _ in loads - set(PRESSED)} == {cw.PlateContact, cw.Pump}


@pytest.mark.parametrize(("cls", "name"), PRESSED)
def test_a_load_that_is_never_above_zero_is_refused(cls: type, name: str) -> None:
    element = samples.driveline(cls).elements[0]
    dips, below = cw.Table([(0.0, -1.0), (1.0, 1.0)]), cw.Table([(0.0, -1.0), (1.0, 0.0)])
    never = (-1.0, cw.Constant(-1.0), below, cw.Sine(amplitude=0.5, frequency=1.0, offset=-0.5))
    for load in (*never, 0.0, None, dips):
        found = [str(one) for one in component_problems(replace(element, **{name: load}))]
        refused = any(f": {name} = -1" in one and "never presses" in one for one in found)
        assert refused == any(load is one for one in never), (load, found)


def test_a_system_counts_in_the_words_of_its_driveline() -> None:
    d = cw.Driveline("two discs")
    a, b = d.shaft("a", inertia=1.0), d.shaft("b", inertia=1.0)
    d.add(cw.Clutch("c1", base=a, follower=b, gain=0.1, normal_force=1.0, friction=cw.Coulomb(static=0.2, kinetic=0.2)))
    system = d.assemble()
    same = "2 shafts and masses, 0 thermal nodes, 1 element"
    assert repr(d) == f"<Driveline 'two discs': {same}>"
    own = "2 independent speeds, 0 torque elements, 1 contact, 1 input"
    assert repr(system) == f"<System 'two discs': {same}, {own}>"
    assert repr(cw.System.from_bytes(system.to_bytes())) == f"<System 'system': 2 shafts and masses, {own}>"


def test_a_cell_that_was_run_again_is_told_as_the_likely_cause() -> None:
    d = cw.Driveline("car")
    d.shaft("engine", inertia=1.0)
    d.shaft("engine", inertia=1.0)
    d.mass("housing", mass=1.0)
    twice, taken = d.check()
    assert "if a notebook cell was run again, create the driveline in it" in str(twice)
    assert "notebook" not in str(taken)


def test_shafts_and_masses_are_nodes_by_their_domain() -> None:
    d = cw.Driveline("car")
    wheel, body, engine = d.shaft("wheel"), d.mass("body", mass=1.0), d.shaft("engine", inertia=1.0)
    assert d.nodes == (wheel, body, engine)
    assert (d.shafts, d.masses) == ((wheel, engine), (body,))
