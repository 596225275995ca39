"""States that begin with their command begin with what it is where a run begins, also later than at 0 s."""

from __future__ import annotations

import numpy as np
import pytest

import clutchwork as cw
from clutchwork.declare.node import Component
from clutchwork.declare.registry import REGISTRY
from clutchwork.declare.schema import Role


def following(kind: str, command: object, **given: object) -> tuple[cw.Driveline, str]:
    """A process whose first state follows a command, and the name of that state."""
    d = cw.Driveline("following")
    a, b = d.shaft("a", inertia=1.0, speed=10.0), d.shaft("b", inertia=1.0)
    if kind == "RatioActuator":
        ratio = d.add(cw.RatioActuator("x", command=command, lag=0.1, **given))
        d.add(cw.VariableRatio("cvt", input=a, output=b, ratio=ratio))
        return d, "x.ratio"
    volume = d.add(cw.OilVolume("volume", volume=1e-4, initial_pressure=1.0))
    if kind == "ReliefValve":
        d.add(cw.ReliefValve("x", inlet=volume, command=command, area=4e-5, **given))
        return d, "x.setting"
    areas = {"supply_area": 2e-5, "exhaust_area": 2e-5}
    d.add(cw.SpoolValve("x", supply=1e6, clutch=volume, command=command, **areas, **given))
    return d, "x.pilot"


FOLLOWING = {"RatioActuator": "initial_ratio", "ReliefValve": "initial_setting", "SpoolValve": "initial_pilot"}


@pytest.mark.parametrize("kind", sorted(FOLLOWING))
def test_what_begins_with_its_command_does_so_at_a_later_start(kind: str) -> None:
    """A command that has been constant since before the start moves nothing."""
    for command in (cw.Ramp(offset=1.0, height=2.0, duration=2.0), cw.Step(offset=1.0, height=1.0, start=0.5)):
        d, state = following(kind, command)
        assert d.simulate(1.5, t_start=1.0)[state][0] == pytest.approx(2.0, rel=1e-12)
        assert d.simulate(1.5)[state][0] == 1.0
        # what is given is that of any start
        given, _ = following(kind, command, **{FOLLOWING[kind]: 1.5})
        assert given.simulate(1.5, t_start=1.0)[state][0] == 1.5
        # a sweep from the one to the other takes what is given
        swept = cw.sweep(
            d, 1.1, vary={f"x.{FOLLOWING[kind]}": [1.5]}, outputs={"begin": cw.at(state, [1.0])}, t_start=1.0
        )
        assert np.ravel(swept["begin"]) == pytest.approx(1.5)


def test_the_derivative_of_what_begins_with_its_command() -> None:
    """A lag of 0.1 s behind a ramp of 1 1/s that begins with it."""
    d, state = following("RatioActuator", cw.Ramp(offset=1.0, height=2.0, duration=2.0))
    found = cw.differentiable(d, 1.2, of=state, by=["x.command.offset", "x.command.height"], t_start=1.0).gradient()
    # ratio = offset + height (t - 0.1 + 0.1 exp(-(t - 1)/0.1)) / 2
    lag = (1.2 - 0.1 + 0.1 * np.exp(-2.0)) / 2.0
    np.testing.assert_allclose(found.matrix, [[1.0, lag]], rtol=1e-6)


def test_a_drive_whose_command_is_constant_since_before_the_start_rests_there() -> None:
    d, _ = following("RatioActuator", cw.Step(offset=1.0, height=1.0, start=0.5))
    run = d.simulate(1.5, t_start=1.0)
    assert np.abs(run["cvt.torque"]).max() == 0.0
    assert (run["a.speed"][0], run["b.speed"][0]) == (10.0, 5.0)


def test_all_that_begin_with_a_command_are_known() -> None:
    kinds = {one.__name__ for one in REGISTRY[Role.PROCESS].values() if one.begins_with is not Component.begins_with}
    assert kinds == set(FOLLOWING)


@pytest.mark.parametrize("order", [1, -1])
def test_a_command_may_begin_with_a_command_itself(order: int) -> None:
    """Whatever stands first."""
    d = cw.Driveline("chain")
    a, b = d.shaft("a", inertia=1.0, speed=10.0), d.shaft("b", inertia=1.0)
    second = cw.RatioActuator("second", command=cw.Ramp(offset=1.0, height=2.0, duration=2.0), lag=0.1)
    first = cw.RatioActuator("first", command=second, lag=0.1)
    for one in (first, second)[::order]:
        d.add(one)
    d.add(cw.VariableRatio("cvt", input=a, output=b, ratio=first))
    run = d.simulate(1.5, t_start=1.0)
    assert (run["first.ratio"][0], run["second.ratio"][0]) == pytest.approx((2.0, 2.0))
