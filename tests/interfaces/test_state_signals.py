"""Signals that follow from states and powers: what the elements say of them, in runs, sweeps and gradients."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import clutchwork as cw

TIGHT = {"rtol": 1e-10, "atol": 1e-12}


def axle() -> cw.Driveline:
    """A motor that drives a car by a shaft that twists, and a tyre."""
    d = cw.Driveline("axle")
    rotor, hub, wheel = d.shaft("rotor", inertia=0.05), d.shaft("hub", inertia=0.2), d.shaft("wheel", inertia=1.0)
    car = d.mass("car", mass=400.0, speed=5.0)
    losses: dict[str, Any] = {"no_load_loss": 30.0, "drag_loss": 0.2, "iron_loss": 1e-3, "copper_loss": 0.05}
    torque = cw.Ramp(height=80.0, duration=0.2)
    d.add(cw.ElectricMotor("motor", shaft=rotor, max_torque=((0.0, 120.0), (300.0, 60.0)), command=torque, **losses))
    d.add(
        cw.FlexibleShaft("long", base=rotor, follower=hub, stiffness=2e3, inertia=0.02, segments=3, damping_time=1e-4)
    )
    d.add(cw.FlexibleShaft("modal", base=hub, follower=wheel, stiffness=3e3, inertia=0.02, modes=3, damping_time=1e-4))
    d.add(cw.Tyre("tyre", shaft=wheel, mass=car, radius=0.3, load=3000.0, low_speed_damping=500.0))
    return d


def test_the_loss_of_a_motor_is_its_polynomial() -> None:
    run = axle().simulate(0.6, **TIGHT)
    w, torque = np.abs(run["motor.rate"]), run["motor.torque"]
    wanted = 30.0 + 0.2 * w + 1e-3 * w**2 + 0.05 * torque**2
    np.testing.assert_allclose(run["motor.loss"], wanted, rtol=1e-12)
    np.testing.assert_allclose(run["motor.electric_power"], run["motor.power"] + run["motor.loss"], rtol=1e-12)
    assert run.units["motor.loss"] == "W"


def test_the_twist_of_a_shaft_is_the_difference_of_its_angles() -> None:
    run = axle().simulate(0.6, **TIGHT)
    for name, base, follower in (("long", "rotor", "hub"), ("modal", "hub", "wheel")):
        wanted = run[f"{follower}.angle"] - run[f"{base}.angle"]
        # both are integrals, which have the error of the run
        np.testing.assert_allclose(run[f"{name}.twist"], wanted, atol=1e-7 * np.abs(wanted).max())
        assert run.units[f"{name}.twist"] == "rad"
    d = cw.Driveline("rod")
    cart = d.mass("cart", mass=2.0)
    d.add(cw.FlexibleShaft("rod", base=d.housing, follower=cart, stiffness=500.0, inertia=0.1, segments=2))
    d.add(cw.Torque("push", shaft=cart, torque=10.0))
    run = d.simulate(0.3, **TIGHT)
    np.testing.assert_allclose(run["rod.twist"], run["cart.position"], atol=1e-9)
    assert run.units["rod.twist"] == "m"


def test_the_slip_of_a_tyre_settles_at_the_ratio_of_its_speeds() -> None:
    d = cw.Driveline("tyre")
    wheel, car = d.shaft("wheel", inertia=1.0), d.mass("car", mass=400.0, speed=20.0)
    d.add(cw.PrescribedSpeed("drum", shaft=wheel, speed=20.0 * 1.03 / 0.3))
    d.add(cw.PrescribedSpeed("tow", shaft=car, speed=20.0))
    d.add(cw.Tyre("tyre", shaft=wheel, mass=car, radius=0.3, load=3000.0, low_speed_damping=500.0))
    run = d.simulate(1.0, **TIGHT)
    # eighty relaxation lengths later
    assert run["tyre.slip"][-1] == pytest.approx(0.03, rel=1e-9)
    assert run["tyre.torque"][-1] == pytest.approx(magic(0.03, 3000.0), rel=1e-9)
    assert run.units["tyre.slip"] == "1"


def magic(x: float, load: float) -> float:
    """The Magic Formula with the numbers that a tyre has by default."""
    b = 10.0 * x
    return load * np.sin(1.65 * np.arctan(b - 0.3 * (b - np.arctan(b))))


def piston() -> cw.Driveline:
    """A brake whose piston fills and presses."""
    d = cw.Driveline("piston")
    disc = d.shaft("disc", inertia=1.0, speed=50.0)
    made = cw.ClutchActuator(
        "piston", supply_pressure=8e5, orifice_area=4e-6, piston_area=6e-3, preload=400.0, spring_rate=1.5e5,
        kiss_stroke=2e-3, contact_rate=5e6,
    )  # fmt: skip
    d.add(made)
    law = cw.Coulomb(static=0.13, kinetic=0.12)
    d.add(cw.Brake("brake", shaft=disc, friction=law, gain=0.1, normal_force=made))
    return d


def test_the_stroke_of_a_piston_balances_its_springs() -> None:
    run = piston().simulate(0.5, **TIGHT)
    stroke = run["piston.stroke"]
    force = 400.0 + 1.5e5 * stroke + 5e6 * np.maximum(stroke - 2e-3, 0.0)
    moving = stroke > 1e-9
    np.testing.assert_allclose(run["piston.pressure"][moving] * 6e-3, force[moving], rtol=1e-6)
    assert abs(stroke[0]) < 1e-12
    assert stroke[-1] > 2e-3
    assert run.units["piston.stroke"] == "m"


@pytest.mark.parametrize(
    ("model", "signal", "by"),
    [
        (axle, "motor.loss", "motor.copper_loss"),
        (axle, "long.twist", "long.stiffness"),
        (axle, "modal.twist", "car.mass"),
        (axle, "tyre.slip", "tyre.relaxation_length"),
        (piston, "piston.stroke", "piston.contact_rate"),
    ],
)
def test_sweeps_and_gradients_know_them(model: Any, signal: str, by: str) -> None:
    system, end, step = model().assemble(), 0.3, 1e-4
    vary = {by: cw.times(1.0 - step, 1.0, 1.0 + step)}
    found = cw.sweep(system, end, vary=vary, outputs=[signal, cw.peak(signal)], **TIGHT)
    for number in range(3):
        assert found[signal][number] == found.run(number)[signal][-1]
    low, _, high = found[signal].tolist()
    gradient = cw.simulate(system, end, **TIGHT).gradient(of=signal, by=by)
    size = found.variant(1)[by]
    # the difference has an error of the step squared, and of the run over the step
    assert gradient.matrix[0, 0] == pytest.approx((high - low) / (2.0 * step * size), rel=1e-5)
