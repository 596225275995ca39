"""Chunks: large enough that the cost of an engine does not show, small enough for all workers to have some."""

from __future__ import annotations

import time
from collections.abc import Generator, Iterable
from typing import Any

import pytest

from clutchwork.executors import pace
from clutchwork.executors.executor import Stopped
from clutchwork.executors.threads import Threads


class Costly:
    """An engine of one worker that needs some milliseconds for each piece."""

    workers = 1
    name = "costly"

    def run(self, task: Any, job: Any, pieces: Iterable[Any]) -> Generator[Any, None, None]:
        for piece in pieces:
            time.sleep(0.02)
            yield task(job, piece, lambda: None)

    def close(self) -> None:
        pass


def test_a_chunk_takes_many_times_what_the_engine_needs(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(pace, "seconds_of_one", lambda run, count: 1e-3)
    assert pace.chunk_size(Costly(), None, 10**6, lambda count: None) >= pace.SHARE * 0.02 / 1e-3
    monkeypatch.setattr(pace, "cost", lambda engine, job: 1e-4)
    assert pace.chunk_size(Threads(2), None, 10**6, lambda count: None) == round(pace.SECONDS / 1e-3)
    # every worker has some, a run of hours is a chunk of its own, and memory is bounded
    assert pace.chunk_size(Threads(2), None, 800, lambda count: None) == 100
    assert pace.chunk_size(Threads(4), None, 10, lambda count: None) == 1
    monkeypatch.setattr(pace, "seconds_of_one", lambda run, count: 1e4)
    assert pace.chunk_size(Threads(2), None, 10**6, lambda count: None) == 1
    monkeypatch.setattr(pace, "seconds_of_one", lambda run, count: 1e-9)
    assert pace.chunk_size(Threads(2), None, 10**9, lambda count: None) == pace.MOST


def test_the_time_of_a_run_is_measured() -> None:
    runs = list[int]()

    def run(count: int) -> None:
        runs.append(count)
        time.sleep(0.01 * count)

    assert pace.seconds_of_one(run, 10**6) >= 0.01
    assert runs == [1, 2, 4, 8, 16, 32][: len(runs)]
    assert pace.seconds_of_one(run, 3) >= 0.01


def test_pieces_are_drawn_when_they_are_needed() -> None:
    drawn = list[int]()

    def pieces() -> Iterable[int]:
        for number in range(1000):
            drawn.append(number)
            yield number

    running = Threads(2).run(lambda job, piece, alive: piece, None, pieces())
    assert len({next(running) for _ in range(10)}) == 10
    assert len(drawn) <= 10 + 2 * 2 + 2
    running.close()
    assert len(drawn) < 20


def test_what_nobody_waits_for_ends() -> None:
    ended = list[str]()

    def task(job: Any, piece: int, alive: Any) -> int:
        if piece == 0:
            return 0
        try:
            while True:
                time.sleep(0.001)
                alive()
        except Stopped:
            ended.append("stopped")
            raise

    running = Threads(3).run(task, None, range(100))
    assert next(running) == 0
    running.close()
    assert ended == ["stopped"] * len(ended) != []


def test_the_error_of_a_piece_is_that_of_the_call() -> None:
    def task(job: Any, piece: int, alive: Any) -> int:
        if piece == 5:
            raise ValueError("of piece 5")
        return piece

    with pytest.raises(ValueError, match="of piece 5"):
        list(Threads(2).run(task, None, range(100)))
