"""What a declaration says of its work is so: tables of energy with and without a thermal node."""

from __future__ import annotations

from dataclasses import replace

import pytest

import clutchwork as cw
from clutchwork.declare.node import Component, Work
from clutchwork.declare.ports import ports
from clutchwork.declare.schema import REGISTRY, Role, component, port, specs
from clutchwork.elements.bases.heating import Heating
from support import samples
from support.declarations import Cam, Coil, EddyBrake, OiledCoil

# what measures alone has no work
TORQUES = [cls for cls in samples.acting(Role.TORQUE) if cls is not cw.Displacement]
NEW = [EddyBrake, Coil, OiledCoil, Cam]
# so that they do what they are for within a moment
VALUES = {
    cw.DogClutch: {
        "engaged": True,
        "command": 1.0,
        "teeth": 20,
        "gap": 0.02,
        "stiffness": 2000.0,
        "speed": 50.0,
        "reversed": False,
    },
    cw.ElasticBacklash: {"stiffness": 60.0, "damping": 0.3, "gap": 0.02, "initial_twist": 0.06},
    cw.ElasticGap: {"stiffness": 60.0, "damping": 0.3, "initial_gap": -0.05},
    cw.QuadraticTorque: {"nominal_torque": -0.5, "nominal_speed": 5.0, "same_direction": False},
    cw.WetDrag: {"peak": 4.0, "speed": 2.0},
    cw.ResistingTorque: {"torque": 3.0, "speed": 1.0},
    cw.Damper: {"damping": 0.4},
    cw.SpringDamper: {"stiffness": 60.0, "damping": 0.3, "initial_twist": 0.05},
    cw.Spring: {"stiffness": 60.0, "initial_twist": 0.05},
    cw.Torque: {"torque": cw.Sine(amplitude=5.0, frequency=2.0)},
    cw.AirDrag: {"area": 2.0},
    EddyBrake: {"peak": 4.0, "speed": 2.0},
    Coil: {"rate": 60.0, "wound": 0.05},
    OiledCoil: {"rate": 60.0, "oil": 0.3, "wound": 0.05},
    Cam: {"rate": 60.0, "wound": 0.05},
}


def _name(cls):
    return cls.__name__


def _driveline(cls, heat=None, share=1.0):
    """An element between two shafts that turn against each other."""
    d = cw.Driveline(cls.__name__)
    names = [item.name for item, _ in specs(cls, "port")]
    moving = next((name for name in ("follower", "shaft", "impeller") if name in names), names[0])
    b = samples.bodies(d, cls, moving)("b", inertia=0.7, speed=2.0 if cls.ways else -2.0)
    other = next((name for name in names if name != moving), moving)
    a = samples.bodies(d, cls, other)("a", inertia=0.4, speed=-4.0 if cls.ways else 4.0)
    nodes = {"rotation": b, "other": a, "plates": None, "air": None, "translation": None}
    values = samples.fields(cls, nodes) | VALUES.get(cls, {})
    values |= dict.fromkeys(names[2:]) | {moving: b, **({other: a} if other != moving else {})}
    if heat is not None:
        values |= {"heat": d.thermal("lining", capacity=50.0), "heat_share": share}
    d.add(cls("x", **values))
    return d


def _run(*args):
    run = _driveline(*args).simulate(0.7, rtol=1e-9, atol=1e-11)
    assert abs(run.energy.residual) <= 1e-8 * run.energy.turnover
    assert run.energy.turnover > 1e-3
    return run


@pytest.mark.parametrize("cls", [*TORQUES, *NEW], ids=_name)
def test_work_stands_in_the_table_where_it_is_declared(cls):
    run = _run(cls)
    energy, work = run.energy, run["x.work"][-1]
    assert set(energy.sources) == ({"x"} if Work.SOURCE in cls.work else set())
    assert set(energy.heat) == ({"x"} if Work.LOSS in cls.work or cls.supply else set())
    stored = energy.elastic
    assert (stored != 0.0) == (Work.STORE in cls.work)
    # both shafts together lose what the element takes
    assert energy.kinetic == pytest.approx(work, rel=1e-7)
    assert energy.sources.get("x", 0.0) - energy.heat.get("x", 0.0) - stored == pytest.approx(work, rel=1e-7)
    if Work.LOSS in cls.work:
        assert energy.heat["x"] > 1e-3


