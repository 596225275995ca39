"""Same inputs, same bits: on repeat, in pieces, and after save and restore."""

from __future__ import annotations

import numpy as np
import pytest

from clutchwork import _core
from clutchwork.declare.layout import STATUS
from support import random_drivelines, six_speed

DONE = [name for name, *_ in STATUS].index("done")
FULL = [name for name, *_ in STATUS].index("rows_full")


def new(seed: int | None = None, **options: float) -> _core.Run:
    """A run of the core, over the shift or a random driveline."""
    d = six_speed.gearbox(six_speed.SHIFT) if seed is None else random_drivelines.describe(seed).driveline()
    run = _core.Run(d.assemble().to_bytes())
    for name, value in {"rtol": 1e-6, "atol": 1e-8, **options}.items():
        run.set_option(name, value)
    return run


def grid(run: _core.Run, t_end: float, times: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """(rows, events) of a run over a grid."""
    rows = np.zeros((len(times), len(run.row())))
    status, count = run.advance(t_end, times, rows, 0, False)[:2]
    assert status == DONE
    assert count == len(times)
    return rows, run.events()


@pytest.mark.parametrize("method", [1.0, 2.0])
def test_same_bits_on_repeat(method: float) -> None:
    times = np.linspace(0, 4, 401)
    first, second = (grid(new(method=method), 4.0, times) for _ in range(2))
    assert np.array_equal(first[0], second[0])
    assert np.array_equal(first[1], second[1])


@pytest.mark.parametrize("seed", [None, 0, 4, 6])
def test_output_does_not_change_the_motion(seed: int | None) -> None:
    """Dense output is read, not stepped on: any grid gives the same events and the same end."""
    ends = []
    for count in (2, 17, 1001):
        rows, events = grid(new(seed), 2.0, np.linspace(0, 2, count))
        ends.append((rows[-1], events))
    for rows, events in ends[1:]:
        assert np.array_equal(rows, ends[0][0])
        assert np.array_equal(events, ends[0][1])


@pytest.mark.parametrize("seed", [None, 0, 4])
def test_save_and_restore_are_bit_equal(seed: int | None) -> None:
    """State saved at an arbitrary time and put into a fresh run continues as if nothing had been."""
    times = np.linspace(1.0, 2.0, 101)
    one = new(seed)
    grid(one, 1.0, np.array([1.0]))
    saved = one.save()
    rest = grid(one, 2.0, times)
    other = new(seed)
    other.restore(saved)
    assert other.time == 1.0
    again = grid(other, 2.0, times)
    assert np.array_equal(rest[0], again[0])
    assert np.array_equal(rest[1], again[1])


def test_order_of_building_keeps_the_motion() -> None:
    """Another order of shafts and elements is another arithmetic, but the same motion: 1e-9 at rtol 1e-11."""
    description = random_drivelines.describe(2)
    orders = [tuple(range(len(description.inertia))), tuple(reversed(range(len(description.inertia))))]
    runs = [description.driveline(order).simulate(2.0, dt=0.01, rtol=1e-11, atol=1e-11) for order in orders]
    for i in range(len(description.inertia)):
        scale = np.max(np.abs(runs[0][f"s{i}.speed"]))
        assert np.max(np.abs(runs[0][f"s{i}.speed"] - runs[1][f"s{i}.speed"])) <= 1e-8 * scale


@pytest.mark.parametrize("seed", [None, 4, 15])
@pytest.mark.parametrize("method", [0.0, 1.0, 2.0])
def test_the_room_for_rows_does_not_change_the_steps(seed: int | None, method: float) -> None:
    """A run that is left to make room goes on as if it had not been; seed 15 meets kinks where it is left."""
    found = []
    for room in (30_000, 64):
        run, parts = new(seed, method=method), []
        status = FULL
        while status != DONE:
            times, rows = np.zeros(room), np.zeros((room, run.row_size))
            status, filled = run.advance(2.0, times, rows, 0, 1)[:2]
            run.events()
            parts.append(np.column_stack([times[:filled], rows[:filled]]))
        found.append(np.concatenate(parts))
    assert np.array_equal(*found)
