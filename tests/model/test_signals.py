"""Signals: their values at chosen times, and their exact response to a low pass."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import clutchwork as cw
from clutchwork.base.errors import FileError
from clutchwork.signals.bases.waveform import low_pass, piece_value, value

TABLE = cw.Table([(1.0, 2.0), (3.0, 6.0), (3.0, -1.0), (4.0, 0.0)])


@pytest.mark.parametrize(
    ("signal", "time", "wanted"),
    [
        (cw.Constant(3.0), 7.0, 3.0),
        (cw.Step(height=2.0, start=1.0, offset=0.5), 0.999, 0.5),
        (cw.Step(height=2.0, start=1.0, offset=0.5), 1.0, 2.5),
        (cw.Step(height=2.0), 0.0, 2.0),
        (cw.Ramp(height=4.0, duration=2.0, start=1.0, offset=1.0), 0.0, 1.0),
        (cw.Ramp(height=4.0, duration=2.0, start=1.0, offset=1.0), 2.0, 3.0),
        (cw.Ramp(height=4.0, duration=2.0, start=1.0, offset=1.0), 9.0, 5.0),
        (cw.Pulse(height=3.0, period=2.0, width=0.5, start=5.0, offset=1.0), 0.0, 1.0),
        (cw.Pulse(height=3.0, period=2.0, width=0.5, start=5.0, offset=1.0), 4.99, 1.0),
        (cw.Pulse(height=3.0, period=2.0, width=0.5, start=5.0, offset=1.0), 5.2, 4.0),
        (cw.Pulse(height=3.0, period=2.0, width=0.5, start=5.0, offset=1.0), 6.9, 1.0),
        (cw.Pulse(height=3.0, period=2.0, width=0.5, start=5.0, offset=1.0), 9.4, 4.0),
        (cw.Sine(amplitude=2.0, frequency=0.25, offset=1.0), 1.0, 3.0),
        (cw.Sine(amplitude=2.0, frequency=0.25, offset=1.0, start=1.0), 0.5, 1.0),
        (cw.Sine(amplitude=2.0, frequency=0.25, start=1.0, damping=0.5), 2.0, 2.0 * math.exp(-0.5)),
        (cw.Sine(amplitude=2.0, frequency=0.0, phase=math.pi / 2), 8.0, 2.0),
        (TABLE, 0.0, 2.0),
        (TABLE, 2.0, 4.0),
        (TABLE, 3.0, -1.0),
        (TABLE, 3.5, -0.5),
        (TABLE, 9.0, 0.0),
        (cw.Sampled(lambda time, readings: 1.0, 0.1), 2.0, 0.0),
    ],
    # the same in every process: a function shows its address
    ids=lambda value: type(value).__name__ if isinstance(value, cw.Signal) else str(value),
)
def test_value(signal, time, wanted):
    assert value(signal, time) == pytest.approx(wanted, abs=1e-14)


def test_the_core_agrees_on_every_signal():
    signals = [
        cw.Constant(3.0),
        cw.Step(height=2.0, start=0.35, offset=0.5),
        cw.Ramp(height=4.0, duration=0.2, start=0.1, offset=1.0),
        cw.Pulse(height=3.0, period=0.2, width=0.05, start=0.3, offset=1.0),
        cw.Pulse(height=3.0, period=0.2, width=0.05, start=-0.3, offset=1.0),
        cw.Sine(amplitude=2.0, frequency=3.0, offset=1.0, start=0.2, damping=0.7),
        cw.Table([(0.1, 2.0), (0.3, 6.0), (0.3, -1.0), (0.4, 0.0)]),
        cw.Table([(-1.0, 2.0), (0.3, 6.0)]),
    ]
    d = cw.Driveline()
    shaft = d.shaft("a", inertia=1.0)
    for number, signal in enumerate(signals):
        d.add(cw.Torque(f"t{number}", shaft=shaft, torque=signal))
    times = np.linspace(0.013, 0.973, 97)
    run = d.simulate(1.0, times=times)
    for number, signal in enumerate(signals):
        wanted = [value(signal, time) for time in times]
        np.testing.assert_allclose(run[f"t{number}.torque"], wanted, rtol=0, atol=1e-12)


@given(
    st.lists(st.tuples(st.integers(0, 30).map(lambda t: t / 10), st.floats(-5, 5)), min_size=1, max_size=5),
    st.floats(0.05, 5.0),
)
def test_low_pass_solves_its_equation(points, cutoff):
    signal = cw.Table(sorted(points, key=lambda point: point[0]))
    pieces, rate = low_pass(signal, cutoff).segments(), 2 * math.pi * cutoff
    assert pieces[0].start <= 0.0
    assert piece_value(pieces[0], 0.0) == pytest.approx(value(signal, 0.0), abs=1e-9)
    for piece, after in pairwise(pieces):
        # continuous, and dy/dt = rate (u - y) in the middle of each piece
        assert piece_value(piece, after.start) == pytest.approx(piece_value(after, after.start), abs=1e-8)
        middle, step = (piece.start + after.start) / 2, 1e-4 * (after.start - piece.start)
        if step > 1e-9:
            slope = (piece_value(piece, middle + step) - piece_value(piece, middle - step)) / (2 * step)
            wanted = rate * (value(signal, middle) - piece_value(piece, middle))
            assert slope == pytest.approx(wanted, rel=1e-4, abs=1e-3)


def test_low_pass_of_a_step_is_the_exponential():
    pieces = low_pass(cw.Step(height=1.0, start=0.5), 5.0).segments()
    assert piece_value(pieces[-1], 0.7) == pytest.approx(1 - math.exp(-2 * math.pi * 5.0 * 0.2), rel=1e-14)


SINES = st.builds(
    cw.Sine,
    amplitude=st.floats(0.1, 5.0),
    frequency=st.floats(0.0, 20.0),
    phase=st.floats(-4.0, 4.0),
    offset=st.floats(-3.0, 3.0),
    start=st.floats(-2.0, 2.0),
    damping=st.one_of(st.just(0.0), st.floats(0.1, 20.0)),
)


def filtered_by_quadrature(signal: cw.Sine, rate: float, end: float) -> float:
    """y(end) = signal(0) exp(-rate end) + integral of rate exp(-rate (end - t)) signal(t), by Gauss."""
    nodes, weights = np.polynomial.legendre.leggauss(20)
    knots = np.union1d(np.linspace(0.0, end, 60), [t for t in (signal.start,) if 0.0 < t < end])
    middle, half = (knots[1:] + knots[:-1]) / 2, np.diff(knots) / 2
    times = middle[:, None] + half[:, None] * nodes
    values = np.vectorize(lambda t: value(signal, t))(times) * np.exp(-rate * (end - times))
    return value(signal, 0.0) * math.exp(-rate * end) + rate * float(np.sum(half * (values @ weights)))


@given(SINES, st.floats(0.05, 20.0), st.floats(0.01, 3.0))
def test_a_sine_behind_the_filter_against_quadrature(signal, cutoff, time):
    passed = low_pass(signal, cutoff)
    wanted = filtered_by_quadrature(signal, 2 * math.pi * cutoff, time)
    assert value(passed, time) == pytest.approx(wanted, abs=1e-8)


def test_the_core_follows_a_sine_behind_the_filter():
    """Speed, its integral and its derivative, where a wave and what is left of the start stand side by side."""
    sine = cw.Sine(amplitude=3.0, frequency=2.0, phase=0.4, offset=1.0, start=0.3, damping=0.5)
    d = cw.Driveline()
    d.add(cw.PrescribedSpeed("p", shaft=d.shaft("a", inertia=2.0), speed=sine, cutoff=3.0))
    times = np.linspace(0.01, 1.99, 67)
    run = d.simulate(2.0, times=times, rtol=1e-10, atol=1e-10)
    passed, h = low_pass(sine, 3.0), 1e-5
    speed = np.array([value(passed, t) for t in times])
    np.testing.assert_allclose(run["a.speed"], speed, rtol=0, atol=1e-12)
    slope = np.array([(value(passed, t + h) - value(passed, t - h)) / (2 * h) for t in times])
    np.testing.assert_allclose(run["a.acceleration"], slope, rtol=0, atol=1e-5)
    fine = np.linspace(0.0, 2.0, 40_001)
    curve = np.array([value(passed, t) for t in fine])
    integral = np.concatenate([[0.0], np.cumsum((curve[1:] + curve[:-1]) / 2 * np.diff(fine))])
    np.testing.assert_allclose(run["a.angle"], np.interp(times, fine, integral), rtol=0, atol=1e-6)
    # the source pays for the motion: work is the kinetic energy
    kinetic = 0.5 * 2.0 * (run["a.speed"] ** 2 - value(passed, 0.0) ** 2)
    np.testing.assert_allclose(run["p.work"], kinetic, rtol=0, atol=2e-6 * np.max(kinetic))


@pytest.mark.parametrize(
    "signal",
    [
        cw.Pulse(height=1.0, period=1.0, width=0.5),
        cw.Sampled(max, 0.1),
        # in resonance with the filter
        cw.Sine(amplitude=1.0, frequency=0.0, phase=1.0, damping=6.0 * math.pi),
    ],
    ids=str,
)
def test_what_cannot_pass_the_filter_exactly_is_a_mistake(signal):
    d = cw.Driveline()
    d.add(cw.PrescribedSpeed("p", shaft=d.shaft("a", inertia=1.0), speed=signal, cutoff=3.0))
    (problem,) = d.check()
    assert problem.quantity == "cutoff"
    assert problem.value == "3 Hz"


def _column(tmp_path, text, **other):
    (tmp_path / "p.csv").write_text(text)
    return cw.Column("p.csv", "F1", folder=str(tmp_path), **other)


def test_column_reads_times_and_values(tmp_path):
    text = "\ufefftime, F1 ,F2\n0,1,9\n 2 ,5e0,9\n\n2,7,9\n"
    assert _column(tmp_path, text).points == ((0.0, 1.0), (2.0, 5.0), (2.0, 7.0))
    assert _column(tmp_path, text, scale=1e5).points[1] == (2.0, 5e5)


@pytest.mark.parametrize(
    ("text", "quantity", "words"),
    [
        ("time,F2\n0,1\n", "column", "no column 'F1'"),
        ("time,F1s\n0,1\n", "column", "did you mean 'F1s'?"),
        ("t,F1\n0,1\n", "time", "no column 'time'"),
        ("time,F1\n0,1\n1,abc\n", "column", "line 3 of 'p.csv': the cell in column 'F1' is not a finite number"),
        ("time,F1\n0,1\n1\n", "column", "line 3 of 'p.csv': the cell in column 'F1' is empty"),
        ("time,F1\n0,1\nnan,1\n", "time", "line 3 of 'p.csv': the cell in column 'time' is not a finite number"),
        ("time,F1\n0,1\n2,1\n1,1\n", "time", "line 4 of 'p.csv': its time is before that of line 3"),
        ('time,F1\n0,"1,5"\n', "column", "with a decimal point"),
        ("", "path", "is empty"),
        ("time,F1\n", "path", "has no row of numbers"),
    ],
)
def test_column_names_what_is_wrong_with_its_file(tmp_path, text, quantity, words):
    with pytest.raises(FileError) as caught:
        _ = _column(tmp_path, text).points
    assert [found for found, *_ in caught.value.problems] == [quantity]
    assert words in str(caught.value)


def test_column_without_file():
    ((quantity, message, _),) = cw.Column("no/such.csv", "F1").problems()
    assert quantity == "path"
    assert message == "'no/such.csv' does not exist"
