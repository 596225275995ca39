"""The 3-4 shift by hand: its equations in plain Python, which numba can compile as they stand.

The data are those of tests/support/six_speed.py. States are the speeds w1, w2, w4, w8 [rad/s] and the torque of the
elastic shaft [N m]. The mode of a clutch is 0 while it is locked, else the sign of its slip; the last mode is the
branch of the engine. Between two knots of the pressures, a stretch, all is smooth.
"""

from __future__ import annotations

from itertools import product
from math import exp, tanh
from typing import Any

import numpy as np

from support import six_speed

NAMES = ("F1", "F2", "F4")
SPEEDS = ("w1", "w2", "w4", "w8")
STATES = 5
# third gear at rest: F1 is open, F2 and F4 are locked
START: tuple[int, int, int, int] = (1, 0, 0, 0)


def _table(array: Any) -> tuple[Any, ...]:
    """Nested tuples: quick to read for Python, constants for numba."""
    return tuple(_table(row) if np.ndim(row) else float(row) for row in array)


def _kinematics() -> tuple[np.ndarray, np.ndarray]:
    """Speeds of all eight members, and slips of the clutches, over the four independent speeds."""
    members = list(six_speed.INERTIA)
    rows = np.zeros((4, 8))
    gears = (("w3", "w1", "w2", six_speed.K1), ("w4", "w5", "w6", six_speed.K2))
    gears += (("w4", "w6", "w8", six_speed.K3), ("w6", "w7", "w8", six_speed.K4))
    for row, (sun, ring, carrier, ratio) in zip(rows, gears, strict=True):
        for name, factor in ((sun, 1.0), (ring, ratio), (carrier, -1.0 - ratio)):
            row[members.index(name)] += factor
    kept = [members.index(name) for name in SPEEDS]
    rest = [place for place in range(8) if place not in kept]
    basis = np.zeros((8, 4))
    basis[kept] = np.eye(4)
    basis[rest] = -np.linalg.solve(rows[:, rest], rows[:, kept])
    basis_of = {"housing": np.zeros(4), **{name: basis[place] for place, name in enumerate(members)}}
    return basis, np.array([basis_of[b] - basis_of[a] for a, b in (six_speed.CLUTCHES[name] for name in NAMES)])


