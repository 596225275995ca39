"""A progress bar for runs that take long enough to wait for."""

from __future__ import annotations

import sys
from time import perf_counter
from types import TracebackType
from typing import Self

WIDTH = 40
PATIENCE = 0.5  # s of real time before anything is shown
INTERVAL = 0.1  # s of real time between two updates


class Bar:
    """Shows time reached and time left on standard error, on a terminal only."""

    def __init__(self, *, hidden: bool = False) -> None:
        self._hidden = hidden or not sys.stderr.isatty()
        self._started = self._shown = perf_counter()
        self._drawn = False

    def show(self, time: float, t_end: float) -> None:
        """Draw the bar for a run that has reached `time` of `t_end` [s]."""
        now = perf_counter()
        if self._hidden or now - self._started < PATIENCE or now - self._shown < INTERVAL:
            return
        share = min(1.0, time / t_end)
        left = (now - self._started) * (1.0 - share) / share if share > 0.0 else float("inf")
        full = "#" * round(WIDTH * share)
        sys.stderr.write(f"\r[{full:<{WIDTH}}] {time:.4g} of {t_end:.4g} s, {left:.0f} s left \x1b[K")
        sys.stderr.flush()
        self._shown, self._drawn = now, True

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._drawn:
            sys.stderr.write("\r\x1b[K")
            sys.stderr.flush()
