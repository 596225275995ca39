"""What all executors have in common: workers that call one function with one job and many pieces."""

from __future__ import annotations

from collections.abc import Callable, Generator, Iterable
from typing import Any, Protocol, TypeAlias

from clutchwork.base import ClutchworkError

# raises where the work is to end early
Alive: TypeAlias = Callable[[], None]
# called with the job, a piece of it, and what says whether to go on
Task: TypeAlias = Callable[[Any, Any, Alive], Any]
# pieces that wait at each worker beside the one it works on, so that it never waits for the next
AHEAD = 1
# how often a piece is tried whose worker dies
TRIES = 4


class Executor(Protocol):
    """Workers that are there until the executor is closed."""

    @property
    def name(self) -> str:
        """What to call it."""

    @property
    def workers(self) -> int:
        """How many pieces are worked on at once."""

    def run(self, task: Task, job: Any, pieces: Iterable[Any]) -> Generator[Any, None, None]:
        """Results of the task in the order of completion; a piece whose worker dies is run by another worker.

        Pieces are drawn when a worker is about to be free, so they may be many.
        """

    def close(self) -> None:
        """End what was started."""


class ExecutorError(ClutchworkError, RuntimeError):
    """Workers that cannot be had, or that die again and again."""


class Stopped(Exception):  # noqa: N818, it is caught where it is raised
    """Drop work whose result is no longer needed."""


def on_and_on() -> None:
    """Processes are ended from outside."""
