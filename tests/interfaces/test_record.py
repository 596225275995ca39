"""The loop over the core, on a stand-in for it: buffers, controllers, failures."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from clutchwork.declare.layout import DONE, INTERRUPTED
from clutchwork.run import record as module
from clutchwork.run.control import Control, Controller
from clutchwork.run.record import Recording, record
from clutchwork.run.simulation import refined
from clutchwork.run.trajectory import SimulationError

Make = Callable[..., Any]


def channels() -> Any:
    return {}


def recorded(run: Any, t_end: float, grid: np.ndarray | None = None, *controllers: Controller) -> Recording:
    recording = Recording(run)
    record(recording, t_end, grid, Control(controllers, channels), None)
    return recording


def test_steps_with_both_limits_at_an_event(fake_run: Make) -> None:
    made = recorded(fake_run(), 0.5)
    assert made.status == DONE
    assert made.times == pytest.approx([0, 0.1, 0.2, 0.25, 0.25, 0.35, 0.45, 0.5])
    assert made.rows[:, 0] == pytest.approx(made.times)
    assert made.events.shape == (1, 10)


def test_buffers_grow_without_losing_rows(fake_run: Make, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(module, "FIRST_CHUNK", 3)
    made = recorded(fake_run(), 20.0)
    assert len(made.times) == pytest.approx(202, abs=2)
    assert np.all(np.diff(made.times) >= 0.0)
    assert made.rows[:, 0] == pytest.approx(made.times)


def test_a_given_grid_is_kept_when_the_events_must_be_drained(fake_run: Make) -> None:
    grid = np.linspace(0.0, 1.0, 21)
    made = recorded(fake_run(room=50), 1.0, grid)
    assert np.array_equal(made.times, grid)
    assert made.rows[:, 0] == pytest.approx(grid)


def test_a_failure_keeps_what_was_computed(fake_run: Make) -> None:
    made = recorded(fake_run(fail_at=0.3), 1.0)
    assert made.status == 4
    assert made.times[-1] == pytest.approx(0.35)


def test_a_signal_at_the_very_end_of_a_call_is_heard(fake_run: Make) -> None:
    class Late(fake_run):  # type: ignore[misc, valid-type]
        def advance(self, *asked: Any) -> Any:
            status, filled, _ = super().advance(*asked)
            return status, filled, KeyboardInterrupt()

    made = recorded(Late(), 0.5)
    assert made.status == INTERRUPTED
    assert isinstance(made.raised, KeyboardInterrupt)
    assert made.times[-1] == pytest.approx(0.5)


def controller(function: object, period: float = 0.2) -> Controller:
    return Controller("c1.pressure", 0, period, function)  # type: ignore[arg-type]


def test_a_controller_is_called_at_its_period_and_its_value_is_held(fake_run: Make) -> None:
    called: list[float] = []

    def law(time: float, readings: object) -> float:
        called.append(time)
        return 1.0 if time < 0.3 else 5.0

    grid = np.array([0.0, 0.1, 0.4, 0.4, 0.5, 1.0])
    made = recorded(fake_run(), 1.0, grid, controller(law))
    assert called == pytest.approx([0.0, 0.2, 0.4, 0.6, 0.8])
    assert np.array_equal(made.times, grid)
    # x grows by 1 per second up to 0.4 s and by 5 after; at 0.4 s both limits of the input stand
    assert made.rows[:, 0] == pytest.approx([0.0, 0.1, 0.4, 0.4, 0.9, 3.4])
    assert made.rows[:, 1] == pytest.approx([1.0, 1.0, 1.0, 5.0, 5.0, 5.0])


def test_steps_show_both_limits_where_a_controller_acts(fake_run: Make) -> None:
    made = recorded(fake_run(), 0.4, None, controller(lambda t, r: 1.0 + t))
    at = np.flatnonzero(np.isclose(made.times, 0.2))
    assert made.rows[at, 1] == pytest.approx([1.0, 1.2])


def test_decisions_are_replayed_not_asked_for_again(fake_run: Make) -> None:
    count = 0

    def law(time: float, readings: object) -> float:
        nonlocal count
        count += 1
        return float(count)

    control = Control((controller(law),), channels)
    first, second = Recording(fake_run()), Recording(fake_run())
    record(first, 1.0, None, control, None)
    record(second, 1.0, None, control, None)
    assert count == 5
    assert np.array_equal(first.rows, second.rows)


def test_a_controller_that_raises_or_returns_no_number_names_itself_and_the_time(fake_run: Make) -> None:
    with pytest.raises(SimulationError, match=r"'c1.pressure' failed at 0.2 s: ZeroDivisionError"):
        recorded(fake_run(), 1.0, None, controller(lambda t, r: 1.0 if t < 0.1 else 1 / 0))
    with pytest.raises(SimulationError, match=r"returned nan at 0 s: return a finite number"):
        recorded(fake_run(), 1.0, None, controller(lambda t, r: float("nan")))


def test_instants_of_two_controllers_are_merged() -> None:
    control = Control((controller(None, 0.1), controller(None, 0.15)), channels)
    assert list(control.stops(0.0, 0.5)) == pytest.approx([0.1, 0.15, 0.2, 0.3, 0.4, 0.45, 0.5])
    assert list(control.stops(0.2, 0.41)) == pytest.approx([0.3, 0.4, 0.41])


def test_refining_keeps_steps_and_doubled_instants() -> None:
    steps = np.array([0.0, 0.3, 0.3, 1.0])
    finer = refined(steps, 0.1, np.array([0.3, 0.77]))
    assert np.all(np.isin([*steps, 0.77], finer))
    assert np.count_nonzero(finer == 0.3) == 2
    assert np.count_nonzero(finer == 0.77) == 2
    assert np.max(np.diff(finer)) <= 0.1 + 1e-12
