"""The whole run in one loop compiled by numba: Dormand-Prince 5(4) with dense output, events found on it."""

from __future__ import annotations

from functools import cache
from types import SimpleNamespace
from typing import Any

import numpy as np

from benchmarks.peers import equations
from benchmarks.peers.compiled import compiled

C = np.array([0.0, 1 / 5, 3 / 10, 4 / 5, 8 / 9, 1.0, 1.0])
A = np.zeros((7, 6))
A[1, :1] = 1 / 5
A[2, :2] = 3 / 40, 9 / 40
A[3, :3] = 44 / 45, -56 / 15, 32 / 9
A[4, :4] = 19372 / 6561, -25360 / 2187, 64448 / 6561, -212 / 729
A[5, :5] = 9017 / 3168, -355 / 33, 46732 / 5247, 49 / 176, -5103 / 18656
A[6, :6] = 35 / 384, 0.0, 500 / 1113, 125 / 192, -2187 / 6784, 11 / 84
E = np.array([71 / 57600, 0.0, -71 / 16695, 71 / 1920, -17253 / 339200, 22 / 525, -1 / 40])
# the last coefficient of the dense output of fourth order
D = np.array(
    [
        -12715105075 / 11282082432,
        0.0,
        87487479700 / 32700410799,
        -10690763975 / 1880347072,
        701980252875 / 199316789632,
        -1453857185 / 822651844,
        69997945 / 29380423,
    ]
)
N = equations.STATES


def put(t, y, modes, k, into):
    """The right-hand side into an array."""
    into[0], into[1], into[2], into[3], into[4] = slope(t, y, modes, k)  # noqa: F821, of the equations


def step(t, h, y, K, modes, k, into, rtol, atol):
    """One step from the slope K[0]; the norm of its error."""
    for s in range(1, 7):
        for j in range(N):
            total = 0.0
            for i in range(s):
                total += A[s, i] * K[i, j]
            into[j] = y[j] + h * total
        put(t + C[s] * h, into, modes, k, K[s])
    square = 0.0
    for j in range(N):
        total = 0.0
        for i in range(7):
            total += E[i] * K[i, j]
        part = h * total / (atol + rtol * max(abs(y[j]), abs(into[j])))
        square += part * part
    return (square / N) ** 0.5


def prepare(h, y, end, K, R):
    """Coefficients of the dense output."""
    for j in range(N):
        rise = end[j] - y[j]
        bend = h * K[0, j] - rise
        total = 0.0
        for i in range(7):
            total += D[i] * K[i, j]
        R[0, j], R[1, j], R[2, j] = y[j], rise, bend
        R[3, j], R[4, j] = rise - h * K[6, j] - bend, h * total


def between(s, R, into):
    """The state at a share of the step."""
    r = 1.0 - s
    for j in range(N):
        into[j] = R[0, j] + s * (R[1, j] + r * (R[2, j] + s * (R[3, j] + r * R[4, j])))


def first_hit(t, h, y, end, R, modes, k, here):
    """The first guard below zero at the end of a step, and the share of the step at which it falls through zero."""
    hit, share = -1, 1.0
    for i in range(4):
        if not watched(i, modes, k) or guard(i, t + h, end, modes, k) >= 0.0:  # noqa: F821
            continue
        low, high = 0.0, share
        if hit >= 0:
            between(high, R, here)
            if guard(i, t + high * h, here, modes, k) >= 0.0:  # noqa: F821
                continue
        f_low, f_high = guard(i, t, y, modes, k), -1.0  # noqa: F821
        between(high, R, here)
        f_high = guard(i, t + high * h, here, modes, k)  # noqa: F821
        # a guard that starts at zero is looked at a little later
        if f_low <= 0.0:
            low = 1e-6
            between(low, R, here)
            f_low = guard(i, t + low * h, here, modes, k)  # noqa: F821
            if f_low <= 0.0:
                hit, share = i, 0.0
                continue
        side = 0
        for _ in range(60):
            if high - low < 1e-13:
                break
            middle = (low * f_high - high * f_low) / (f_high - f_low)
            between(middle, R, here)
            value = guard(i, t + middle * h, here, modes, k)  # noqa: F821
            if value < 0.0:
                high, f_high = middle, value
                if side == 1:
                    f_low *= 0.5
                side = 1
            else:
                low, f_low = middle, value
                if side == -1:
                    f_high *= 0.5
                side = -1
            if abs(value) < 1e-12:
                low = high = middle
        hit, share = i, high
    return hit, share


