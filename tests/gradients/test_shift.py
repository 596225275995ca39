"""Gradients of the benchmark shift by the static coefficient of all linings, against differences of other solvers."""

from __future__ import annotations

import pytest

import clutchwork as cw
from support import six_speed

LININGS = [f"{name}.friction.static" for name in six_speed.CLUTCHES]
# central differences of event-located runs at 1e-11
FIGURES = {
    "break_away(F2)": 0.0638602,
    "lock(F1)": 0.0048363,
    "w1.speed at 2.5 s": 0.424596,
    "w8.speed at 2.5 s": -0.367267,
    "w1.speed at 3 s": -0.196858,
    "w8.speed at 3 s": -0.107560,
}


def test_derivatives_of_the_shift_are_those_of_other_solvers():
    speeds = [cw.at(f"{name}.speed", time) for time in (2.5, 3.0) for name in ("w1", "w8")]
    wanted = dict(zip(list(FIGURES)[2:], speeds, strict=True))
    of = {"break_away(F2)": cw.break_away("F2"), "lock(F1)": cw.lock("F1"), **wanted}
    found = six_speed.gearbox(six_speed.SHIFT).simulate(4.0, rtol=1e-9, atol=1e-11).gradient(of, LININGS)
    # all linings change together
    for name, figure in FIGURES.items():
        assert found[name].sum() == pytest.approx(figure, abs=1e-6), name
