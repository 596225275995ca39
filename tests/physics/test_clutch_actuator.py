"""Pistons behind orifices and the valves before them: fill time, kiss point, stop, seal, compressed oil."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.integrate import solve_ivp

import clutchwork as cw
from support.runs import EXACT, TIGHT, at_end

AREA, ORIFICE, PRELOAD, SPRING, KISS, PLATES = 6e-3, 2e-6, 400.0, 1.5e5, 2e-3, 1e7
# flow over the root of a pressure difference
FLOW = 0.7 * ORIFICE * math.sqrt(2 / 850.0)
PISTON = cw.ClutchActuator(
    "piston",
    supply_pressure=8e5,
    orifice_area=ORIFICE,
    piston_area=AREA,
    preload=PRELOAD,
    spring_rate=SPRING,
    kiss_stroke=KISS,
    contact_rate=PLATES,
)


def _run(t_end: float, **values: Any) -> Any:
    """A piston that presses a brake on a shaft at rest."""
    d = cw.Driveline("bench")
    piston = replace(PISTON, **values)
    d.add(piston)
    plates = cw.Coulomb(static=0.12, kinetic=0.1)
    d.add(cw.Brake("brake", shaft=d.shaft("a", inertia=0.2), friction=plates, gain=0.1, normal_force=piston))
    return d.simulate(t_end, dt=t_end / 200, **TIGHT)


def test_the_kiss_point_is_reached_after_the_closed_form() -> None:
    """The brake closes there, with pure roots at 2 A^2 (sqrt(u0) - sqrt(u1))/(ks flow)."""
    run = _run(0.5, laminar_pressure=0.0)
    start, kiss = 8e5 - PRELOAD / AREA, 8e5 - (PRELOAD + SPRING * KISS) / AREA
    time = 2 * (math.sqrt(start) - math.sqrt(kiss)) * AREA**2 / (SPRING * FLOW)
    assert PISTON.fill_time(8e5) == pytest.approx(time, rel=1e-14)
    (event,) = run.events
    assert event.time == pytest.approx(time, abs=EXACT)
    assert PISTON.kiss_pressure == pytest.approx((PRELOAD + SPRING * KISS) / AREA, rel=1e-14)
    # beyond it the plates take what the springs leave
    force = (8e5 * AREA - PRELOAD - SPRING * KISS) / (1 + SPRING / PLATES)
    assert at_end(run, "piston.force") == pytest.approx(force, rel=1e-9)
    assert at_end(run, "piston.pressure") == pytest.approx(8e5, rel=1e-9)
    assert at_end(run, "brake.capacity") == pytest.approx(0.12 * 0.1 * force, rel=1e-9)


def test_a_supply_below_the_preload_moves_nothing() -> None:
    run = _run(1.0, supply_pressure=0.99 * PRELOAD / AREA)
    assert np.allclose(run["piston.force"], -PLATES * KISS, rtol=1e-14)
    assert len(run.events) == 0
    assert PISTON.fill_time(PRELOAD / AREA) == math.inf


def test_a_supply_that_swings_against_an_independent_solution() -> None:
    """With a laminar part, out and back to the stop; SciPy on the stroke."""
    supply = cw.Sine(amplitude=2.4e5, frequency=1.1, offset=2.5e5)
    run = _run(2.0, supply_pressure=supply, laminar_pressure=2e4, orifice_area=10 * ORIFICE)

    def speed(t: float, x: Any) -> list[float]:
        springs = PRELOAD + SPRING * x[0] + PLATES * max(0.0, x[0] - KISS)
        u = 2.5e5 + 2.4e5 * math.sin(2 * math.pi * 1.1 * t) - springs / AREA
        q = 10 * FLOW * u / (u * u + 4e8) ** 0.25
        return [0.0 if x[0] <= 0.0 and q < 0.0 else q / AREA]

    made = solve_ivp(speed, (0.0, 2.0), [0.0], method="Radau", rtol=1e-10, atol=1e-14, max_step=1e-3, t_eval=run.time)
    wanted = PLATES * (np.maximum(made.y[0], 0.0) - KISS)
    assert np.max(wanted) > 200.0
    assert np.min(wanted[run.time > 0.5]) == pytest.approx(-PLATES * KISS, rel=1e-3)
    # SciPy steps over the stop and the kiss point, by 1e-3 s
    assert np.allclose(run["piston.force"], wanted, rtol=0.0, atol=2e-4 * PLATES * KISS)


def test_the_seal_holds_within_its_friction() -> None:
    """A slow triangle of the supply: the piston moves where it passes the springs by the friction, each way."""
    friction, peak = 60.0, 1.1e5
    supply = cw.Table([(0.0, 0.0), (11.0, peak), (22.0, 0.0)])
    run = _run(22.0, supply_pressure=supply, seal_friction=friction, orifice_area=100 * ORIFICE, laminar_pressure=0.0)
    rate = peak / 11.0
    force = run["piston.force"]
    moves = run.time[np.flatnonzero(np.diff(force) > 1e-9)[0]]
    # rows are 0.11 s apart
    assert moves == pytest.approx((PRELOAD + friction) / AREA / rate, abs=0.12)
    top = (peak * AREA - PRELOAD - friction) / SPRING
    held = (run.time > 11.5) & (run.time < 11.0 + 0.95 * 2 * friction / AREA / rate)
    assert np.ptp(force[held]) < 1e-9
    # the piston lags by the flow of the ramp
    assert force[held][0] == pytest.approx(PLATES * (top - KISS), rel=1e-3)
    returned = run.time > (11.0 + (peak - (PRELOAD - friction) / AREA) / rate) + 0.5
    assert np.allclose(force[returned], -PLATES * KISS, rtol=1e-14)


def test_oil_is_compressed_before_the_piston_moves() -> None:
    """At the stop B/V flow sqrt(u) raises the pressure: sqrt(u) falls linearly; moving, A grows by V ks/(B A)."""
    volume, bulk = 2e-3, 8e8
    run = _run(1.5, laminar_pressure=0.0, volume=volume, bulk_modulus=bulk)
    lifted = 2 * (math.sqrt(8e5) - math.sqrt(8e5 - PRELOAD / AREA)) * volume / (bulk * FLOW)
    start, kiss = 8e5 - PRELOAD / AREA, 8e5 - (PRELOAD + SPRING * KISS) / AREA
    area = AREA + volume / bulk * SPRING / AREA
    filled = 2 * (math.sqrt(start) - math.sqrt(kiss)) * AREA * area / (SPRING * FLOW)
    assert run.events[0].time == pytest.approx(lifted + filled, abs=EXACT)
    still = run.time < lifted
    wanted = 8e5 - (math.sqrt(8e5) - run.time[still] * bulk * FLOW / (2 * volume)) ** 2
    assert np.allclose(run["piston.pressure"][still], wanted, rtol=1e-9, atol=1e-3)


def test_a_piston_that_starts_beyond_the_kiss_point_lets_go() -> None:
    run = _run(1.0, supply_pressure=0.0, initial_stroke=2.5e-3)
    assert run["piston.force"][0] == pytest.approx(PLATES * 0.5e-3, rel=1e-12)
    assert at_end(run, "piston.force") == -PLATES * KISS
    assert [e.after for e in run.events][-1] == "open"


def test_a_valve_follows_its_table_with_a_lag() -> None:
    """A ramp of the current over the rising part of the table: a ramp behind a lag, from its first point on."""
    d = cw.Driveline("valve")
    a = d.shaft("a", inertia=1.0)
    table = [(0.1, 0.0), (0.5, 4e5), (0.9, 1.2e6)]
    valve = cw.PressureValve("valve", pressure=table, lag=0.05, current=cw.Ramp(height=1.0, duration=1.0))
    d.add(valve)
    d.add(cw.Brake("b", shaft=a, friction=cw.Coulomb(static=0.2, kinetic=0.2), gain=1e-4, pressure=valve))
    run = d.simulate(1.5, dt=0.01, **TIGHT)

    def ramp(t: Any, rate: float) -> Any:
        s = np.maximum(t, 0.0)
        return rate * (s - 0.05 * (1 - np.exp(-s / 0.05)))

    wanted = ramp(run.time - 0.1, 1e6) + ramp(run.time - 0.5, 1e6) - ramp(run.time - 0.9, 2e6)
    assert np.allclose(run["valve.pressure"], wanted, rtol=0.0, atol=1e-5)


def test_a_pressure_off_the_stop_is_refused() -> None:
    d = cw.Driveline("wrong")
    d.shaft("a", inertia=1.0)
    d.add(replace(PISTON, initial_stroke=1e-3, initial_pressure=1e5))
    assert "but the piston is off its stop" in str(d.check()[0])
