"""Bounds of inputs hold for numbers and for every value that a signal takes."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import clutchwork as cw
from clutchwork.declare.node import Component, SignalLike
from clutchwork.declare.schema import family, signal
from clutchwork.model.fields import value_problems
from clutchwork.model.numbers import At
from clutchwork.signals.bases.extremes import extremes
from clutchwork.signals.bases.waveform import value


@family
class Piston(Component):
    """A declaration that is no component of the registry."""

    pressure: SignalLike = signal("Pa", "pressure on the piston", at_least=0.0, below=1e6, example=1e5)
    share: SignalLike = signal("1", "share of it", default=1.0, above=0.0, at_most=1.0)


def found(**values):
    return [str(problem) for problem in value_problems(Piston, values, At('cw.Piston "p"', ""))]


@pytest.mark.parametrize(
    "pressure",
    [
        0.0,
        9e5,
        cw.Table([(-2.0, -5.0), (-1.0, 0.0), (3.0, 9e5)]),
        cw.Sine(amplitude=2.0, frequency=1.0, offset=2.0),
        cw.Pulse(height=-1.0, period=2.0, width=1.0, start=0.5, offset=1.0),
        cw.Sampled(lambda time, readings: -1.0, 0.1),
        cw.ThermalNode("t", 1.0),
    ],
    ids=lambda pressure: type(pressure).__name__,
)
def test_what_keeps_the_bounds_is_no_problem(pressure):
    assert found(pressure=pressure) == []


@pytest.mark.parametrize(
    ("pressure", "words"),
    [
        (-1.0, "-1.0 Pa: must be >= 0 and < 1e+06 Pa"),
        (1e6, "1000000.0 Pa: must be >= 0 and < 1e+06 Pa"),
        (cw.Constant(-1.0), "-1 Pa at 0 s: must be"),
        (cw.Step(height=-1.0, start=0.3), "-1 Pa at 0.3 s: must be"),
        (cw.Table([(0.0, 0.0), (2.0, 4.0), (2.0, -3.0), (3.0, 0.0)]), "-3 Pa at 2 s: must be"),
        (cw.Table([(-1.0, -1.0), (1.0, 1.0), (2.0, -1.0)]), "-1 Pa at 2 s: must be"),
        (cw.Ramp(height=-4.0, duration=1.0, start=-0.5), "-2 Pa at 0 s: must be"),
        (cw.Sine(amplitude=2.0, frequency=0.25, offset=1.9, start=4.0), "-0.1 Pa at 7 s: must be"),
        (cw.Pulse(height=-1.0, period=2.0, width=1.0, start=0.5), "-1 Pa at 0.5 s: must be"),
    ],
    ids=str,
)
def test_what_is_out_of_bounds_is_named_with_its_time(pressure, words):
    (problem,) = found(pressure=pressure)
    assert words in problem
    assert "(pressure on the piston)" in problem


def test_a_share_has_no_unit():
    (problem,) = found(pressure=1.0, share=cw.Step(height=2.0, start=1.0, offset=0.5))
    assert "share = 2.5 at 1 s: must be > 0 and <= 1;" in problem


NUMBERS = st.floats(-3.0, 3.0)
POINTS = st.lists(st.tuples(st.floats(-1.0, 4.0), NUMBERS), min_size=1, max_size=6).map(sorted)
SIGNALS = st.one_of(
    st.builds(cw.Constant, NUMBERS),
    st.builds(cw.Step, height=NUMBERS, start=NUMBERS, offset=NUMBERS),
    st.builds(cw.Ramp, height=NUMBERS, duration=st.floats(0.1, 3.0), start=NUMBERS, offset=NUMBERS),
    st.builds(cw.Pulse, height=NUMBERS, period=st.floats(1.0, 3.0), width=st.floats(0.1, 0.9), start=NUMBERS),
    st.builds(cw.Table, POINTS),
    st.builds(
        cw.Sine, amplitude=NUMBERS, frequency=st.floats(0.2, 2.0), phase=NUMBERS, offset=NUMBERS, start=NUMBERS,
        damping=st.floats(0.0, 2.0),
    ),
)  # fmt: skip


@given(signal=SIGNALS)
def test_no_value_is_beyond_the_extremes(signal):
    reached = [value for _, value in extremes(signal)]
    taken = [value(signal, float(time)) for time in np.linspace(0.0, 12.0, 2401)]
    assert min(reached) <= min(taken) + 1e-9
    assert max(reached) >= max(taken) - 1e-9
    for time, extreme in extremes(signal):
        # at a jump either side counts
        near = [value(signal, max(t, 0.0)) for t in (time, math.nextafter(time, -math.inf))]
        assert any(math.isclose(extreme, v, abs_tol=1e-9) for v in near) or time < 0.0


def test_a_table_that_falls_to_its_bound_keeps_it():
    """Where 1.1 falls to 0 between 2.0 and 2.2 s, the end of the piece is below zero by round-off."""
    d = cw.Driveline()
    for number in range(50):
        shaft = d.shaft(f"s{number}", inertia=1.0)
        fall = cw.Table([(0.0, 0.37 + 0.0123 * number), (2.0, 0.91 - 0.0131 * number), (2.2, 0.0)])
        d.add(cw.Retarder(f"r{number}", shaft=shaft, capacity=1.0, command=fall))
    assert d.check() == []


def test_a_table_that_falls_to_zero_is_not_above_it():
    """Whatever the round-off at the end of the piece that falls."""
    for number in range(50):
        end = 0.2 + 0.0131 * number
        for further in ([(2.2, 0.5)], [(end, 0.5)]):
            (problem,) = found(pressure=1.0, share=cw.Table([(0.0, 0.37 + 0.0123 * number), (end, 0.0), *further]))
            assert "share = 0 at" in problem


def test_a_ramp_that_ends_at_a_bound_late_keeps_it():
    """The round-off at its end is that of the time."""
    for number in range(100):
        height, start, duration = 0.37 + 0.0061 * number, 7.3 * 1.05**number, 0.013 * (1 + number)
        ends = {"duration": duration, "start": start}
        assert not found(pressure=cw.Ramp(height=-height, offset=height, **ends))
        assert not found(pressure=1.0, share=cw.Ramp(height=1.0 - height, offset=height, **ends))
