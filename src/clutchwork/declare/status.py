"""How a run of the core ended, by the numbers of the layout."""

from __future__ import annotations

from clutchwork.declare.layout import STATUS

NAMES = [name for name, *_ in STATUS]
DONE, ROWS_FULL, EVENTS_FULL, NOT_FINITE, INTERRUPTED = (
    NAMES.index(name) for name in ("done", "rows_full", "events_full", "not_finite", "interrupted")
)