def _locked_sets(inverse: np.ndarray, slips: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Accelerations, and torques of the locked clutches, per applied torque: for each set of locked clutches."""
    accelerations, multipliers = np.zeros((8, 4, 4)), np.zeros((8, 3, 4))
    for number, flags in enumerate(product((False, True), repeat=3)):
        chosen = list(np.flatnonzero(flags))
        rows = slips[chosen]
        multipliers[number, chosen] = np.linalg.solve(rows @ inverse @ rows.T, rows @ inverse)
        accelerations[number] = inverse - inverse @ rows.T @ multipliers[number, chosen]
    return accelerations, multipliers


def _stretches() -> tuple[list[float], np.ndarray, np.ndarray]:
    """Knots of the pressures, and in each stretch between them the pressures at its start and their slopes."""
    tables = [np.array(six_speed.SHIFT[name]) for name in NAMES]
    knots = sorted({float(t) for table in tables for t, _ in table} | {0.0, T_END})
    values = np.array([[np.interp(t, *table.T) for table in tables] for t in knots])
    return knots, values[:-1], np.diff(values, axis=0) / np.diff(knots)[:, None]


T_END = 4.0
_BASIS, _SLIPS = _kinematics()
_MASS = _BASIS.T @ np.diag(list(six_speed.INERTIA.values())) @ _BASIS
_INVERSE = np.linalg.inv(_MASS)
_KNOTS, _PRESSURES, _SLOPES = _stretches()

MASS_INVERSE, SLIPS = _table(_INVERSE), _table(_SLIPS)
ACCELERATIONS, MULTIPLIERS = map(_table, _locked_sets(_INVERSE, _SLIPS))
KNOTS, PRESSURES, SLOPES = _table(_KNOTS), _table(_PRESSURES), _table(_SLOPES)
GAINS = tuple(six_speed.GAIN[name] for name in NAMES)
STIFFNESS, DAMPING, STATIC, KNEE = six_speed.STIFFNESS, six_speed.DAMPING, six_speed.STATIC, six_speed.KNEE
FAST, MORE, RATE = six_speed.LAW["fast"], six_speed.LAW["slow"] - six_speed.LAW["fast"], 1.0 / six_speed.LAW["speed"]


def set_of(modes: Any) -> int:
    """Number of the set of clutches that are locked."""
    return 4 * (modes[0] == 0) + 2 * (modes[1] == 0) + (modes[2] == 0)


def slip(i: int, y: Any) -> float:
    """Slip of a clutch [rad/s]."""
    return SLIPS[i][0] * y[0] + SLIPS[i][1] * y[1] + SLIPS[i][2] * y[2] + SLIPS[i][3] * y[3]


def pressure(i: int, t: float, k: int) -> float:
    """Pressure of a clutch [Pa] in a stretch."""
    return PRESSURES[k][i] + SLOPES[k][i] * (t - KNOTS[k])


def applied(t: float, y: Any, modes: Any, k: int) -> Any:
    """Applied torques over the independent speeds [N m]."""
    shaft = y[4] + DAMPING * (y[1] - y[2])
    q0 = 4000.0 - 4.7746 * y[0] if modes[3] == 0 else 3000.0 - 190.9859 * (y[0] - KNEE)
    q1, q2, q3 = -shaft, shaft, -4000.0 * tanh(2.0 * y[3])
    for i in range(3):
        pressed = pressure(i, t, k)
        if modes[i] != 0 and pressed > 0.0:
            sliding = FAST + MORE * exp(min(20.0, -RATE * modes[i] * slip(i, y)))
            torque = modes[i] * GAINS[i] * pressed * sliding
            q0 -= SLIPS[i][0] * torque
            q1 -= SLIPS[i][1] * torque
            q2 -= SLIPS[i][2] * torque
            q3 -= SLIPS[i][3] * torque
    return q0, q1, q2, q3


def product_with(row: Any, q: Any) -> float:
    """Sum over the independent speeds."""
    return row[0] * q[0] + row[1] * q[1] + row[2] * q[2] + row[3] * q[3]


def slope(t: float, y: Any, modes: Any, k: int) -> Any:
    """Right-hand side."""
    q, a = applied(t, y, modes, k), ACCELERATIONS[set_of(modes)]
    d0, d1 = product_with(a[0], q), product_with(a[1], q)
    return d0, d1, product_with(a[2], q), product_with(a[3], q), STIFFNESS * (y[1] - y[2])


def watched(i: int, modes: Any, k: int) -> bool:
    """Whether the guard of a clutch, or of the engine, means anything: not of a clutch that is open all the time."""
    return i == 3 or modes[i] == 0 or PRESSURES[k][i] != 0.0 or SLOPES[k][i] != 0.0


def guard(i: int, t: float, y: Any, modes: Any, k: int) -> float:
    """What falls through zero at an event: the slip, what a locked clutch could hold more, the way to the knee."""
    if i == 3:
        return KNEE - y[0] if modes[3] == 0 else y[0] - KNEE
    if modes[i] != 0:
        return modes[i] * slip(i, y)
    held = product_with(MULTIPLIERS[set_of(modes)][i], applied(t, y, modes, k))
    return GAINS[i] * STATIC * pressure(i, t, k) - abs(held)


def with_mode(modes: Any, i: int, mode: int) -> Any:
    """The same modes but one."""
    a, b, c, d = modes[0], modes[1], modes[2], modes[3]
    return (mode if i == 0 else a, mode if i == 1 else b, mode if i == 2 else c, mode if i == 3 else d)


def switched(i: int, t: float, y: Any, modes: Any, k: int) -> Any:
    """The modes after an event."""
    if i == 3:
        return with_mode(modes, 3, 1 - modes[3])
    if modes[i] == 0:
        held = product_with(MULTIPLIERS[set_of(modes)][i], applied(t, y, modes, k))
        return with_mode(modes, i, 1 if held > 0.0 else -1)
    trial = with_mode(modes, i, 0)
    needed = abs(product_with(MULTIPLIERS[set_of(trial)][i], applied(t, y, trial, k)))
    return trial if needed <= GAINS[i] * STATIC * pressure(i, t, k) else with_mode(modes, i, -modes[i])


# in the order in which each needs those above it
FUNCTIONS = (set_of, slip, pressure, product_with, applied, slope, watched, guard, with_mode, switched)
