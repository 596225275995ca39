"""Several elements at once: statics against those of the gears, motion against all members, the single exchange."""

from __future__ import annotations

from itertools import permutations

import numpy as np
import pytest

import clutchwork as cw
from clutchwork.gearbox.gear_set import HOUSING
from clutchwork.shifts.exchange import exchanges
from clutchwork.shifts.handover import Handover, allocation, handover, is_straight
from clutchwork.shifts.plans import plan
from support.amount import amount
from support.shift_car import FINAL_DRIVE, SENSED, car

BOXES = {name: cw.Gearbox.load(name) for name in ("zf-8hp70", "ford-10r80", "six-speed", "mb-9g-v1", "toyota-a760e")}


def inertias(box: cw.Gearbox, seed: int = 0) -> dict[str, float]:
    """Some inertia of each member but the output."""
    rng = np.random.default_rng([77, seed])
    return {member: float(rng.uniform(0.002, 0.1)) for member in box.members if member != box.output}


def between(box: cw.Gearbox, before: str, after: str, sizes: dict[str, float]) -> Handover | None:
    old, new = box.closed_in(before), box.closed_in(after)
    off, on = [n for n in old if n not in new], [n for n in new if n not in old]
    return handover(box, off, on, [n for n in new if n in old], sizes)


def all_of(box: cw.Gearbox) -> list[tuple[str, str, Handover]]:
    forward = [gear for gear, ratio in box.ratios.items() if ratio > 0.0]
    found = [(a, b, between(box, a, b, inertias(box))) for a, b in permutations(forward, 2)]
    return [(a, b, one) for a, b, one in found if one is not None]


@pytest.mark.parametrize("name", BOXES)
def test_both_gears_are_rests_of_the_motion(name: str) -> None:
    """docs/theory/shifts.md (13): their torques balance the input's; slips are those that the box has in its gears."""
    box = BOXES[name]
    found = all_of(box)
    assert len(found) > 25
    for before, after, one in found:
        # fractions as floats
        assert [-value for value in one.input] == pytest.approx([one.on_torques[n] for n in one.on], abs=1e-12)
        held = sum(one.rates[n] * one.off_torques[n] for n in one.off)
        assert held == pytest.approx(-one.input, abs=1e-12)
        old, new = box.state(before), box.state(after)
        y = np.array([old.slips[n] * old.ratio for n in one.on])
        for element in one.off:
            assert float(one.rates[element] @ y) + one.offsets[element] == pytest.approx(0.0, abs=1e-12)
            assert one.offsets[element] == pytest.approx(new.slips[element] * new.ratio, abs=1e-12)
        assert float(one.input @ y) + new.ratio == pytest.approx(old.ratio, abs=1e-12)


@pytest.mark.parametrize("name", BOXES)
def test_inertia_is_that_of_all_members(name: str) -> None:
    """Kinetic energy of random slips and a random speed of the output, member by member from the box's own rows."""
    box = BOXES[name]
    sizes = inertias(box)
    for _, after, one in all_of(box):
        rng = np.random.default_rng([78, len(after)])
        y, output = rng.normal(size=len(one.on)), float(rng.normal())
        # rows of sets, kept elements, the slips and the output: solved for all members at once
        members = list(box.members)
        rows, right = [], []
        for row in [row for of in box.sets for row in of.rows()]:
            rows.append([float(row.get(m, 0)) for m in members])
            right.append(0.0)
        for element, slip in [(n, 0.0) for n in one.kept] + list(zip(one.on, y.tolist(), strict=True)):
            row = box.element(element).row()
            rows.append([float(row.get(m, 0)) for m in members])
            right.append(slip)
        rows.append([float(m == box.output) for m in members])
        right.append(output)
        turning = dict(zip(members, np.linalg.lstsq(np.array(rows), np.array(right), rcond=None)[0], strict=True))
        turning[HOUSING] = 0.0
        energy = 0.5 * sum(size * turning[m] ** 2 for m, size in sizes.items())
        new = box.state(after)
        alone = 0.5 * sum(size * (new.speeds[m] * new.ratio * output) ** 2 for m, size in sizes.items())
        wanted = 0.5 * y @ one.inertia @ y + float(y @ one.coupling) * output + alone
        assert energy == pytest.approx(wanted, rel=1e-9)
        for element, rate in one.rates.items():
            of = box.element(element)
            slip = turning[of.follower] - turning[of.base]
            assert slip == pytest.approx(float(rate @ y) + one.offsets[element] * output, abs=1e-9)


@pytest.mark.parametrize("name", BOXES)
def test_one_element_each_is_the_exchange(name: str) -> None:
    """Inertia at the input and torques, docs/theory/shifts.md (1) to (3)."""
    box = BOXES[name]
    sizes, count = inertias(box), 0
    for before, after, one in all_of(box):
        if len(one.on) == len(one.off) == 1:
            (single,) = exchanges(box, box.closed_in(before), box.closed_in(after), sizes)
            assert (single.off, single.on) == (one.off[0], one.on[0])
            assert one.inertia[0, 0] / one.input[0] ** 2 == pytest.approx(single.inertia, rel=1e-12)
            assert one.on_torques[single.on] == single.on_torque
            assert one.off_torques[single.off] == single.off_torque
            count += 1
    assert count >= 10


