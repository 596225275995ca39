"""Rigid stops against SciPy: equations, events and impacts written anew."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import clutchwork as cw
from support.runs import TIGHT

J1, J2, STIFFNESS, DAMPING = 0.4, 0.15, 80.0, 0.3
AMPLITUDE, PULSE = 12.0, 9.0
# so high that SciPy, which sees its events at the ends of steps alone, misses no bounce
REST = 0.05


def load(t: float) -> float:
    return AMPLITUDE * float(np.sin(PULSE * t))


class Line:
    """Shaft 1 on a spring to the housing, shaft 2 behind a backlash; a torque on shaft 2."""

    def __init__(self, gap: float, restitution: float) -> None:
        self.gap, self.restitution = gap, restitution
        self.impacts = list[float]()

    def free(self, t: float, y: np.ndarray) -> list[float]:
        angle, one, _, two = y
        return [one, -(STIFFNESS * angle + DAMPING * one) / J1, two - one, load(t) / J2]

    def multiplier(self, t: float, y: np.ndarray) -> float:
        """Torque on shaft 2 that keeps both together."""
        spring = -(STIFFNESS * y[0] + DAMPING * y[1])
        return J2 * (spring + load(t)) / (J1 + J2) - load(t)

    def joined(self, t: float, y: np.ndarray) -> list[float]:
        common = (load(t) - STIFFNESS * y[0] - DAMPING * y[1]) / (J1 + J2)
        return [y[1], common, 0.0, common]

    def run(self, times: np.ndarray) -> np.ndarray:
        """Rows at the times."""
        t, y, side, rows = 0.0, np.array([0.02, 0.0, 0.0, 0.0]), 0, [np.empty((4, 0))]
        while t < times[-1]:
            right, events = self._phase(side)
            wanted = times[(times > t if rows[0].shape[1] or len(rows) > 1 else times >= t)]
            tight = {"method": "DOP853", "rtol": 1e-11, "atol": 1e-13, "max_step": 2e-4}
            made = solve_ivp(right, (t, times[-1]), y, t_eval=wanted, events=events, **tight)
            rows.append(made.y if len(made.t) else np.empty((4, 0)))
            if made.status != 1:
                break
            which = next(k for k, found in enumerate(made.t_events) if len(found))
            t, y = float(made.t_events[which][0]), made.y_events[which][0].copy()
            side = self._settle(t, y, side, (-1, 1)[which] if side == 0 else 0)
        return np.hstack(rows)

    def _phase(self, side: int) -> tuple[Callable[..., Any], list[Any]]:
        if side == 0:
            ends = [lambda t, y: y[2] + self.gap / 2, lambda t, y: self.gap / 2 - y[2]]
            for end in ends:
                end.terminal, end.direction = True, -1  # type: ignore[attr-defined]
            return self.free, ends
        opens = lambda t, y: -side * self.multiplier(t, y)  # noqa: E731
        opens.terminal, opens.direction = True, -1  # type: ignore[attr-defined]
        return self.joined, [opens]

    def _settle(self, t: float, y: np.ndarray, side: int, met: int) -> int:
        """The speeds after an impact, and the side that holds after it."""
        if side != 0:
            return 0
        self.impacts.append(t)
        y[2] = met * self.gap / 2
        slip = y[3] - y[1]
        back = self.restitution * abs(slip)
        impulse = -met * (abs(slip) + (back if back > REST else 0.0)) / (1 / J1 + 1 / J2)
        y[1] -= impulse / J1
        y[3] += impulse / J2
        if back > REST:
            return 0
        return met if -met * self.multiplier(t, y) > 0 else 0


@pytest.mark.parametrize(("gap", "restitution"), [(0.05, 0.0), (0.2, 0.0), (0.05, 0.4), (0.3, 0.7), (0.02, 0.6)])
def test_a_line_with_backlash(gap: float, restitution: float) -> None:
    line, times = Line(gap, restitution), np.linspace(0.0, 2.0, 81)
    known = line.run(times)
    d = cw.Driveline("line")
    one, two = d.shaft("one", inertia=J1), d.shaft("two", inertia=J2)
    spring = {"stiffness": STIFFNESS, "damping": DAMPING, "initial_twist": 0.02}
    d.add(cw.SpringDamper("spring", base=d.housing, follower=one, **spring))
    d.add(cw.Backlash("lash", base=one, follower=two, gap=gap, restitution=restitution, rest_speed=REST))
    d.add(cw.Torque("load", shaft=two, torque=cw.Sine(amplitude=AMPLITUDE, frequency=PULSE / (2 * np.pi))))
    run = d.simulate(2.0, times=times, **TIGHT)
    hits = [e.time for e in run.events if e.cause == "impact"]
    assert len(line.impacts) > 5
    assert hits == pytest.approx(line.impacts, abs=1e-7)
    # the reference follows its events to 1e-10, and play magnifies what it misses
    assert run["lash.position"] == pytest.approx(known[2], abs=1e-6 * gap)
    assert run["two.speed"] == pytest.approx(known[3], abs=1e-6 * np.max(np.abs(known[3])))
