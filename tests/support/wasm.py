"""Runs of the core as WebAssembly, and of the core that is here.

A job is words of eight bytes that are doubles: how many words the system has and those, five options, how many
stretches, and for each of them a signal to set (-1: none), its segments, the end and the times of rows. The answer has
of each stretch whether the signal was set, the status, how many rows, the rows; then how many numbers of events, and
those. tests/wasm/run.mjs reads and writes that.
"""

from __future__ import annotations

import shutil
import subprocess
from collections.abc import Iterator, Sequence
from typing import Any, NamedTuple

import numpy as np
import pytest
from numpy.typing import NDArray

import clutchwork as cw
from clutchwork.declare.core import core
from clutchwork.declare.layout import EVENTS_FULL
from support.project import ROOT

Array = NDArray[np.float64]
WASM = ROOT / "src" / "clutchwork" / "page" / "static" / "core.wasm"
FOLDER = ROOT / "tests" / "wasm"
OPTIONS = {"rtol": 1e-6, "atol": 1e-8, "method": 0.0, "angles": 1.0, "work": 1.0}


class Stretch(NamedTuple):
    """A part of a run: a signal that is set before it, and the times of its rows, the last one its end [s]."""

    times: Array
    signal: int = -1
    segments: Sequence[Sequence[float]] = ()


class Job(NamedTuple):
    """A run of a system."""

    system: cw.System
    stretches: Sequence[Stretch]
    rtol: float = OPTIONS["rtol"]
    atol: float = OPTIONS["atol"]
    method: int = 0

    def options(self) -> dict[str, float]:
        """What the run is told."""
        return {**OPTIONS, "rtol": self.rtol, "atol": self.atol, "method": float(self.method)}

    def words(self) -> bytes:
        """What the programs read."""
        data = self.system.to_bytes()
        parts: list[Any] = [[len(data) // 8], np.frombuffer(data, "<f8")]
        parts += [list(self.options().values()), [len(self.stretches)]]
        for one in self.stretches:
            rows = np.array(one.segments, dtype=float).reshape(-1, 13)
            parts += [[one.signal, len(rows)], rows[:, 0], rows[:, 1:].ravel()]
            parts += [[one.times[-1], len(one.times)], one.times]
        return b"".join(np.asarray(part, "<f8").tobytes() for part in parts)


class Answer(NamedTuple):
    """What became of a run."""

    set: list[float]
    status: list[float]
    rows: Array
    events: Array


def grid(end: float, count: int = 41, begin: float = 0.0) -> Array:
    """Times of rows [s]."""
    return np.linspace(begin, end, count)


def in_node(jobs: Sequence[Job]) -> list[Answer]:
    """The runs as WebAssembly; a test that needs them is skipped where there is no node."""
    node = shutil.which("node")
    if node is None:
        pytest.skip("node is not installed, which runs WebAssembly")
    if not WASM.is_file():
        pytest.skip("core.wasm was not built: run make wasm")
    output = _called([node, FOLDER / "run.mjs", WASM], jobs)
    assert int.from_bytes(output[:8], "little", signed=True) == core().schema_hash()
    return list(_answers(output[8:], jobs))


def here(jobs: Sequence[Job]) -> list[Answer]:
    """The runs of the installed core."""
    return [_here(job) for job in jobs]


def _called(command: list[Any], jobs: Sequence[Job]) -> bytes:
    done = subprocess.run(
        [*map(str, command), str(EVENTS_FULL)], input=b"".join(map(Job.words, jobs)), capture_output=True, check=False
    )
    assert done.returncode == 0, done.stderr.decode()
    return done.stdout


def _answers(output: bytes, jobs: Sequence[Job]) -> Iterator[Answer]:
    words, at = np.frombuffer(output, "<f8"), 0
    for job in jobs:
        row = core().Run(job.system.to_bytes()).row_size
        heads, rows = [], []
        for _ in job.stretches:
            heads.append(words[at : at + 3])
            count = int(heads[-1][2]) * row
            rows.append(words[at + 3 : at + 3 + count].reshape(-1, row))
            at += 3 + count
        count = int(words[at])
        events = words[at + 1 : at + 1 + count].reshape(-1, 10)
        at += 1 + count
        yield Answer([h[0] for h in heads], [h[1] for h in heads], np.concatenate(rows), events)
    assert at == len(words)


def _here(job: Job) -> Answer:
    run = core().Run(job.system.to_bytes())
    for name, value in job.options().items():
        run.set_option(name, value)
    answer, events = Answer([], [], np.empty((0, run.row_size)), np.empty((0, 10))), []
    for one in job.stretches:
        answer.set.append(set_segments(run, one) if one.signal >= 0 else -1.0)
        rows, done, status = np.empty((len(one.times), run.row_size)), 0, EVENTS_FULL
        while status == EVENTS_FULL:
            status, filled, _ = run.advance(float(one.times[-1]), one.times.copy(), rows, done, 0)
            done += filled
            events.append(np.array(run.events()))
        answer.status.append(status)
        answer = answer._replace(rows=np.concatenate([answer.rows, rows[:done]]))
    return answer._replace(events=np.concatenate(events))


def set_segments(run: Any, one: Stretch) -> float:
    """Whether the core took the segments."""
    rows = np.array(one.segments, dtype=float).reshape(-1, 13)
    try:
        run.set_segments(one.signal, rows[:, 0].copy(), rows[:, 1:].copy())
    except ValueError:
        return 0.0
    return 1.0
