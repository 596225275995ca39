"""A stand-in for a run of the compiled core: one number that grows with the rate that input 0 sets."""

from __future__ import annotations

import numpy as np
import pytest

from clutchwork.declare.layout import DONE, EVENT, EVENTS_FULL, ROWS_FULL


class FakeRun:
    """State x with dx/dt = input; steps of 0.1 s; an event at 0.25 s; row = (x, input)."""

    STEP, EVENT_AT = 0.1, 0.25
    row_size = 2

    def __init__(self, *, fail_at: float = float("inf"), room: int = 10_000) -> None:
        self.time, self.x, self.rate = 0.0, 0.0, 1.0
        self.fail_at, self.room, self.stalled = fail_at, room, False
        self._events: list[list[float]] = []
        self.calls: list[float] = []

    def set_input(self, index: int, value: float) -> None:
        assert index == 0
        self.rate = value

    def row(self) -> np.ndarray:
        return np.array([self.x, self.rate])

    def events(self) -> np.ndarray:
        drained = np.array(self._events, dtype=float).reshape(-1, len(EVENT))
        self._events, self.stalled = [], False
        return drained

    def detail(self) -> tuple[int, float, float, int]:
        return 0, self.time, float("nan"), -1

    def statistics(self) -> dict[str, float]:
        return {"steps": 1.0}

    def advance(
        self, t_end: float, times: np.ndarray, rows: np.ndarray, first: int, steps: bool
    ) -> tuple[int, int, None]:
        return *self._advance(t_end, times, rows, first, steps), None

    def _advance(self, t_end: float, times: np.ndarray, rows: np.ndarray, first: int, steps: bool) -> tuple[int, int]:
        self.calls.append(t_end)
        assert not self.stalled, "events were not drained"
        if not steps:
            return self._grid(t_end, times, rows, first)
        n = first
        if self.time == 0.0 and n == 0:
            times[n], rows[n] = 0.0, self.row()
            n += 1
        while self.time < t_end:
            if n + 2 > min(len(times), self.room):
                return ROWS_FULL, n - first
            if self.time >= self.fail_at:
                return 4, n - first
            before = self.time
            self._go(min(t_end, self.time + self.STEP, self.EVENT_AT if before < self.EVENT_AT else t_end))
            times[n], rows[n] = self.time, self.row()
            n += 1
            if self.time == self.EVENT_AT:
                self._events.append([self.time, 0, 1, 0, 1, 0.0, -1.0, -2.0, 3.0, 3.0])
                times[n], rows[n] = self.time, self.row()
                n += 1
        return DONE, n - first

    def _grid(self, t_end: float, times: np.ndarray, rows: np.ndarray, first: int) -> tuple[int, int]:
        n = first
        while n < len(times) and times[n] <= t_end:
            self._go(float(times[n]))
            rows[n] = self.row()
            n += 1
            if self.time >= self.EVENT_AT and not self.stalled and n < len(times) and self.room < 100:
                self.stalled, self.room = True, 10_000
                return EVENTS_FULL, n - first
        self._go(t_end)
        return DONE, n - first

    def _go(self, time: float) -> None:
        self.x += self.rate * (time - self.time)
        self.time = time


@pytest.fixture
def fake_run() -> type[FakeRun]:
    """The class of the stand-in."""
    return FakeRun
