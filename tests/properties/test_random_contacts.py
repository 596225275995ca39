"""Random drivelines with 2 to 6 contacts: what must hold at every row of every run, whatever happens in it."""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
import pytest

import clutchwork as cw
from support.amount import amount
from support.random_contacts import T_END, contacts, driveline
from support.sweep import simulate, stopped, sweep

COUNT = amount(1000)

# asked for
RESIDUAL = 1e-6
# of the largest torque or power in the run: what round-off may do
ROUND_OFF = 1e-9


def scale(made: Any, names: list[str]) -> float:
    """Largest torque in a run [N m]."""
    return max(float(np.max(np.abs(made[f"{name}.torque"]))) for name in [*names, "engine"])


def holding(part: Any, made: Any) -> tuple[np.ndarray | float, np.ndarray | float]:
    """Bounds of the torque on the follower of a contact at every row [N m]; none where it is a band, by its sense."""
    if isinstance(part, cw.OneWayClutch):
        return 0.0, np.inf
    if isinstance(part, cw.SpragClutch):
        return -part.drag, part.holding
    if isinstance(part, cw.TorqueLimiter):
        return -part.torque, part.torque
    if isinstance(part, cw.BandBrake):
        force = np.maximum(made[f"{part.name}.force"], 0.0)
        lower, upper = np.expm1(part.friction.static * 3.0), -np.expm1(-part.friction.static * 3.0)
        return -force * lower, force * upper
    load = part.gain * np.maximum(made[f"{part.name}.normal_force"], 0.0) * part.friction.static
    return -load, load


def bounds(made: Any, parts: list[Any]) -> str:
    slack = ROUND_OFF * scale(made, [part.name for part in parts])
    found = []
    for part in parts:
        torque, (low, high) = made[f"{part.name}.torque"], holding(part, made)
        beyond = np.maximum(low - torque, torque - high)
        worst = int(np.argmax(beyond))
        if beyond[worst] > slack:
            rows = int(np.sum(beyond > slack))
            found.append(
                f"{part.name} ({part.kind}) by {beyond[worst]:.3g} N m at {made.time[worst]:.9g} s, {rows} rows"
            )
    return "; ".join(found)


def drives(made: Any, parts: list[Any]) -> str:
    found = []
    for part in parts:
        power = made[f"{part.name}.power"]
        slack = ROUND_OFF * max(1.0, float(np.max(np.abs(power)))) + 1e-12 * scale(made, [part.name]) * 300.0
        if power.max() > slack:
            found.append(f"{part.name} ({part.kind}) gives {power.max():.3g} W at {made.time[np.argmax(power)]:.9g} s")
    return "; ".join(found)


def turns_back(made: Any, parts: list[Any]) -> str:
    wheels = [part.name for part in parts if isinstance(part, cw.OneWayClutch)]
    slips = {name: float(made[f"{name}.slip"].min()) for name in wheels}
    return "; ".join(f"{name} slip {slip:.3g}" for name, slip in slips.items() if slip < -1e-7)


def residual(made: Any, parts: list[Any]) -> str:
    energy = made.energy
    if abs(energy.residual) <= RESIDUAL * energy.turnover:
        return ""
    return f"{energy.residual:.3g} J of {energy.turnover:.3g} J"


def ends(made: Any, parts: list[Any]) -> str:
    return stopped(made)


QUESTIONS = (ends, bounds, drives, turns_back, residual)


@cache
def answers(seed: int) -> dict[str, str]:
    """What is wrong with a run, by question; the run itself is not kept, for there may be many."""
    model = driveline(seed)
    made = simulate(model, T_END)
    return {question.__name__: question(made, contacts(model)) for question in QUESTIONS}


@pytest.mark.random
@pytest.mark.parametrize("question", [question.__name__ for question in QUESTIONS])
def test_random_contacts(question: str) -> None:
    sweep(lambda seed: answers(seed)[question], COUNT)


def test_the_drivelines_are_worth_it() -> None:
    """Enough happens: locks and break-aways."""
    runs = [simulate(driveline(seed), T_END) for seed in range(100)]
    kinds = [event.after for run in runs for event in run.events.changes()]
    assert kinds.count("locked") > 100
    assert kinds.count("forward") + kinds.count("backward") > 100
