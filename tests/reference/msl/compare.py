"""Comparison of a run with reference.csv, as CONVENTIONS.md of the cases tells."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from .model import Model

# event times of the reference are good to 5e-6 s (CONVENTIONS.md)
TIME = 5e-6
# what no reference resolves, whatever the size of a signal (CONVENTIONS.md)
FLOOR = 1e-9


@dataclass(frozen=True)
class Mismatch:
    """The worst place of one column."""

    column: str
    time: float
    ours: float
    reference: float
    error: float  # as part of the tolerance: above 1 is too much

    def __str__(self) -> str:
        values = f"{self.ours:.9g} against {self.reference:.9g}"
        return f"{self.column} at {self.time:.6f} s: {values}, {self.error:.2f} x tolerance"


def twice(times: np.ndarray) -> np.ndarray:
    """Rows of an instant that stands twice: an event of the reference."""
    same = np.diff(times) <= 1e-9
    return np.concatenate([[False], same]) | np.concatenate([same, [False]])


def grid(times: np.ndarray) -> np.ndarray:
    """Times to ask for: those of the reference, and 5e-6 s either side of its events."""
    events = times[twice(times)]
    return np.unique(
        np.concatenate([times, np.clip(events - TIME, 0, times[-1]), np.clip(events + TIME, 0, times[-1])])
    )


def signals(
    run: Any, model: Model, times: np.ndarray, columns: dict[str, np.ndarray], tolerance: float
) -> list[Mismatch]:
    """Columns that miss the reference by more than tolerance x their own full scale."""
    found = []
    for name, output in model.outputs.items():
        ours = _sampler(run.time, output(run))
        reference = columns[name]
        error = np.abs(ours(times) - reference)
        at_event = twice(times)
        for shift in (-TIME, TIME):
            moved = np.abs(ours(np.clip(times + shift, 0, times[-1])) - reference)
            error = np.where(at_event, np.minimum(error, moved), error)
        worst = int(np.argmax(error))
        ratio = float(error[worst] / max(tolerance * float(np.max(np.abs(reference))), FLOOR))
        if ratio > 1:
            found.append(
                Mismatch(name, times[worst], float(ours(times[worst : worst + 1])[0]), reference[worst], ratio)
            )
    return found


def _sampler(time: np.ndarray, values: np.ndarray) -> Callable[[np.ndarray], np.ndarray]:
    """Values at times that stand in the grid; of an instant that stands twice the right limit."""

    def at(wanted: np.ndarray) -> np.ndarray:
        place = np.clip(np.searchsorted(time, wanted + 1e-12, side="right") - 1, 0, len(time) - 1)
        return values[place]

    return at


def effective_modes(columns: dict[str, np.ndarray], contact: str) -> np.ndarray | None:
    """Mode of the reference, the instant of starting counted as sliding; 0 also for a stuck one-way clutch."""
    if f"{contact}.stuck" in columns:
        return np.where(columns[f"{contact}.stuck"] > 0.5, 0, 1)
    if f"{contact}.mode" not in columns:
        return None
    mode = columns[f"{contact}.mode"].copy()
    # without the flags of starting the mode stands alone: it is 0 until the slip has left zero
    for flag, sign in (("startForward", 1), ("startBackward", -1)):
        if f"{contact}.{flag}" in columns:
            mode[(mode == 0) & (columns[f"{contact}.{flag}"] > 0.5)] = sign
    return mode


def modes(run: Any, contact: str, times: np.ndarray, reference: np.ndarray) -> list[str]:
    """Rows whose mode differs although no event of ours or theirs is within 5e-6 s."""
    ours = _sampler(run.time, run[f"{contact}.mode"])(times)
    switches = np.array([e.time for e in run.events.of(contact)] + [0.0])
    jumps = times[1:][np.diff(reference) != 0]
    near = np.min(np.abs(times[:, None] - np.concatenate([switches, jumps])[None, :]), axis=1) <= TIME
    bad = np.flatnonzero((ours != reference) & ~near)
    return [f"{contact} at {times[i]:.6f} s: mode {ours[i]:g} against {reference[i]:g}" for i in bad[:3]]


def changes(run: Any, contact: str, times: np.ndarray, reference: np.ndarray) -> list[str]:
    """Changes of mode of the reference that have no event of ours within 5e-6 s, and the other way round."""
    places = np.flatnonzero(np.diff(reference) != 0)
    # a clutch that opens or closes while it slips is no event of ours: its torque passes zero
    places = [i for i in places if 0 in (reference[i], reference[i + 1]) or 2 not in (reference[i], reference[i + 1])]
    # the change lies between two rows of the reference; an event of it stands twice, so the bracket is narrow
    # what it does so early belongs to its start
    theirs = [(times[i], times[i + 1]) for i in places if times[i] > TIME]
    ours = [e.time for e in run.events.of(contact).changes()]
    lost = [a for a, b in theirs if not any(a - TIME <= t <= b + TIME for t in ours)]
    added = [t for t in ours if 0 < t < times[-1] and not any(a - TIME <= t <= b + TIME for a, b in theirs)]
    return [f"{contact}: no event of ours at {t:.7f} s" for t in lost] + [
        f"{contact}: our event at {t:.7f} s is not in the reference" for t in added
    ]
