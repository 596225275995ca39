"""Systems that start where a run stands, moved a little, with constant signals: to difference what they do."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

import clutchwork as cw
from clutchwork.assembly.records import frozen
from clutchwork.linear.chosen import Excitation, chosen_inputs
from clutchwork.linear.equations import Equations, equations
from clutchwork.linear.instant import Instant, instant_of
from clutchwork.linear.motion import Motion


def started(system: cw.System, speeds: np.ndarray, states: np.ndarray, signals: np.ndarray) -> cw.System:
    """The system with these independent speeds and states at the start, and constant signals."""
    n = len(signals)
    coefficients = np.zeros((n, 12))
    coefficients[:, 0] = signals
    arrays = dict(system.arrays) | {
        "initial_speed": np.array(speeds, dtype=float),
        "initial_state": np.array(states, dtype=float),
        "contact_initial": np.zeros_like(system.contact_initial),
        "input_first": np.arange(n, dtype="i4"),
        "input_count": np.ones(n, dtype="i4"),
        "input_period": np.zeros(n),
        "segment_time": np.zeros(n),
        "segment_coef": coefficients,
    }
    return replace(system, arrays=frozen(arrays))


class Standing:
    """Where a run stands at an instant, and what it does after a small push."""

    def __init__(self, instant: Instant) -> None:
        self.instant, self.motion = instant, Motion(instant)
        problems: list[str] = []
        given = chosen_inputs(instant.system, None, problems)
        tied = np.abs(self.motion.free.ties).max(axis=0, initial=0.0)
        self.given: list[Excitation] = [one for one in given if one.motion < 0 or not tied[one.motion]]
        self.linear: Equations = equations(self.motion, self.given, [], [])
        nodes = [node.name for node in instant.system.nodes]
        self.independent = [nodes.index(name) for name in instant.system.independent]

    def pushed(self, change: np.ndarray) -> Instant:
        """What stands there after the row has changed by that much in speeds, states and signals."""
        row = self.instant.row + change
        columns = self.instant.wiring.columns
        speed, state, signals = (row[columns[part]] for part in ("speed", "state", "input"))
        return instant_of(started(self.instant.system, speed[self.independent], state, signals), None)

    def rates(self, there: Instant) -> np.ndarray:
        """Rates of the states of the linear system; those of speeds are accelerations of the core."""
        return np.array([state.rate for state in equations(Motion(there), self.given, [], []).states])


def push_sizes(standing: Standing, step: float) -> np.ndarray:
    """A push for each state and input: a small part of its size, or of what is usual for its unit."""
    usual = {
        "rad/s": 10.0,
        "m/s": 10.0,
        "Pa": 1e5,
        "K": 30.0,
        "N m": 10.0,
        "N": 10.0,
        "rad": 0.01,
        "m": 1e-3,
        "J": 100.0,
    }
    names = [*((s.unit, s.value) for s in standing.linear.states)]
    columns = standing.instant.wiring.columns
    values = standing.instant.row[columns["input"]]
    names += [(one.unit, values[one.signal]) for one in standing.given]
    return np.array([step * max(abs(value), usual.get(unit, 1.0)) for unit, value in names])


def differences(standing: Standing, step: float = 1e-5) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Derivatives of the rates and of the row by central differences, and which columns kept all modes."""
    linear, base = standing.linear, standing.instant
    n = len(linear.states)
    sizes = push_sizes(standing, step)
    rates, rows, valid = [], [], []
    kinks = _at_kinks(standing)
    for column, size in enumerate(sizes):
        change = linear.row[:, column] * size
        up, down = standing.pushed(change), standing.pushed(-change)
        same = bool((up.modes == base.modes).all() and (down.modes == base.modes).all())
        same = same and all(len(equations(Motion(there), standing.given, [], []).states) == n for there in (up, down))
        valid.append(same and not kinks[column])
        if not valid[-1]:
            rates.append(np.zeros(n)), rows.append(np.zeros(len(base.row)))
            continue
        rates.append((standing.rates(up) - standing.rates(down)) / (2 * size))
        rows.append((up.row - down.row) / (2 * size))
    return (
        np.array(rates).T.reshape(n, len(sizes)),
        np.array(rows).T.reshape(len(base.row), len(sizes)),
        np.array(valid),
    )


def _sizes_of_parts(standing: Standing) -> np.ndarray:
    """Largest number of the part that each number of the row belongs to."""
    row = standing.instant.row
    made = np.zeros(len(row))
    for part in standing.instant.wiring.columns.values():
        made[part] = np.max(np.abs(row[part]), initial=0.0)
    return made


def _at_kinks(standing: Standing) -> np.ndarray:
    """Columns along which the load of a contact leaves zero, which it does to one side alone."""
    linear, motion = standing.linear, standing.motion
    columns = standing.instant.wiring.columns["contact_capacity"]
    empty = motion.local.capacity[:, -1] == 0.0
    count = len(linear.states) + len(standing.given)
    return (linear.row[columns][empty][:, :count] != 0.0).any(axis=0)


# of losses, which a linear system has not
SUPPLIES = ("supply_power", "supply_energy")


def mismatch(standing: Standing, step: float = 1e-5) -> float:
    """The largest difference between a linear system and differences, beside the size of its line in the row."""
    rates, rows, valid = differences(standing, step)
    linear, n = standing.linear, len(standing.linear.states)
    sizes = push_sizes(standing, 1.0)
    columns = standing.instant.wiring.columns
    compared = np.ones(len(rows), dtype=bool)
    for part in ("angle", "element_work", "contact_work", "prescribed_work", "meter_energy", "contact_mode", *SUPPLIES):
        compared[columns[part]] = False
    mine = np.vstack([np.hstack([linear.A, linear.B]), linear.row[compared, : n + len(standing.given)]])
    other = np.vstack([rates, rows[compared]])
    now = np.concatenate([[state.rate for state in linear.states], _sizes_of_parts(standing)[compared]])
    error = np.abs(mine - other)[:, valid] * sizes[valid]
    scale = np.max(np.abs(mine)[:, valid] * sizes[valid], axis=1, initial=0.0)
    relative = error / (scale + 1e-3 * np.abs(now) + 1e-6)[:, None]
    return float(relative.max(initial=0.0))
