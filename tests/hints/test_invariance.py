"""Hints follow from the motion alone: not from the output, the order of a model, its signs, its units or its end."""

from __future__ import annotations

import warnings
from dataclasses import replace

import numpy as np
import pytest

import clutchwork as cw
from clutchwork.hints import registry
from support import random_drivelines
from support.amount import amount
from support.hint_models import CASES, hill, launch, shift

GRIDS = [{"dt": 0.31}, {"dt": 1e-3}, {"times": [0.05]}, {"output": "steps"}, {"work": False}, {"angles": False}]
NAMES = sorted(CASES)


def said(hints: cw.Hints) -> list[tuple[str, tuple[str, ...]]]:
    """Rule and elements of each."""
    return [(hint.rule, hint.elements) for hint in hints]


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("output", GRIDS, ids=lambda output: next(iter(output)))
def test_the_output_changes_no_hint(name: str, output: dict[str, object]) -> None:
    case = CASES[name]
    smooth, other = case.wrong().simulate(case.t_end).hints, case.wrong().simulate(case.t_end, **output).hints
    assert said(other) == said(smooth)
    for one, same in zip(other, smooth, strict=True):
        for key, value in same.numbers.items():
            # stretches end at instants of a grid of a thousandth of the run
            assert one.numbers[key] == pytest.approx(value, rel=0.05), key
    assert said(case.right().simulate(case.t_end, **output).hints) == []


@pytest.mark.parametrize("size", [1e-6, 1e-3, 1e3, 1e6])
@pytest.mark.parametrize(("capacity", "load"), [(60.0, 1.0), (150.0, 1.0)])
def test_the_unit_of_torque_changes_no_hint(size: float, capacity: float, load: float) -> None:
    plain, other = launch(capacity, load).simulate(2.0).hints, launch(capacity, load, size=size).simulate(2.0).hints
    assert said(other) == said(plain)
    for one, same in zip(other, plain, strict=True):
        assert one.numbers["needed [N m]"] == pytest.approx(size * same.numbers["needed [N m]"], rel=1e-6)
        assert one.numbers["slip [rad/s]"] == pytest.approx(same.numbers["slip [rad/s]"], rel=1e-6)


@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize("turned", [False, True])
def test_order_and_direction_change_no_hint(sign: float, turned: bool) -> None:
    (plain,) = launch(60.0).simulate(2.0).hints
    (other,) = launch(60.0, sign=sign, turned=turned).simulate(2.0).hints
    assert other.message == plain.message
    assert other.numbers == pytest.approx(dict(plain.numbers), rel=1e-9)


@pytest.mark.random
def test_the_direction_of_a_random_driveline_changes_no_hint() -> None:
    for seed in range(amount(60)):
        description = random_drivelines.describe(seed)
        one, other = (d.driveline().simulate(random_drivelines.T_END) for d in (description, description.mirrored()))
        assert said(other.hints) == said(one.hints), seed


@pytest.mark.random
def test_hints_about_random_drivelines_are_few_and_hold_what_they_say() -> None:
    found = 0
    for seed in range(amount(100)):
        run = random_drivelines.describe(seed).driveline().simulate(random_drivelines.T_END)
        for hint in run.hints:
            found += 1
            if hint.rule == "never locks":
                assert not np.any(run[f"{hint.elements[0]}.state"] == "locked"), seed
            if hint.rule == "full and slips":
                ends = np.abs(run.at([hint.begin, hint.end])[f"{hint.elements[0]}.slip"])
                assert ends[-1] > ends[0], seed
    # most random drivelines have three clutches with capacities of 0.3 to 4 times the engine torque
    assert found <= amount(100)


def test_a_run_that_stopped_early_has_hints_up_to_there() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", cw.StoppedEarly)
        run = launch(60.0).simulate(50.0, max_steps=3)
        late = hill(250.0).simulate(2.0, max_steps=1, dt=0.5)
    assert not run.finished
    assert all(hint.end is None or hint.end <= run.time[-1] for hint in run.hints)
    assert all(hint.end is None or hint.end <= late.time[-1] for hint in late.hints)


def test_a_run_without_instants_has_the_hints_of_its_model() -> None:
    d = CASES["joined to nothing"].wrong()
    run = d.simulate(0.1)
    empty = replace(run, time=run.time[:0], rows=run.rows[:0])
    assert said(empty.hints) == said(d.hints()) == [("joined to nothing", ("flywheel",))]


def test_hints_are_no_warnings() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        for case in CASES.values():
            d = case.wrong()
            assert d.check() == []
            assert set(d.hints()) <= set(d.simulate(case.t_end).hints)


def test_nothing_is_looked_for_before_it_is_asked_for(monkeypatch: pytest.MonkeyPatch) -> None:
    asked = []
    monkeypatch.setattr(registry, "of_run", lambda run: asked.append(run) or cw.Hints())
    run = shift(0.5).simulate(3.0)
    swept = cw.sweep(launch(60.0), 1.0, vary={"c.gain": [100.0, 200.0]}, outputs="c.slip")
    assert len(swept["c.slip"]) == 2
    assert asked == []
    assert run.hints is run.hints
    assert asked == [run]
