"""What a search found so far, in a file, from which the same search goes on."""

from __future__ import annotations

import hashlib
import json
import time
from collections.abc import Iterable
from pathlib import Path
from threading import Lock
from typing import TYPE_CHECKING, Any

import numpy as np

from clutchwork.base import UseError
from clutchwork.base.writing import put
from clutchwork.calibration.outcome import Outcome

if TYPE_CHECKING:
    from clutchwork.calibration.problem import CalibrationProblem

FORMAT = "clutchwork calibration 2"
# s between two writings
PAUSE = 1.0


class Checkpoint:
    """Nothing is kept where there is no file."""

    def __init__(self, path: Path | None, problem: CalibrationProblem, settings: Iterable[Any]) -> None:
        self.path, self.lock, self.written = path, Lock(), 0.0
        self.key = _key(problem, settings)
        self.before = _read(path, self.key) if path is not None and path.exists() else {}

    def outcome(self, number: int) -> Outcome | None:
        """What a start led to in an earlier call."""
        return self.before.get(number)

    def keep(self, outcomes: Iterable[Outcome], *, now: bool = False) -> None:
        """Write what was found; now and then, or at once."""
        if self.path is None:
            return
        with self.lock:
            if not now and time.monotonic() - self.written < PAUSE:
                return
            self.written = time.monotonic()
            found = self.before | {one.number: one for one in list(outcomes)}
            data = {"format": FORMAT, "key": self.key, "starts": [_plain(one) for one in found.values()]}
            put(self.path, json.dumps(data, indent=1))


def _key(problem: CalibrationProblem, settings: Iterable[Any]) -> str:
    """The same for the same search alone."""
    parts = (problem.system.to_bytes(), *(repr(one).encode() for one in (*problem.identity, *settings)))
    return hashlib.sha256(b"\0".join(parts)).hexdigest()


def _plain(one: Outcome) -> dict[str, Any]:
    lists = {name: getattr(one, name).tolist() for name in ("start", "x")}
    names = ("number", "goal", "violation", "ended", "runs", "fault", "whole", "iterations", "residual")
    numbers = {name: getattr(one, name) for name in names}
    return {**numbers, **lists, "scales": list(one.scales), "samples": [sample.tolist() for sample in one.samples]}


def _read(path: Path, key: str) -> dict[int, Outcome]:
    remedy = "give another file, or remove it to start again"
    try:
        data = json.loads(path.read_text(encoding="utf-8"))
        fits = data["format"] == FORMAT
        other = fits and data["key"] != key
        found = [_outcome(one) for one in data["starts"]] if fits else []
    except (OSError, ValueError, KeyError, TypeError):
        fits, other, found = False, False, []
    if not fits:
        raise UseError("calibrate", [f"file {str(path)!r} holds no calibration; {remedy}"])
    if other:
        raise UseError("calibrate", [f"file {str(path)!r} belongs to another model, goal, limit or setting; {remedy}"])
    return {one.number: one for one in found}


def _outcome(data: dict[str, Any]) -> Outcome:
    arrays = {name: np.array(data[name], dtype=float) for name in ("start", "x")}
    samples = tuple(np.array(one, dtype=float) for one in data["samples"])
    return Outcome(**{**data, **arrays, "scales": tuple(data["scales"]), "samples": samples})
