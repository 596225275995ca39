"""A `Transmission` in every gear of every gearbox does what its statics say, and keeps its energy."""

import math

import pytest

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
            # flanks give, which the test below looks at
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