@pytest.mark.random
def test_allocation_is_the_cheapest_that_does() -> None:
    """Against a fine search over all torques that are not below zero, two equations and four elements."""
    for seed in range(amount(40)):
        rng = np.random.default_rng([79, seed])
        pulls = {name: rng.normal(size=2) for name in "ABCD"}
        costs = {name: float(rng.uniform(0.1, 3.0)) for name in "ABCD"}
        wanted, root = rng.normal(size=2), rng.normal(size=(2, 2))
        weight = root @ root.T + 0.1 * np.eye(2)
        found, missed = allocation(wanted, pulls, costs, weight)
        made = sum(found[n] * pulls[n] for n in pulls)
        assert min(found.values()) >= 0.0
        # any direction: what is missed cannot be made smaller by one element more (conditions of Karush, Kuhn, Tucker)
        left = np.linalg.solve(weight, wanted - made)
        for name, pull in pulls.items():
            # round-off of the least squares
            assert float(pull @ left) <= 1e-9
            assert found[name] == 0.0 or abs(float(pull @ left)) < 1e-9
        if missed < 1e-12:
            # prices of both equations, with which no element could be cheaper: duality of linear programs
            used = [n for n in pulls if found[n] > 1e-12]
            cost = sum(costs[n] * found[n] for n in used)
            for two in permutations("ABCD", 2):
                columns = np.array([pulls[n] for n in two]).T
                other = np.linalg.solve(columns, wanted)
                if np.all(other >= 0.0):
                    assert cost <= float(other @ [costs[n] for n in two]) + 1e-9


def test_ways_that_statics_forbid_go_through_gears() -> None:
    """From 2 to 5 of the 8HP70 only A and D could carry while both slip, with B reverse gear: it goes by 3."""
    box = BOXES["zf-8hp70"]
    sizes = inertias(box)
    direct = between(box, "2", "5", sizes)
    assert direct is not None
    assert not is_straight(box, direct, 100.0)
    assert box.combination(("A", "B", "D")).gear == "R"
    parts = plan(box, box.closed_in("2"), box.closed_in("5"), sizes, 100.0)
    assert [one.after for one in parts] == pytest.approx([box.ratios["3"], box.ratios["5"]])
    assert all(isinstance(one, Handover) for one in parts)
    (whole,) = plan(box, box.closed_in("7"), box.closed_in("2"), sizes, 100.0)
    assert isinstance(whole, Handover)
    assert (set(whole.off), set(whole.on)) == ({"C", "D"}, {"B", "E"})


@pytest.mark.parametrize(("before", "after", "speed"), [("7", "2", 120.0), ("3", "7", 300.0), ("8", "1", 64.0)])
def test_speeds_go_straight_from_gear_to_gear(before: str, after: str, speed: float) -> None:
    """Neither above nor below those of both gears, and both slips stay in proportion until one of them is gone."""
    box = BOXES["zf-8hp70"]
    made = cw.shifts.survey(
        lambda gear: car(box, gear, speed), box, [(before, after)], sensed=SENSED, throttles=(0.3,), rtol=1e-6
    )
    (one,) = made.results
    assert one.record.reached
    assert one.quality is not None
    # a drive shaft that rings shakes the bounds
    assert max(one.quality.flare, one.quality.sag) < 10.0
    (whole,) = one.record.exchanges
    assert isinstance(whole, Handover)
    begin = next(time for time, state in one.record.phases if state == "inertia")
    end = next(time for time, state in one.record.phases if state == "sync")
    part = one.run.at(np.linspace(begin, begin + 0.6 * (end - begin), 40))
    slips = np.array([part[f"gearbox.{name}.slip"] for name in whole.on])
    share = slips / slips[:, :1]
    # of the whole way; the output rings meanwhile
    assert np.max(np.abs(share[0] - share[1])) < 0.25


@pytest.mark.parametrize("throttle", [0.05, 0.3])
def test_a_downshift_over_many_gears_does_not_brake_the_car(throttle: float) -> None:
    """From 7 to 2 with little at hand the engine brings most of what the input needs, and it takes longer.

    What elements pull is `pull` at the input, in second gear at the half shafts, and more than that again, for the
    throttle is in proportion to what is lacking.
    """
    box = BOXES["zf-8hp70"]
    made = {}
    for pull in (40.0, 1e3):
        settings = cw.shifts.ShiftSettings(pull=pull)
        made[pull] = cw.shifts.survey(
            lambda gear: car(box, gear, 120.0), box, [("7", "2")], sensed=SENSED, throttles=(throttle,),
            settings=settings, rtol=1e-6,
        ).results[0]  # fmt: skip
    least = {pull: float(np.min(one.run["half_shafts.torque"])) for pull, one in made.items()}
    assert all(one.record.reached for one in made.values())
    assert least[40.0] > -2.6 * 40.0 * box.ratios["2"] * FINAL_DRIVE
    assert least[1e3] < 2.0 * least[40.0]
