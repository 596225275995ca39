"""Thermal nodes, flows and composites in a model: mistakes, model files, places in the System, names of signals."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import ClassVar

import pytest

import clutchwork as cw
from clutchwork.declare.schema import Role

LAW = cw.Coulomb(static=0.2, kinetic=0.1)


def _model():
    d = cw.Driveline("warm")
    a, b = d.shaft("a", inertia=0.2, speed=50.0), d.shaft("b", inertia=0.4)
    plates, air = d.thermal("plates", capacity=500.0), d.ambient("air", temperature=293.0)
    return d, a, b, plates, air


def _mistakes(d):
    return [str(problem) for problem in d.check()]


def _one(d):
    found = _mistakes(d)
    assert len(found) == 1, found
    return found[0]


@pytest.mark.parametrize("capacity", [0.0, -1.0, float("nan"), "500"])
def test_capacity_is_a_number_above_zero(capacity):
    d = cw.Driveline()
    d.shaft("a", inertia=1.0)
    d.thermal("plates", capacity=capacity)
    assert 'thermal "plates": capacity' in _one(d)


@pytest.mark.parametrize("temperature", [0.0, -20.0, float("inf"), cw.Step(height=1.0)])
def test_temperature_of_a_mass_is_an_absolute_number(temperature):
    d = cw.Driveline()
    d.shaft("a", inertia=1.0)
    d.thermal("plates", capacity=1.0, temperature=temperature)
    assert 'thermal "plates": temperature' in _one(d)


def test_temperature_of_an_ambient_is_a_signal():
    d, _a, _, plates, _ = _model()
    d.ambient("oil", temperature=plates)
    d.ambient("room", temperature="20")
    first, second = _mistakes(d)
    assert 'ambient "oil": temperature' in first
    assert "join the nodes by a Conduction" in first
    assert 'ambient "room": temperature' in second


def test_thermal_port_on_a_shaft():
    d, a, _b, plates, _ = _model()
    d.add(cw.Conduction("wall", hot=plates, cold=a, conductance=1.0))
    found = _one(d)
    assert "cw.Conduction(\"wall\"): cold = 'a': must be a thermal node or an ambient" in found


def test_port_on_a_thermal_node():
    d, a, _, plates, _ = _model()
    d.add(cw.Clutch("c", base=plates, follower=a, friction=LAW, gain=1.0, pressure=1.0))
    assert "base" in _one(d)
    assert "must be a shaft, a mass or the housing" in _one(d)


def test_heat_to_a_node_of_another_driveline():
    d, a, _, _, _ = _model()
    other = cw.Driveline().thermal("plate", capacity=1.0)
    d.add(cw.Brake("b1", shaft=a, friction=LAW, gain=1.0, pressure=1.0, heat=other))
    assert "heat = 'plate': belongs to another driveline; create it here; did you mean 'plates'?" in _one(d)


def test_flow_between_one_and_the_same_node():
    d, _, _, plates, _ = _model()
    d.add(cw.Conduction("wall", hot=plates, cold=plates, conductance=1.0))
    assert "hot and cold are both attached to 'plates'" in _one(d)


def test_share_of_the_heat_is_between_zero_and_one():
    d, a, _, plates, _ = _model()
    d.add(cw.Brake("b1", shaft=a, friction=LAW, gain=1.0, pressure=1.0, heat=plates, heat_share=1.1))
    assert "heat_share = 1.1: must be >= 0 and <= 1;" in _one(d)


def test_names_are_taken_once_among_all():
    d, _a, _, _plates, _ = _model()
    d.thermal("a", capacity=1.0)
    assert "name = 'a': is already the name of shaft \"a\"" in _one(d)


def test_conductance_over_speed_is_not_negative():
    d, a, _, plates, air = _model()
    d.add(cw.Convection("fan", hot=plates, cold=air, conductance=[(0.0, 1.0), (10.0, -1.0)], speed=a))
    assert "conductance, point 2 = -1.0 W/K: must be >= 0" in _one(d)
    d, a, _, plates, air = _model()
    d.add(cw.Convection("fan", hot=plates, cold=air, conductance=-1.0, speed=a))
    assert "conductance = -1.0 W/K: must be >= 0" in _one(d)


def _pressed(d, a, value):
    d.add(cw.Brake("b1", shaft=a, friction=LAW, gain=1.0, pressure=value))
    return _one(d)


def test_an_input_from_something_of_another_unit():
    d, a, _, plates, _ = _model()
    assert "pressure must be in [Pa], but 'plates' gives [K]" in _pressed(d, a, plates)


def test_an_input_from_an_element_without_output():
    d, a, b, _, _ = _model()
    damper = d.add(cw.Damper("v", base=a, follower=b, damping=1.0))
    assert "pressure = 'v': has no output" in _pressed(d, a, damper)


def test_rates_and_heats_are_inputs_of_flows_and_processes_only():
    d, a, b, _, _ = _model()
    damper = d.add(cw.Damper("v", base=a, follower=b, damping=1.0))
    assert "pressure = Rate of 'v': must be a number in [Pa] or a signal" in _pressed(d, a, cw.Rate(damper))


def test_speed_of_something_that_is_not_there():
    d, _a, _b, plates, air = _model()
    foreign = cw.Driveline().shaft("z")
    d.add(cw.Convection("f1", hot=plates, cold=air, conductance=1.0, speed=foreign))
    assert "speed = 'z': was not added to this driveline" in _one(d)


def test_heat_flow_is_no_speed():
    d, a, b, plates, air = _model()
    damper = d.add(cw.Damper("v", base=a, follower=b, damping=1.0))
    d.add(cw.Convection("f1", hot=plates, cold=air, conductance=1.0, speed=cw.HeatFlow(damper)))
    assert "speed must be in [rad/s], but HeatFlow of 'v' gives [W]" in _one(d)


def test_speed_of_a_flow_in_all_its_forms():
    """A shaft, the rate of an element, and a signal of the same speed cool alike."""
    ends = []
    for form in ("shaft", "rate", "signal"):
        d, a, _b, plates, air = _model()
        d.add(cw.PrescribedSpeed("p", shaft=a, speed=50.0))
        damper = d.add(cw.Damper("v", base=d.housing, follower=a, damping=1.0))
        speed = {"shaft": a, "rate": cw.Rate(damper), "signal": 50.0}[form]
        d.add(cw.Convection("fan", hot=plates, cold=air, conductance=[(0.0, 1.0), (100.0, 20.0)], speed=speed))
        run = d.simulate(3.0)
        ends.append(run["plates.temperature"][-1])
    assert ends[0] == pytest.approx(ends[1], rel=1e-9) == pytest.approx(ends[2], rel=1e-9)


FILE = """
name = "warm"
[[shaft]]
name = "a"
inertia = 0.2
speed = 50.0
[[thermal]]
name = "plates"
capacity = "0.5 kJ/K"
[[ambient]]
name = "air"
temperature = {type = "ramp", height = 10.0, duration = 2.0, offset = 293.0}
[[element]]
name = "fan"
type = "convection"
hot = "plates"
cold = "air"
conductance = {points = [[0.0, 5.0], [1000.0, 20.0]], unit_x = "rpm"}
speed = {type = "rate", of = "b1"}
[[element]]
name = "b1"
type = "brake"
shaft = "a"
friction = {type = "coulomb", static = 0.12, kinetic = 0.1}
gain = 1.0
pressure = 20.0
heat = "plates"
heat_share = 0.9
[[element]]
name = "disc"
type = "thermal_plate"
thickness = "2 mm"
area = 0.01
conductivity = 45.0
density = 7800.0
specific_heat = 480.0
nodes = 3
[[element]]
name = "wall"
type = "conduction"
hot = "plates"
cold = "disc.surface"
conductance = 100.0
"""


def _load(tmp_path, text):
    (tmp_path / "model.toml").write_text(text)
    return cw.Driveline.load(tmp_path / "model.toml")


def test_model_file(tmp_path):
    d = _load(tmp_path, FILE)
    assert [node.name for node in d.thermal_nodes] == ["plates", "air"]
    assert d.thermal_nodes[0].capacity == 500.0
    # elements that others refer to keep their place in the file
    assert [element.name for element in d.elements] == ["fan", "b1", "disc", "wall"]
    assert d.elements[0].speed.of is d.elements[1]
    for name in ("again.toml", "again.json"):
        d.save(tmp_path / name)
        again = cw.Driveline.load(tmp_path / name)
        assert again.to_dict() == d.to_dict()
        assert again.assemble().to_bytes() == d.assemble().to_bytes()
    d.assemble().save(tmp_path / "system.npz")
    assert cw.System.load(tmp_path / "system.npz").to_bytes() == d.assemble().to_bytes()


FILE_MISTAKES = {
    "no capacity": ('capacity = "0.5 kJ/K"', "", 'thermal "plates": capacity is missing; give a value in [J/K]'),
    "unit of the capacity": ('"0.5 kJ/K"', '"0.5 kJ"', "has a unit that does not fit; give it in [J/K]"),
    "unknown key": (
        'capacity = "0.5 kJ/K"',
        "capacity = 500.0\nmass = 1.0",
        'thermal "plates": mass is an unknown key',
    ),
    "unknown node": (
        'heat = "plates"',
        'heat = "plate"',
        "is not a thermal node of this model; did you mean 'plates'?",
    ),
    "shaft as thermal node": ('heat = "plates"', 'heat = "a"', "heat = 'a': is not a thermal node of this model"),
    "thermal node as shaft": ('shaft = "a"', 'shaft = "plates"', "shaft = 'plates': is not a shaft of this model"),
    "unknown part": ('"disc.surface"', '"disc.middle"', "cold = 'disc.middle': is not a thermal node of this model"),
    "unknown element": (
        'of = "b1"',
        'of = "b2"',
        "speed = 'b2': is not a thermal node, element or shaft of this model; did you mean 'b1'?",
    ),
}


@pytest.mark.parametrize("case", FILE_MISTAKES)
def test_mistakes_in_a_model_file(tmp_path, case):
    old, new, message = FILE_MISTAKES[case]
    assert old in FILE
    with pytest.raises(cw.ModelError) as caught:
        _load(tmp_path, FILE.replace(old, new))
    assert any(message in str(problem) for problem in caught.value.problems), caught.value


def test_an_element_with_mistakes_is_reported_once(tmp_path):
    with pytest.raises(cw.ModelError) as caught:
        _load(tmp_path, FILE.replace("gain = 1.0", "gain = -1.0"))
    assert [problem.quantity for problem in caught.value.problems] == ["gain"]


def test_elements_that_refer_to_each_other_in_a_circle(tmp_path):
    text = FILE.replace("pressure = 20.0", 'pressure = "fan"')
    with pytest.raises(cw.ModelError, match="refers back to itself"):
        _load(tmp_path, text)


def test_places_in_the_system():
    d, a, b, plates, air = _model()
    d.add(cw.Damper("v", base=a, follower=b, damping=0.1, heat=air, heat_share=0.25))
    d.add(cw.Clutch("c", base=a, follower=b, friction=LAW, gain=1.0, pressure=3.0, heat=plates))
    d.add(cw.Spring("s", base=d.housing, follower=a, stiffness=1.0))
    d.add(cw.Conduction("wall", hot=plates, cold=air, conductance=7.0))
    system = d.assemble()
    assert system.counts["shared"] == 2
    assert system.counts["flows"] == 1
    assert system.initial_state.tolist() == [0.0, 0.0, 0.0]
    assert system.shared_scale.tolist() == [1 / 500.0, 1.0]
    assert system.shared_offset.tolist() == [300.0, 0.0]
    assert system.heat_direction.tolist() == [0, 2]
    assert system.heat_to.tolist() == [1, 0]
    assert system.heat_share.tolist() == [0.25, 1.0]
    assert (system.flow_from.tolist(), system.flow_to.tolist()) == ([0], [1])
    # signals: temperature of the air, then the pressure; the temperature of the plates is shared state 0
    assert [item.name for item in system.inputs] == ["air.temperature", "c.pressure"]
    first = system.flow_input[0]
    assert system.input_refs[first : first + 2].tolist() == [2, 0]


def test_signals_and_units():
    d, a, b, plates, air = _model()
    d.add(cw.Clutch("c", base=a, follower=b, friction=LAW, gain=1.0, pressure=3.0, heat=plates))
    d.add(cw.Convection("fan", hot=plates, cold=air, conductance=1.0, speed=a))
    run = d.simulate(0.1)
    units = {
        "plates.temperature": "K",
        "plates.heat": "J",
        "air.temperature": "K",
        "air.heat": "J",
        "c.temperature": "K",
    }
    assert {name: run.units[name] for name in units} == units
    assert run.units["fan.heat_flow"] == "W"
    assert "a.speed_sensor.torque" not in run.names
    assert set(run.energy.heat) == {"c"}
    assert not run.energy.sources


@dataclass(frozen=True)
class Pair(cw.Damper):
    """A damper with a second one in parallel, and one of its own to the housing."""

    role: ClassVar[Role] = Role.COMPOSITE
    kind: ClassVar[str] = "pair"

    def parts(self) -> Iterator[cw.Damper]:
        yield cw.Damper(self.name, base=self.base, follower=self.follower, damping=self.damping)
        yield cw.Damper(f"{self.name}.twin", base=self.base, follower=self.follower, damping=2.0 * self.damping)
        yield cw.Damper(f"{self.name}.loss", base=cw.Driveline().housing, follower=self.follower, damping=0.1)

    def sums(self) -> tuple[str, ...]:
        return ("twin", "missing")


def test_parts_of_a_composite_add_up_under_its_name():
    d, a, b, *_ = _model()
    d.add(Pair("p", base=b, follower=a, damping=0.3))
    system = d.assemble()
    assert [element.name for element in system.elements] == ["p", "p.twin", "p.loss"]
    assert system.sums == {"p": ("p.twin",)}
    run = d.simulate(0.5)
    for name in ("torque", "power", "work"):
        assert run[f"p.{name}"][-1] == pytest.approx(1.5 * run[f"p.twin.{name}"][-1])
    assert run["p.torque"] == pytest.approx(-0.9 * run["p.rate"])
    # in the balance every part stands by itself
    assert set(run.energy.heat) == {"p", "p.twin", "p.loss"}


def test_a_name_that_a_part_has_already():
    d, a, b, *_ = _model()
    d.add(Pair("p", base=b, follower=a, damping=0.3))
    d.add(cw.Damper("p.twin", base=b, follower=a, damping=0.3))
    assert "name = 'p.twin': is already the name of" in _one(d)


def test_parts_of_a_plate():
    plate = cw.ThermalPlate(
        "x", thickness=0.01, area=0.1, conductivity=50.0, density=8000.0, specific_heat=500.0, nodes=5
    )
    assert plate.part("surface") == plate.surface
    assert plate.part("back") == plate.back
    capacity = 0.01 * 0.1 * 8000.0 * 500.0
    assert plate.surface.capacity == pytest.approx(capacity / 8.0)
    nodes = [part for part in plate.parts() if isinstance(part, cw.ThermalNode)]
    assert sum(node.capacity for node in nodes) == pytest.approx(capacity)
    walls = [part for part in plate.parts() if isinstance(part, cw.Conduction)]
    assert [wall.conductance for wall in walls] == pytest.approx([50.0 * 0.1 / 0.0025] * 4)
    with pytest.raises(KeyError):
        plate.part("front")
