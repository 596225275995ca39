"""Every kind of guard carries what it changes into the derivatives, or is refused: docs/theory/gradients.md (3) to (5).

The kinds are those of the core (run/hit.hpp): a new one without a driveline here fails.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable

import numpy as np
import pytest

import clutchwork as cw
from clutchwork.declare.core import derivatives
from clutchwork.gradients.grazing import KIND
from clutchwork.gradients.runs import Runs
from support import by_differences
from support.amount import amount

GUARDS: tuple[str, ...] = tuple(name for name, _ in derivatives().guards)
# one that touches no motion, and one that ends the run
WITHOUT = {"bend", "exit"}
COULOMB = cw.Coulomb(static=0.12, kinetic=0.1)
TIGHT = {"rtol": 1e-12, "atol": 1e-14}
Model = tuple[cw.Driveline, tuple[str, ...], float]


def line(draw: np.random.Generator) -> Model:
    """A clutch locks."""
    d = cw.Driveline("line")
    a, b = d.shaft("a", inertia=draw.uniform(0.2, 0.6), speed=draw.uniform(20.0, 60.0)), d.shaft("b", inertia=0.8)
    d.add(cw.Clutch("c", base=a, follower=b, friction=COULOMB, gain=5e-4, pressure=draw.uniform(4e5, 8e5)))
    d.add(cw.ResistingTorque("r", shaft=b, torque=3.0, speed=1.0))
    return d, ("a.inertia", "c.pressure"), 2.0


def multiplier(draw: np.random.Generator) -> Model:
    """A brake gives way to a torque that grows, or that jumps."""
    d = cw.Driveline("multiplier")
    a = d.shaft("a", inertia=draw.uniform(0.2, 0.6))
    d.add(cw.Brake("b", shaft=a, friction=COULOMB, gain=5e-4, pressure=2e5))
    ramp, jump = cw.Table([(0.0, 0.0), (1.0, draw.uniform(20.0, 40.0))]), cw.Step(height=20.0, start=0.2)
    jumps = draw.random() < 0.4
    d.add(cw.Torque("t", shaft=a, torque=jump if jumps else ramp))
    return d, ("b.pressure", "t.torque.start" if jumps else "t.torque.values[1]"), 0.9


def parallel(draw: np.random.Generator) -> Model:
    """Two brakes beside each other give way together."""
    d = cw.Driveline("set")
    s, u = d.shaft("s", inertia=draw.uniform(0.3, 0.7)), d.shaft("u", inertia=1.0)
    d.add(cw.Gear("g", input=s, output=u, ratio=draw.uniform(2.0, 4.0)))
    for name, shaft, pressure in (("b1", s, 2e5), ("b2", u, 4e5)):
        d.add(cw.Brake(name, shaft=shaft, friction=COULOMB, gain=5e-4, pressure=pressure * draw.uniform(0.8, 1.2)))
    d.add(cw.Torque("t", shaft=s, torque=cw.Table([(0.0, 0.0), (0.5, 60.0), (1.0, 60.0)])))
    return d, ("b1.pressure", "b2.gain", "t.torque.values[1]"), 0.8


def parting(draw: np.random.Generator) -> Model:
    """Prescribed speeds part what two clutches hold together."""
    d = cw.Driveline("parting")
    a, b = d.shaft("a", inertia=0.3), d.shaft("b", inertia=0.5, speed=10.0)
    d.add(cw.PrescribedSpeed("pa", shaft=a, speed=10.0))
    rate = cw.Table([(0.0, 0.0), (0.3, 0.0), (1.0, draw.uniform(20.0, 60.0))])
    d.add(cw.PrescribedAcceleration("pb", shaft=b, acceleration=rate))
    m = d.shaft("m", inertia=draw.uniform(0.1, 0.3), speed=10.0)
    for name, x, y in (("c1", a, m), ("c2", m, b)):
        d.add(cw.Clutch(name, base=x, follower=y, friction=COULOMB, gain=5e-4, pressure=2e5, locked=True))
    return d, ("m.inertia",), 0.8


def load(draw: np.random.Generator) -> Model:
    """A brake is lifted and pressed again."""
    d = cw.Driveline("load")
    a = d.shaft("a", inertia=draw.uniform(0.2, 0.6), speed=80.0)
    force = cw.Sine(amplitude=300.0, frequency=draw.uniform(1.0, 3.0), offset=draw.uniform(-100.0, 100.0))
    d.add(cw.Brake("b", shaft=a, friction=COULOMB, gain=0.1, normal_force=force))
    return d, ("b.normal_force.frequency", "b.normal_force.offset"), 0.9


def law(draw: np.random.Generator) -> Model:
    """An elastic play is crossed, and a dry element turns round."""
    d = cw.Driveline("law")
    a, b = d.shaft("a", inertia=0.3, speed=draw.uniform(2.0, 6.0)), d.shaft("b", inertia=0.8)
    d.add(cw.ElasticBacklash("k", base=a, follower=b, stiffness=draw.uniform(400, 900), damping=1.0, gap=0.1))
    return d, ("a.inertia", "k.gap", "k.stiffness"), 0.6


def fault(draw: np.random.Generator) -> Model:
    """A clutch fails."""
    d = cw.Driveline("fault")
    a, b = d.shaft("a", inertia=draw.uniform(0.2, 0.6), speed=80.0), d.shaft("b", inertia=0.8)
    signal = cw.Sine(amplitude=1.0, frequency=draw.uniform(0.3, 0.6))
    fails = {"fault": "cannot_transmit", "fault_signal": signal, "report": "none"}
    d.add(cw.PlateContact("c", base=a, follower=b, friction=COULOMB, gain=5e-4, pressure=2e5, **fails))
    return d, ("c.fault_signal.frequency", "a.inertia"), 0.7


def process(draw: np.random.Generator) -> Model:
    """A piston fills, touches the plates and is let go by a pressure that jumps."""
    d = cw.Driveline("process")
    a = d.shaft("a", inertia=draw.uniform(0.2, 0.6), speed=100.0)
    supply = cw.Table([(0.0, 0.0), (0.02, 8e5), (0.35, 8e5), (0.35, 1e5), (0.6, 1e5)])
    piston = cw.ClutchActuator(
        "p",
        supply_pressure=supply,
        orifice_area=4e-6,
        piston_area=6e-3,
        preload=400.0,
        spring_rate=1.5e5,
        kiss_stroke=2e-3,
        contact_rate=1e7,
    )
    d.add(piston)
    d.add(cw.Brake("b", shaft=a, friction=COULOMB, gain=5e-5, normal_force=piston))
    return d, ("p.orifice_area", "p.kiss_stroke"), 0.5


def flip(draw: np.random.Generator) -> Model:
    """The load of a gear with losses changes its sign, smoothly or in a jump."""
    d = cw.Driveline("flip")
    e, w = d.shaft("e", inertia=draw.uniform(0.1, 0.4), speed=100.0), d.shaft("w", inertia=2.0)
    d.add(cw.LossyGear("g", input=e, output=w, ratio=3.0, efficiency=0.95, backward_efficiency=draw.uniform(0.6, 0.9)))
    jumps, low = draw.random() < 0.7, -draw.uniform(60.0, 120.0)
    slow = cw.Table([(0.0, 60.0), (1.0, 60.0 + low)])
    d.add(cw.Torque("t", shaft=e, torque=cw.Step(height=low, start=0.5, offset=60.0) if jumps else slow))
    d.add(cw.QuadraticTorque("drag", shaft=w, nominal_torque=-30.0, nominal_speed=40.0))
    return d, ("e.inertia", "t.torque.start" if jumps else "t.torque.values[1]", "g.efficiency"), 1.0


def gap(draw: np.random.Generator) -> Model:
    """A play is crossed and bounces."""
    d = cw.Driveline("gap")
    a, b = d.shaft("a", inertia=0.3, speed=draw.uniform(2.0, 6.0)), d.shaft("b", inertia=0.8)
    d.add(cw.Backlash("k", base=a, follower=b, gap=0.1, restitution=0.6))
    d.add(cw.Damper("r", base=b, follower=d.housing, damping=0.2))
    return d, ("a.inertia", "k.gap", "k.restitution"), 0.15


MODELS: dict[str, Callable[[np.random.Generator], Model]] = {
    "set": parallel,
    **{made.__name__: made for made in (line, multiplier, parting, load, law, fault, process, flip, gap)},
}
# what prescribed speeds part leaves them without a slope, so that it grazes
MAY_BE_REFUSED = {"parting"}


def test_every_guard_of_the_core_has_a_driveline() -> None:
    assert set(MODELS) | WITHOUT == set(GUARDS)


@pytest.mark.random
@pytest.mark.parametrize("kind", sorted(MODELS))
@pytest.mark.filterwarnings("ignore::clutchwork.FaultWarning", "ignore::clutchwork.ModelWarning")
def test_derivatives_through_every_guard_are_those_of_differences(kind: str) -> None:
    met = refused = 0
    for seed in range(max(4, amount(4))):
        # a seed may meet the guard or not
        if met and seed >= amount(4):
            break
        driveline, numbers, t_end = MODELS[kind](np.random.default_rng(seed))
        system = driveline.assemble()
        speeds = [f"{node.name}.speed" for node in system.nodes if not node.fixed]
        function = cw.differentiable(system, t_end, of=speeds, by=list(numbers), **TIGHT)
        runs = Runs(function.task)
        grazes = runs.forward(runs.point(function.x0)).primal.grazes
        met += int(np.any(grazes[:, KIND] == GUARDS.index(kind)))
        try:
            matrix = function.gradient().matrix
        except cw.NoGradient:
            assert kind in MAY_BE_REFUSED
            refused += 1
            continue
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", cw.StoppedEarly)
            scales = by_differences.scales(cw.simulate(system, t_end, rtol=1e-8), function.task.outputs)
        for one in by_differences.compared(function, matrix, scales):
            assert np.all(one.missed < np.maximum(1e-6, 100 * one.doubt)), f"seed {seed}: {one}"
    assert met > 0


@pytest.mark.random
def test_derivatives_by_a_dog_clutch_whose_flanks_part_are_those_of_differences() -> None:
    for seed in range(amount(6)):
        draw = np.random.default_rng(seed)
        d = cw.Driveline("dog")
        a, b = d.shaft("a", inertia=draw.uniform(0.05, 0.5), speed=15.0), d.shaft("b", inertia=0.8, speed=15.0)
        stiffness, damping = 10 ** draw.uniform(1.0, 4.0), 10 ** draw.uniform(-1.0, 0.5)
        teeth = {"teeth": int(draw.integers(3, 9)), "gap": draw.uniform(0.02, 0.3), "engaged": True, "command": 1.0}
        d.add(cw.DogClutch("d", base=a, follower=b, stiffness=stiffness, damping=damping, **teeth))
        d.add(cw.Torque("t", shaft=a, torque=cw.Sine(amplitude=draw.uniform(1.0, 10.0), frequency=3.0)))
        d.add(cw.ResistingTorque("r", shaft=b, torque=3.0, speed=1.0))
        function = cw.differentiable(d, 0.7, of=["a.speed", "b.speed"], by="d.gap", **TIGHT)
        for one in by_differences.compared(function, function.gradient().matrix, np.array([15.0, 15.0])):
            assert np.all(one.missed < np.maximum(1e-6, 100 * one.doubt)), f"seed {seed}: {one}"


@pytest.mark.parametrize("limits", [(0.0, 1.0), (0.0, 0.0)])
@pytest.mark.parametrize("phase", [0.3, 2.0])
def test_a_kinetic_torque_that_passes_zero_opens_and_closes_a_clutch(limits: tuple[float, float], phase: float) -> None:
    """Below zero the load of the clutch is a trace: the rate there is not that of both sides."""
    size, frequency = 0.168, 13.56
    d = cw.Driveline("passes")
    s = d.shaft("s", inertia=1.0)
    wave = cw.Sine(amplitude=size, frequency=frequency, phase=phase)
    d.add(cw.FundamentalClutch("c", base=d.housing, follower=s, kinetic=wave, upper=limits[0], lower=limits[1]))
    function = cw.differentiable(d, 0.2, of=cw.break_away("c"), by=["c.kinetic.offset", "c.kinetic.phase"], **TIGHT)
    omega = 2 * np.pi * frequency
    opens = (np.pi - phase) / omega
    found = function.gradient()
    assert found.values[0] == pytest.approx(opens, rel=1e-12)
    assert found.matrix[0] == pytest.approx([1 / (size * omega), -1 / omega], rel=1e-8)
