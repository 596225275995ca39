"""Model files: what they may hold, and that they read back."""

from __future__ import annotations

import json
import math
import tomllib

import pytest

import clutchwork as cw
from support import six_speed

EVERYTHING = """
format = 1
name = "all forms"
description = "for people"

[[shaft]]
name = "a"
inertia = "2000 kg cm2"
speed = "300 rpm"
angle = {value = 90, unit = "deg"}

[[shaft]]
name = "b"
inertia = 1

[[mass]]
name = "car"
mass = "1.2 t"
speed = "36 km/h"
position = 5

[[element]]
name = "c"
type = "clutch"
base = "a"
follower = "b"
gain = "100 cm3"
locked = true
pressure = {type = "column", path = "data/p.csv", column = "F1", unit = "bar"}
[element.friction]
type = "coefficient_table"
static = 0.2
kinetic = {points = [[0, 15], [60, 10]], unit_x = "rpm", unit = "%"}

[[element]]
name = "brake"
type = "brake"
shaft = "b"
gain = "2 N m"
normal_force = "50 %"
friction = {type = "coulomb", static = 0.2, kinetic = 0.1}

[[element]]
name = "motor"
type = "torque"
shaft = "a"
torque = {type = "sine", amplitude = 2, frequency = "3 1/s", unit = "kN m", offset = "5 N m"}

[[element]]
name = "fan"
type = "quadratic_torque"
shaft = "b"
nominal_torque = -3.0
nominal_speed = "3000 rpm"
same_direction = true

[[element]]
name = "axle"
type = "rolling_wheel"
shaft = "b"
mass = "car"
radius = "30 cm"

[simulation]
t_end = "500 ms"
rtol = 1e-7
method = "dopri5"
"""


@pytest.fixture
def everything(tmp_path):
    (tmp_path / "data").mkdir()
    (tmp_path / "data/p.csv").write_text("time,F1\n0,0\n0.5,2\n")
    (tmp_path / "model.toml").write_text(EVERYTHING.replace('speed = "36 km/h"\n', ""))
    return tmp_path / "model.toml"


def test_every_form_becomes_si(everything):
    d = cw.Driveline.load(everything)
    a, b, car = d.nodes
    c, brake, motor, fan, axle = d.elements
    assert a == cw.Node("a", inertia=0.2, speed=10 * math.pi, angle=math.pi / 2)
    assert (b.inertia, b.speed) == (1.0, None)
    assert (car.inertia, car.angle, car.domain) == (1200.0, 5.0, cw.Domain.TRANSLATION)
    assert c.gain == pytest.approx(1e-4)
    assert c.locked is True
    assert c.pressure.points == ((0.0, 0.0), (0.5, 2e5))
    assert list(c.friction.kinetic) == [(0.0, 0.15), (pytest.approx(2 * math.pi), 0.1)]
    assert (brake.gain, brake.normal_force) == (2.0, 0.5)
    assert (motor.torque.amplitude, motor.torque.frequency) == (2000.0, 3.0)
    assert fan.same_direction is True
    assert axle.radius == pytest.approx(0.3)
    assert d.simulation == {"t_end": 0.5, "rtol": 1e-7, "method": "dopri5"}


def test_own_unit_inside_a_signal_with_a_unit(everything):
    """The unit of a signal is that of its plain numbers; a text with a unit speaks for itself."""
    assert cw.Driveline.load(everything).elements[2].torque.offset == 5.0


@pytest.mark.parametrize("name", ["copy.toml", "copy.json", "deep/er/copy.toml"])
def test_reads_back(everything, name):
    d = cw.Driveline.load(everything)
    copy = everything.parent / name
    copy.parent.mkdir(parents=True, exist_ok=True)
    d.save(copy)
    again = cw.Driveline.load(copy)
    assert again.simulation == d.simulation
    assert again.assemble().to_bytes() == d.assemble().to_bytes()
    again.save(copy.with_stem("second"))
    assert copy.with_stem("second").read_text() == copy.read_text()


def test_toml_and_json_have_the_same_shape(everything):
    d = cw.Driveline.load(everything)
    d.save(everything.with_name("x.toml"))
    d.save(everything.with_name("x.json"))
    from_toml = tomllib.loads(everything.with_name("x.toml").read_text())
    assert from_toml == json.loads(everything.with_name("x.json").read_text())


def test_six_speed_gearbox_reads_back(tmp_path):
    d = six_speed.gearbox(six_speed.SHIFT)
    d.save(tmp_path / "box.toml")
    assert cw.Driveline.load(tmp_path / "box.toml").assemble().to_bytes() == d.assemble().to_bytes()


def test_odd_names_and_texts_survive(tmp_path):
    d = cw.Driveline('a "quoted" \\ name, $x$ Ü 🙂')
    d.add(cw.Damper("=[x]#", base=d.shaft("größe 1.5", inertia=1.0), follower=d.housing, damping=1e-300))
    for name in ("x.toml", "x.json"):
        d.save(tmp_path / name)
        again = cw.Driveline.load(tmp_path / name)
        assert again.name == d.name
        assert again.to_dict() == d.to_dict()


def test_defaults_are_left_out():
    d = cw.Driveline("x")
    d.add(cw.Brake("b", shaft=d.shaft("a", inertia=1.0), friction=cw.Coulomb(static=1, kinetic=1), gain=1, pressure=2))
    assert d.to_dict() == {
        "format": 1,
        "name": "x",
        "shaft": [{"name": "a", "inertia": 1.0}],
        "element": [
            {
                "name": "b",
                "type": "brake",
                "shaft": "a",
                "friction": {"type": "coulomb", "static": 1, "kinetic": 1},
                "gain": 1,
                "pressure": 2,
            }
        ],
    }


def test_a_controller_stays_in_python(tmp_path):
    d = cw.Driveline("x")
    d.add(cw.Torque("t", shaft=d.shaft("a", inertia=1.0), torque=cw.Sampled(lambda time, readings: 1.0, 0.1)))
    with pytest.raises(cw.ModelError, match="is a Python function, which a model file cannot hold"):
        d.save(tmp_path / "x.toml")
    assert not (tmp_path / "x.toml").exists()
    assert d.assemble().input_count.tolist() == [0]


def test_ending_decides_the_form(tmp_path):
    with pytest.raises(cw.ModelError, match=r"must end in \.toml or \.json"):
        cw.Driveline("x").save(tmp_path / "x.yaml")
