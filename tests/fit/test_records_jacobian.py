"""Derivatives of the residuals: exact ones against differences of runs, and what is done where there are none."""

from __future__ import annotations

import numpy as np
import pytest

import clutchwork as cw
from clutchwork.fit import Record, fit_records
from clutchwork.fit.descent import Descent
from clutchwork.fit.driven import driven
from clutchwork.fit.numbers import numbers
from support import measured_discs as two


def descent(system: cw.System, record: Record, free: list[str]) -> Descent:
    """The search of a fit."""
    found = driven(system, [record], [])
    return Descent(found, numbers(found, free, [], {}))


def test_exact_derivatives_are_those_of_differences():
    """By codes: logarithms, a speed, ordinates and a knot, through locking and breaking away."""
    free = [*two.TRUE, "engine.speed", "c1.pressure.values[2]", "c1.pressure.times[2]", "drive.torque.values"]
    search = descent(two.guess(), two.record(), free)
    u = search.numbers.codes()
    exact, other = search.jacobian(u), search.differences(0, u)
    assert not search.fallen
    scales = search.numbers.scales
    # differences of runs at 1e-9 over steps of 1e-4 have errors of 1e-5; samples beside an event see it move
    near = np.abs(exact - other) * scales > 1e-4 * np.max(np.abs(exact * scales), axis=0)
    assert near.sum() <= 0.01 * near.size
    np.testing.assert_allclose(
        np.median(np.abs(exact - other) * scales, axis=0), 0.0, atol=1e-6 * np.max(np.abs(exact * scales))
    )


def test_many_instants_are_those_of_single_ones():
    """All samples of a signal at once, against one value after another through the adjoint."""
    times = np.linspace(0.0, 2.5, 40)
    model, by = two.discs(), ["c1.gain", "engine.inertia", "c1.pressure.values", "c1.pressure.times[2]"]
    of = [cw.at(name, times) for name in ("load.speed", "c1.torque", "c1.power", "c1.slip")]
    function = cw.differentiable(model, 2.5, of=of, by=by, rtol=1e-9, atol=1e-11)
    values, matrix = function.value_and_jacobian(function.x0)
    assert len(function.of) == 160
    for place in range(0, 160, 23):
        weights = np.zeros(160)
        weights[place] = 1.0
        again, line = function.vjp(function.x0, weights)
        assert values == pytest.approx(again, rel=1e-9, abs=1e-9)
        assert matrix[place] == pytest.approx(line, rel=1e-7, abs=1e-9 * np.max(np.abs(matrix)))


def test_where_there_is_no_derivative_differences_do_and_the_result_says_so():
    """A sample at the very instant at which the discs lock, which moves with the numbers."""
    model = two.discs()
    lock = model.simulate(2.5, rtol=1e-9, atol=1e-11).events.of("c1")[0].time
    times = np.sort(np.append(two.TIMES, lock))
    run = model.simulate(2.5, times=times, rtol=1e-9, atol=1e-11)
    measured = {name: run[name] + np.random.default_rng(1).normal(0.0, 0.1, len(times)) for name in two.SPEEDS}
    found = fit_records(model, Record(times, measured), ["c1.friction.kinetic", "load.inertia"])
    assert found.determined, found.message
    assert "derivatives are differences of runs" in found.notes
    assert "at the instant of an event" in found.notes
    assert found.values["load.inertia"] == pytest.approx(0.8, rel=0.01)


def test_a_sample_at_a_jump_says_nothing():
    """The torque falls from 20 N m to zero as the discs lock, at the instant of a sample.

    Differences across the jump would give an interval a thousand times too narrow.
    """
    model = two.discs()
    run = model.simulate(2.5, times=two.TIMES, rtol=1e-9, atol=1e-11)
    rng, count = np.random.default_rng(0), len(two.TIMES)
    measured = {"c1.heat": run["c1.heat"] + rng.normal(0.0, 2.0, count)}
    measured["c1.torque"] = run["c1.torque"] + rng.normal(0.0, 0.2, count)
    lock = model.simulate(2.5, rtol=1e-9, atol=1e-11).events.of("c1")[0].time
    there = np.abs(two.TIMES - lock) > 1e-9
    assert there.sum() == count - 1
    rest = Record(two.TIMES[there], {name: values[there] for name, values in measured.items()})
    with_it, without = (fit_records(model, one, "load.inertia") for one in (Record(two.TIMES, measured), rest))
    assert "differences of runs" in with_it.notes
    assert not without.notes
    widths = [one["load.inertia"].upper - one["load.inertia"].lower for one in (with_it, without)]
    assert widths[0] == pytest.approx(widths[1], rel=0.2)