def rest(y, modes):
    """Take the round-off of the slip from the speeds of clutches that are locked, one after another."""
    for _ in range(3):
        for i in range(3):
            if modes[i] == 0:
                square, across = 0.0, np.zeros(4)
                for a in range(4):
                    for b in range(4):
                        across[a] += MASS_INVERSE[a][b] * SLIPS[i][b]  # noqa: F821
                    square += SLIPS[i][a] * across[a]  # noqa: F821
                left = slip(i, y)  # noqa: F821
                for a in range(4):
                    y[a] -= across[a] * left / square


def run(rtol, atol, grid, rows, events):
    """The whole run; fills rows at the instants of the grid, and returns the number of steps, events and rows."""
    y, end, here = np.zeros(N), np.zeros(N), np.zeros(N)
    K, R = np.zeros((7, N)), np.zeros((5, N))
    modes = (1, 0, 0, 0)
    steps, happened, filled, h, before = 0, 0, 0, 1e-4, 1e-4
    for k in range(len(KNOTS) - 1):  # noqa: F821
        t, stop = KNOTS[k], KNOTS[k + 1]  # noqa: F821
        put(t, y, modes, k, K[0])
        h, rejected = min(max(h, 1e-4), 5e-3), False
        while t < stop:
            last = t + 1.0001 * h >= stop
            if last:
                h = stop - t
            norm = step(t, h, y, K, modes, k, end, rtol, atol)
            if not norm <= 1.0:
                h *= max(0.2, 0.9 * norm**-0.2)
                rejected = True
                continue
            steps += 1
            prepare(h, y, end, K, R)
            hit, share = first_hit(t, h, y, end, R, modes, k, here)
            reached = stop if last and hit < 0 else t + share * h
            while filled < len(grid) and (grid[filled] < reached or (hit < 0 and grid[filled] <= reached)):
                between((grid[filled] - t) / h, R, here)
                rows[filled] = here
                filled += 1
            if hit < 0:
                y[:] = end
                K[0] = K[6]
                factor = 0.9 * max(norm, 1e-10) ** -0.17 * before**0.04
                before = max(norm, 1e-4)
                h *= min(1.0 if rejected else 5.0, max(0.2, factor))
                rejected = False
            else:
                between(share, R, here)
                y[:] = here
                modes = switched(hit, reached, y, modes, k)  # noqa: F821
                events[happened, 0], events[happened, 1] = reached, hit
                happened += 1
                rest(y, modes)
                put(reached, y, modes, k, K[0])
                h = min(max(h, 1e-4), 1e-3)
            t = reached
    return steps, happened, filled


@cache
def loop() -> Any:
    """The compiled loop; ImportError where numba is not installed."""
    from types import FunctionType

    import numba

    space = {**globals(), **vars(compiled())}
    for function in (put, step, prepare, between, first_hit, rest, run):
        space[function.__name__] = numba.njit(FunctionType(function.__code__, space, function.__name__))
    return SimpleNamespace(**space).run


def solve(rtol: float = 1e-6, grid: Any = None) -> tuple[Any, list[tuple[float, int]]]:
    """States on a grid, and the events."""
    times = np.empty(0) if grid is None else grid
    rows, events = np.empty((len(times), N)), np.empty((64, 2))
    _, happened, filled = loop()(rtol, 1e-2 * rtol, times, rows, events)
    return rows[:filled], [(t, int(i)) for t, i in events[:happened]]
