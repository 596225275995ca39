"""Torques, powers and losses of gears against closed forms and balances."""

from __future__ import annotations

from itertools import pairwise
from math import isnan

import pytest

import clutchwork as cw
from clutchwork.gearbox.definition import HOUSING
from support.gearboxes import EIGHT_SPEED, REDUCTION, changed

# exact fractions that are turned into floats
ROUND_OFF = 1e-12


def test_a_single_set_by_hand() -> None:
    """Sun drives, ring held: ratio 1 + zr/zs, the ring has zr/zs of the torque, backwards."""
    state = cw.Gearbox.from_dict(REDUCTION).state("1")
    assert state.ratio == pytest.approx(10 / 3, rel=ROUND_OFF)
    assert state.torques["B"] == pytest.approx(7 / 3, rel=ROUND_OFF)
    assert state.load == pytest.approx(-10 / 3, rel=ROUND_OFF)
    assert state.housing == pytest.approx(-7 / 3, rel=ROUND_OFF)
    assert state.slips["K"] == pytest.approx(3 / 10 - 1, rel=ROUND_OFF)


@pytest.mark.parametrize("efficiency", [0.99, 0.9, 0.5])
def test_losses_of_a_single_set(efficiency: float) -> None:
    """The textbook: of the power (1 + i0 eta)/(1 + i0) gets from the sun to the carrier, i0 = zr/zs."""
    data = changed(REDUCTION, sets__P__efficiency=efficiency)
    ratio = 70 / 30
    state = cw.Gearbox.from_dict(data).state("1")
    assert state.efficiency == pytest.approx((1 + ratio * efficiency) / (1 + ratio), rel=ROUND_OFF)
    # from the carrier to the sun: (1 + i0)/(1 + i0/eta)
    back = cw.Gearbox.from_dict(changed(data, input="carrier", output="sun")).state("1")
    assert back.efficiency == pytest.approx((1 + ratio) / (1 + ratio / efficiency), rel=ROUND_OFF)
    # the block turns without losses
    assert cw.Gearbox.from_dict(data).state("2").efficiency == pytest.approx(1.0, rel=ROUND_OFF)


def test_a_set_that_locks_itself_drives_nothing() -> None:
    """A carrier that drives stepped planets at two rings of almost the same size: backwards it holds itself."""
    data = {
        "name": "wolfrom",
        "input": "ring",
        "output": "carrier",
        "sets": {
            "P": {
                "type": "two_rings",
                "ring": "ring",
                "second_ring": "held",
                "carrier": "carrier",
                "teeth_ring": 99,
                "teeth_planet_ring": 30,
                "teeth_second_ring": 96,
                "teeth_planet_second_ring": 30,
                "efficiency": 0.9,
            }
        },
        "elements": {"B": ["held", "housing"]},
        "gears": {"1": ["B"]},
    }
    forwards = cw.Gearbox.from_dict({**data, "input": "carrier", "output": "ring"}).state("1")
    # i = 1/(1 - 96/99) = 33; the planets carry 32 times the power of the output
    assert forwards.ratio == pytest.approx(33.0, rel=ROUND_OFF)
    assert 0.0 < forwards.efficiency < 0.5
    assert cw.Gearbox.from_dict(data).state("1").efficiency == 0.0


@pytest.mark.parametrize("gear", [str(n) for n in range(1, 9)] + ["R"])
def test_balances_of_every_gear(gear: str) -> None:
    box = cw.Gearbox.from_dict(EIGHT_SPEED)
    state = box.state(gear)
    torque = dict.fromkeys(box.members, 0.0) | {HOUSING: 0.0}
    for one in box.sets:
        ports = state.set_torques[one.name]
        assert sum(ports.values()) == pytest.approx(0.0, abs=ROUND_OFF)
        assert sum(state.set_powers[one.name].values()) == pytest.approx(0.0, abs=ROUND_OFF)
        for port, value in ports.items():
            torque[one.members[port]] += value
    for name, value in state.torques.items():
        torque[box.element(name).follower] += value
        torque[box.element(name).base] -= value
    torque["in"] += 1.0
    torque["out"] += state.load
    assert torque.pop(HOUSING) == pytest.approx(state.housing, abs=ROUND_OFF)
    assert max(map(abs, torque.values())) < ROUND_OFF
    assert 1.0 + state.load * state.speeds["out"] == pytest.approx(0.0, abs=ROUND_OFF)


def test_swaps_and_steps() -> None:
    box = cw.Gearbox.from_dict(EIGHT_SPEED)
    swaps = {(one.before, one.after): one for one in box.swaps()}
    assert len(swaps) == 9 * 8
    gears = [str(n) for n in range(1, 9)]
    # every shift to a neighbour exchanges one element, and so do those over one gear and some longer ones
    assert all(swaps[pair].kind == swaps[pair[::-1]].kind == "single" for pair in pairwise(gears))
    assert (swaps["8", "4"].opens, swaps["8", "4"].closes) == (("A",), ("B",))
    assert swaps["6", "2"].kind == "double"
    assert swaps["1", "2"].step == pytest.approx(4.7143 / 3.1429, abs=1e-4)


def test_capacities_are_the_largest_torques() -> None:
    box = cw.Gearbox.from_dict(EIGHT_SPEED)
    found, states = box.capacities(), box.states()
    assert found["B"].gear == "R"
    assert found["B"].torque == max(abs(one.torques.get("B", 0.0)) for one in states.values())
    assert found["E"].slip == max(abs(one.slips.get("E", 0.0)) for one in states.values())
    assert found["A"].gears == ("1", "2", "7", "8", "R")


def test_elements_that_share_a_torque_are_told() -> None:
    """Two brakes on one member: nothing says which of them holds."""
    data = changed(REDUCTION, elements__B2=["ring", "housing"])
    state = cw.Gearbox.from_dict(data).state(("B", "B2"))
    assert isnan(state.torques["B"])
    assert isnan(state.torques["B2"])
    assert state.load == pytest.approx(-10 / 3, rel=ROUND_OFF)


def test_questions_that_have_no_answer() -> None:
    box = cw.Gearbox.from_dict(EIGHT_SPEED)
    with pytest.raises(cw.UseError, match="'9' is not a gear"):
        box.state("9")
    with pytest.raises(cw.UseError, match="closed make neutral, not a gear"):
        box.state(("A", "B"))
    with pytest.raises(cw.UseError, match="'Z' is not an element"):
        box.state(("A", "Z"))


def test_tables_name_everything() -> None:
    box = cw.Gearbox.from_dict(EIGHT_SPEED)
    text = str(box)
    for name in (*box.members, *box.gears, *(element.name for element in box.elements), "4.7143", "tie-up"):
        assert name in text
    # all combinations, none left out
    assert sum(1 for _ in box.combinations()) == 2**5


def test_elements_that_share_a_torque_must_each_hold_it() -> None:
    second = {"members": ["ring", "housing"]}
    box = cw.Gearbox.from_dict(changed(REDUCTION, elements__B2=second, gears__1=["B", "B2"]))
    alone = cw.Gearbox.from_dict(REDUCTION).capacities()["B"].torque
    assert isnan(box.state("1").torques["B"])
    assert [box.capacities()[name].torque for name in ("B", "B2")] == [pytest.approx(alone)] * 2
