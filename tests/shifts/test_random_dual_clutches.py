"""Dual-clutch gearboxes with random teeth, inertias, torques and speeds: each shift is made, none is felt as a hole."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import clutchwork as cw
from support.amount import amount


def box(rng: np.random.Generator) -> cw.Gearbox:
    """Four to seven gears in random steps of 1.2 to 1.7, odd ones on one shaft, even ones on the other."""
    count = int(rng.integers(4, 8))
    ratios = 3.6 / np.cumprod([1.0, *rng.uniform(1.2, 1.7, count - 1)])
    names = [str(number) for number in range(1, count + 1)]
    on = {name: "one" if int(name) % 2 else "two" for name in names}
    sets: dict[str, Any] = {}
    for name, ratio in zip(names, ratios, strict=True):
        first = round(90.0 / (1.0 + ratio))
        pair = {"teeth_first": first, "teeth_second": max(1, round(first * ratio))}
        sets[f"G{name}"] = {"type": "gear", "first": on[name], "second": f"w{name}", **pair}
    sets["F"] = {"type": "gear", "first": "lay", "second": "out", "teeth_first": 17, "teeth_second": 68}
    elements: dict[str, Any] = {"K1": ["in", "one"], "K2": ["in", "two"]}
    elements |= {f"S{name}": {"type": "synchroniser", "members": ["lay", f"w{name}"]} for name in names}
    return cw.Gearbox.from_dict(
        {
            "name": "random",
            "input": "in",
            "output": "out",
            "shafts": ["one", "two", *(f"w{name}" for name in names)],
            "sets": sets,
            "elements": elements,
            "gears": {name: ["K1" if on[name] == "one" else "K2", f"S{name}"] for name in names},
        }
    )


@pytest.mark.random
def test_every_shift_is_made() -> None:
    for seed in range(amount(20)):
        rng = np.random.default_rng([2407, seed])
        made = box(rng)
        gears = list(made.ratios)
        before = int(rng.integers(0, len(gears) - 1))
        places = (before, before + 1) if rng.random() < 0.5 else (before + 1, before)
        old, new = (gears[place] for place in places)
        inertia, torque = float(rng.uniform(0.06, 0.3)), float(rng.choice([rng.uniform(60, 200), rng.uniform(-25, -8)]))
        # between 130 and 350 rad/s in both gears
        low, high = sorted((made.ratios[old], made.ratios[new]))
        output = float(rng.uniform(130.0 / low, max(131.0 / low, 350.0 / high)))
        d = cw.Driveline("random")
        engine = d.shaft("engine", inertia=inertia, speed=output * made.ratios[old])
        out, body = d.shaft("out", inertia=1.0, speed=output), d.mass("car", mass=1500.0)
        values = {"inertia": 0.001, "torque": 260.0, "gear": old}
        d.add(cw.Transmission("gearbox", gearbox=made, input=engine, output=out, **values))
        d.add(cw.RollingWheel("wheel", shaft=out, mass=body, radius=0.31))
        d.add(cw.Vehicle("road", mass=body, drag_area=0.6, locked=False))
        d.add(cw.Torque("burning", shaft=engine, torque=torque))
        system = d.assemble()
        control = cw.shifts.ShiftController(made, cw.shifts.plant_of(system, made), gear=old)
        sim = cw.Simulator(system)
        source = [cw.shifts.TorqueSource("burning.torque", -30.0, 300.0, driven=torque)]
        cw.shifts.drive(sim, control, 0.5, throttle=lambda _: 0.5, sources=source)
        control.request(new)
        run = cw.shifts.drive(sim, control, 4.0, throttle=lambda _: 0.5, sources=source)
        (record,) = control.records
        assert record.reached, (seed, record)
        assert run["engine.speed"][-1] / run["out.speed"][-1] == pytest.approx(made.ratios[new], rel=1e-6), seed
        assert abs(run.energy.residual) < 1e-6 * run.energy.turnover, seed
        # acceleration as means of 20 ms, against what it is before and behind
        begin, end = record.phases[1][0], record.end
        assert end is not None
        speed = np.interp(np.arange(begin - 0.1, end + 0.1, 0.005), run.time, run["car.speed"])
        means = (speed[4:] - speed[:-4]) / 0.02
        first, last = means[:12].mean(), means[-12:].mean()
        if torque > 0.0:
            hole = min(first, last) - means.min()
            # with little acceleration the teeth that meet are a larger part of it
            assert hole < 0.08 * first + 0.05, (seed, hole, first, last)