@pytest.mark.parametrize("share", [1.0, 0.4])
@pytest.mark.parametrize("cls", [cls for cls in (*TORQUES, *NEW) if issubclass(cls, Heating)], ids=_name)
def test_a_thermal_node_takes_its_share_and_changes_nothing_else(cls, share):
    cold, warm = _run(cls).energy, _run(cls, "lining", share).energy
    assert warm.elastic == pytest.approx(cold.elastic, rel=1e-6, abs=1e-9)
    assert warm.kinetic == pytest.approx(cold.kinetic, rel=1e-6)
    if cls.supply:
        # it draws its heat besides its work
        assert warm.thermal["lining"] == pytest.approx(share * warm.heat["x"], rel=1e-6)
        assert warm.sources == pytest.approx(cold.sources, rel=1e-6)
    elif Work.SOURCE in cls.work:
        # what the node takes of the work of a load is heat, the rest leaves the driveline
        assert warm.thermal["lining"] == pytest.approx(-share * cold.sources["x"], rel=1e-6)
        assert warm.sources["x"] == pytest.approx((1.0 - share) * cold.sources["x"], rel=1e-6, abs=1e-9)
        assert warm.untracked == pytest.approx(0.0, abs=1e-9)
    else:
        assert warm.heat == pytest.approx(cold.heat, rel=1e-6)
        assert warm.sources == cold.sources == {}
        assert warm.thermal["lining"] == pytest.approx(share * cold.heat["x"], rel=1e-6)
        assert warm.untracked == pytest.approx((1.0 - share) * cold.heat["x"], rel=1e-6, abs=1e-9)


@pytest.mark.parametrize("cls", [*TORQUES, *NEW], ids=_name)
def test_declared_roles_fit_each_other(cls):
    element = _driveline(cls).elements[0]
    assert len(element.initial_states()) == len(element.own_states())
    passive = element.passive()
    if passive is not None:
        # nothing comes from outside where all is stiffness and damping
        assert Work.SOURCE not in cls.work
        assert (Work.STORE in cls.work) == bool(passive.stiffness)
        assert (Work.LOSS in cls.work) == any(
            replace(element, **{item.name: 1.0}).passive().damping for item, _ in specs(cls, "param")
        )
    if passive is not None and passive.stiffness:
        assert cls.states[0].unit == "N m"
        assert cls.elastic
    if Work.STORE in cls.work:
        assert cls.states


ONE_WAY = [cls for cls in samples.declared(Role.CONTACT, Role.TORQUE, Role.MOTION) if not cls.ways]


@pytest.mark.parametrize("cls", ONE_WAY, ids=_name)
def test_ports_are_base_and_follower_or_shaft(cls):
    names = [item.name for item, _ in specs(cls, "port")]
    assert cls.ways or names in (["base", "follower"], ["shaft"], ["shaft", "base"])
    assert list(ports(samples.driveline(cls).elements[0])) == names


def test_other_ports_are_refused_when_the_declaration_is_read():
    class Strange(Component):
        input: cw.Node = port("one end")
        output: cw.Node = port("other end")

    with pytest.raises(TypeError, match=r"ports of Strange are input, output; declare base, follower or shaft, base"):
        component(Role.TORQUE)(Strange)
    assert Strange not in REGISTRY[Role.TORQUE].values()


@pytest.mark.parametrize(("cls", "twist"), [(cw.Spring, "initial_twist"), (Coil, "wound")], ids=str)
def test_the_twist_of_a_spring_is_a_signal_whatever_its_fields_are_called(cls, twist):
    run = _run(cls)
    start = VALUES[cls][twist]
    expected = run["b.angle"] - run["a.angle"] + start
    assert run["x.twist"] == pytest.approx(expected, abs=1e-7)


def test_a_wet_drag_and_an_eddy_brake_are_no_load():
    d = cw.Driveline("rig")
    motor, shaft = d.shaft("motor", inertia=0.4, speed=4.0), d.shaft("shaft", inertia=0.7, speed=4.0)
    d.add(cw.Torque("drive", shaft=motor, torque=3.0))
    d.add(cw.Spring("k", base=motor, follower=shaft, stiffness=50.0))
    d.add(EddyBrake("retarder", shaft=shaft, peak=2.0, speed=3.0))
    energy = d.simulate(0.5).energy
    assert set(energy.sources) == {"drive"}
    assert set(energy.heat) == {"retarder"}
    assert energy.heat["retarder"] > 0.0


def test_work_is_not_source_and_loss_at_once():
    class Both(Component):
        work = Work.SOURCE | Work.LOSS
        base: object = port("a")
        follower: object = port("b")

    with pytest.raises(TypeError, match="work of Both cannot be told apart as source and loss"):
        component(Role.TORQUE)(Both)
