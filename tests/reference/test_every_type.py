"""Every type of the conventions can be expressed; those with play and heat agree with SciPy on their equations."""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import clutchwork as cw
from reference.msl.elements import ENTRIES
from reference.msl.model import translate

TYPES = {
    *("inertia", "mass", "rod", "fixed", "spring", "damper", "spring_damper", "relative_states"),
    *("elasto_backlash", "elasto_backlash2", "elasto_gap", "torque", "torque2", "constant_torque", "sign_torque"),
    *("linear_speed_dependent_torque", "quadratic_speed_dependent_torque", "eddy_current_torque"),
    *("rolling_resistance", "position", "speed", "accelerate", "constant_speed", "ideal_gear", "ideal_planetary"),
    *("ideal_rolling_wheel", "ideal_gear_r2t", "lossy_gear", "clutch", "brake", "bearing_friction"),
    *("one_way_clutch", "mass_with_stop_and_friction"),
}
T_END = 2.0
TIMES = np.linspace(0.0, T_END, 201)
C, D, B, REL0 = 400.0, 3.0, 0.1, 0.05
Force = Callable[[float, float], float]


def test_every_type_has_an_entry() -> None:
    assert TYPES - ENTRIES.keys() <= {"mass_with_stop_and_friction"}


def backlash(y: float, w: float, *, limited: bool) -> float:
    """Torque of CONVENTIONS.md, positive on flange_b from outside."""
    side = math.copysign(1.0, y)
    if abs(y) <= 0.5 * B:
        return 0.0
    tc, td = C * (abs(y) - 0.5 * B), D * side * w
    if tc + td <= 0.0:
        return 0.0
    return side * (tc + min(tc, td) if limited else tc + td)


def gap(s: float, v: float) -> float:
    """Force of CONVENTIONS.md: it only pushes, the damper no more than the spring."""
    if s >= REL0:
        return 0.0
    fc = C * (s - REL0)
    return fc + max(fc, min(-fc, D * v))


PLAY: dict[str, tuple[dict[str, Any], str, Force]] = {
    "elasto_backlash": (
        {"c": C, "d": D, "b": B, "rel0": REL0},
        "inertia",
        lambda y, w: backlash(y - REL0, w, limited=True),
    ),
    "elasto_backlash2": (
        {"c": C, "d": D, "b": B, "rel0": REL0},
        "inertia",
        lambda y, w: backlash(y - REL0, w, limited=False),
    ),
    "elasto_gap": ({"c": C, "d": D, "rel0": REL0, "n": 1}, "mass", gap),
}


@pytest.mark.parametrize("kind", PLAY)
@pytest.mark.parametrize("start", [0.0, 0.5, -2.0])
def test_play(kind: str, start: float) -> None:
    """Two bodies that a sine drives through the play, from several speeds: SciPy on the published equations."""
    values, body, force = PLAY[kind]
    place, speed, size = ("s", "v", "m") if body == "mass" else ("phi", "w", "J")
    case = {
        "name": kind,
        "stop_time": T_END,
        "elements": {
            "a": {"type": body, size: 2.0, **({"L": 0.0} if body == "mass" else {})},
            "b": {"type": body, size: 0.5, **({"L": 0.0} if body == "mass" else {})},
            "play": {"type": kind, **values},
            "push": {"type": "torque", "tau": "sine"},
        },
        "connections": [
            ["a.flange_b", "play.flange_a"],
            ["play.flange_b", "b.flange_a"],
            ["push.flange", "a.flange_a"],
        ],
        "signals": {"sine": {"type": "sine", "amplitude": 20.0, "f": 1.3, "phase": 0.4, "offset": 2.0}},
        "initial": {f"a.{place}": 0.0, f"a.{speed}": 0.0, f"b.{place}": 0.08, f"b.{speed}": start},
        "outputs": [{"csv": f"b.{speed}", "signal": f"b.{speed}"}, {"csv": f"a.{place}", "signal": f"a.{place}"}],
    }
    model = translate(case)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", cw.ModelWarning)
        run = model.driveline.simulate(T_END, times=TIMES, rtol=1e-10, atol=1e-12)
    assert run.status == "done", run.message

    def slope(t: float, y: np.ndarray) -> list[float]:
        inner = force(y[2] - y[0], y[3] - y[1])
        drive = 2.0 + 20.0 * math.sin(2 * math.pi * 1.3 * t + 0.4)
        return [y[1], (drive + inner) / 2.0, y[3], -inner / 0.5]

    found = solve_ivp(slope, (0.0, T_END), [0.0, 0.0, 0.08, start], t_eval=TIMES, rtol=1e-10, atol=1e-12, max_step=5e-4)
    # steps across the kinks cost SciPy some 1e-7 of the scale each
    for name, reference in ((f"b.{speed}", found.y[3]), (f"a.{place}", found.y[0])):
        assert model.outputs[name](run) == pytest.approx(reference, abs=3e-6 * np.max(np.abs(reference)))


def test_eddy_current_brake_that_warms() -> None:
    values = {"tau_nominal": 100.0, "w_nominal": 10.0, "TRef": 293.15, "alpha20": 0.0039, "heat_capacity": 20.0}
    case = {
        "name": "eddy",
        "stop_time": T_END,
        "elements": {
            "j": {"type": "inertia", "J": 1.5},
            "e": {"type": "eddy_current_torque", "T0": 293.15, **values},
        },
        "connections": [["e.flange", "j.flange_a"]],
        "signals": {},
        "initial": {"j.phi": 0.0, "j.w": 60.0},
        "outputs": [{"csv": "j.w", "signal": "j.w"}, {"csv": "T", "signal": "e.T"}],
    }
    model = translate(case)
    run = model.driveline.simulate(T_END, times=TIMES, rtol=1e-10, atol=1e-12)

    def slope(_: float, y: np.ndarray) -> list[float]:
        x = y[0] / (10.0 * (1.0 + 0.0039 * (y[1] - 293.15)))
        torque = 2.0 * 100.0 * x / (1.0 + x * x)
        return [-torque / 1.5, torque * y[0] / 20.0]

    found = solve_ivp(slope, (0.0, T_END), [60.0, 293.15], t_eval=TIMES, rtol=1e-10, atol=1e-12)
    assert model.outputs["j.w"](run) == pytest.approx(found.y[0], abs=60.0 * 1e-7)
    assert model.outputs["T"](run) == pytest.approx(found.y[1], abs=300.0 * 1e-7)
