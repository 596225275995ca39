"""Threads of this process: the core leaves the interpreter free while it runs."""

from __future__ import annotations

from collections.abc import Generator, Iterable
from concurrent.futures import FIRST_COMPLETED, Future, ThreadPoolExecutor, wait
from itertools import islice
from threading import Event
from typing import Any

from clutchwork.base import dataclass
from clutchwork.executors.executor import AHEAD, Stopped, Task


@dataclass(frozen=True)
class Threads:
    """As many threads as workers."""

    workers: int
    name: str = "threads"

    def run(self, task: Task, job: Any, pieces: Iterable[Any]) -> Generator[Any, None, None]:
        """What the task gives for each piece, as they come."""
        end, rest = Event(), iter(pieces)

        def alive() -> None:
            if end.is_set():
                raise Stopped

        with ThreadPoolExecutor(self.workers, "clutchwork") as pool:
            going = set[Future[Any]]()
            try:
                while True:
                    room = self.workers * (1 + AHEAD) - len(going)
                    going |= {pool.submit(task, job, piece, alive) for piece in islice(rest, room)}
                    if not going:
                        return
                    done, going = wait(going, return_when=FIRST_COMPLETED)
                    for one in done:
                        yield one.result()
            finally:
                # Ctrl-C, a mistake, or no further request
                end.set()
                for one in going:
                    one.cancel()

    def close(self) -> None:
        """Nothing is left of it."""
