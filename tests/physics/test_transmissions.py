"""A `Transmission` in every gear of every gearbox does what its statics say, and keeps its energy."""

import math
from dataclasses import replace

import pytest

import clutchwork as cw
from support.project import ROOT
from support.six_speed import DAMPING, INERTIA, STIFFNESS
from support.transmissions import boxes, in_gear

# speeds and torques are 1e2 to 1e3, of double precision, through sums of some ten terms
CLOSE = 1e-9
GEARS = [(name, gear) for name, box in boxes().items() for gear in box.states()]


def speed(run, member):
    return run[f"gearbox.{member}.speed"][-1]


@pytest.mark.parametrize("name", boxes())
def test_held_in_gear_it_turns_and_carries_as_the_gear_says(name):
    box = boxes()[name]
    for gear, state in box.states().items():
        if any(element.kind == "dog" for element in box.elements):
            # flanks give, so that nothing is rigid
            continue
        run = in_gear(box, gear).simulate(0.05)
        assert not run.events, (gear, run.events)
        assert run["engine.speed"][-1] / run["wheels.speed"][-1] == pytest.approx(state.ratio, rel=CLOSE), gear
        for member, per_input in state.speeds.items():
            assert speed(run, member) == pytest.approx(100.0 * per_input, rel=CLOSE, abs=100.0 * CLOSE), (gear, member)
        scale = 100.0 * max(1.0, abs(state.ratio), *(abs(t) for t in state.torques.values() if not math.isnan(t)))
        for element, per_input in state.torques.items():
            torque = run[f"gearbox.{element}.torque"][-1]
            assert math.isnan(per_input) or torque == pytest.approx(100.0 * per_input, abs=CLOSE * scale), (
                gear,
                element,
            )
        for element, per_input in state.slips.items():
            assert run[f"gearbox.{element}.slip"][-1] == pytest.approx(100.0 * per_input, abs=100.0 * CLOSE), element


@pytest.mark.parametrize(("name", "gear"), GEARS[:: max(1, len(GEARS) // 40)])
def test_energy_is_kept_while_it_is_driven_from_rest(name, gear):
    """Elements that slip at first: pressed, not locked, so that they make heat."""
    box = boxes()[name]
    d = in_gear(box, gear)
    run = d.simulate(0.3, rtol=1e-9, atol=1e-10)
    balance = run.energy
    assert abs(balance.residual) <= 1e-8 * max(1.0, balance.turnover)


@pytest.mark.parametrize("name", boxes())
def test_with_losses_it_is_as_efficient_as_the_gear_says(name):
    """A load of just that torque keeps the speeds; which of several elements carries what may then be friction."""
    box = boxes()[name]
    if any(element.kind == "dog" for element in box.elements):
        pytest.skip("flanks give")
    lossy = replace(box, sets=tuple(replace(one, efficiency=0.97) for one in box.sets))
    for gear, state in lossy.states().items():
        d = cw.Driveline("lossy")
        engine, wheels = d.shaft("engine", inertia=0.1, speed=100.0), d.shaft("wheels", inertia=2.0)
        given = {"gearbox": box, "efficiency": 0.97} if gear in list(box.gears)[::2] else {"gearbox": lossy}
        d.add(cw.Transmission("gearbox", input=engine, output=wheels, gear=gear, **given))
        d.add(cw.Torque("drive", shaft=engine, torque=100.0))
        d.add(cw.Torque("load", shaft=wheels, torque=-100.0 * state.torque_ratio))
        run = d.simulate(0.05)
        assert run["engine.speed"][-1] == pytest.approx(100.0, rel=CLOSE), gear
        losses = run.losses(power=True)
        assert losses.heat == pytest.approx(1e4 * (1.0 - state.efficiency), abs=1e4 * CLOSE), gear


def six_speed():
    """The reference case as two gearboxes, the divider and the base, with the elastic shaft between them."""
    reference = cw.Driveline.load(ROOT / "examples" / "six_speed" / "model.toml")
    old = {element.name: element for element in reference.elements}
    rows = {"D": ("w3", "w1", "w2", 2.78), "B1": ("w4", "w5", "w6", 1.83)}
    rows |= {"B2": ("w4", "w6", "w8", 2.35), "B3": ("w6", "w7", "w8", 2.0)}
    sets = {
        name: {"type": "single", "sun": sun, "ring": ring, "carrier": carrier, "ratio": ratio}
        for name, (sun, ring, carrier, ratio) in rows.items()
    }
    divider = {
        "name": "divider",
        "input": "w1",
        "output": "w2",
        "sets": {"D": sets["D"]},
        "elements": {"F1": ["w2", "w1"], "F2": ["w3", "housing"]},
        "gears": {"low": ["F2"], "high": ["F1"]},
    }
    base = {
        "name": "base",
        "input": "w4",
        "output": "w8",
        "sets": {name: sets[name] for name in ("B1", "B2", "B3")},
        "elements": {"F3": ["w8", "w4"], "F4": ["w5", "housing"], "F5": ["w7", "housing"], "F6": ["w6", "housing"]},
        "gears": {"1": ["F6"], "2": ["F4"], "3": ["F3"], "R": ["F5"]},
    }
    d = cw.Driveline("six speeds")
    w = {node.name: d.add_node(node) for node in reference.nodes if node.name in ("w1", "w2", "w4", "w8")}
    for box, ends in ((divider, ("w1", "w2")), (base, ("w4", "w8"))):
        fields = ("gain", "pressure", "friction")
        shift = {name: {field: getattr(old[name], field) for field in fields} for name in box["elements"]}
        inner = {name: INERTIA[name] for name in ("w3", "w5", "w6", "w7") if name in str(box["sets"])}
        ports = {"input": w[ends[0]], "output": w[ends[1]]}
        d.add(cw.Transmission(box["name"], gearbox=box, **ports, inertia=0.0, inertias=inner, shift=shift))
    d.add(cw.SpringDamper("shaft", base=w["w2"], follower=w["w4"], stiffness=STIFFNESS, damping=DAMPING))
    d.add(old["engine"])
    d.add(old["load"])
    return reference, d


def test_the_six_speed_reference_is_the_same_as_two_gearboxes():
    """Two forms of one motion, at tolerances three orders below what is asked of both."""
    reference, d = six_speed()
    options = {"dt": 0.01, "rtol": 1e-12, "atol": 1e-12}
    one, two = reference.simulate(4.0, **options), d.simulate(4.0, **options)
    for name in ("w1", "w2", "w4", "w8"):
        assert two[f"{name}.speed"] == pytest.approx(one[f"{name}.speed"], abs=CLOSE * 205.0)
    for name, box in {"w3": "divider", "w5": "base", "w6": "base", "w7": "base"}.items():
        assert two[f"{box}.{name}.speed"] == pytest.approx(one[f"{name}.speed"], abs=CLOSE * 500.0)
    assert [event.time for event in two.events] == pytest.approx([event.time for event in one.events], abs=CLOSE)
    assert two.gears("divider").sequence == ("low", "high")
    assert two.gears("base").sequence == ("2",)
