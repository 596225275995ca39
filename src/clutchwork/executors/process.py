"""What runs in the process of a worker."""

from __future__ import annotations

import warnings
from typing import Any

from clutchwork.base import ModelWarning
from clutchwork.executors.executor import Task, on_and_on


def called(task: Task, job: Any, piece: Any) -> Any:
    """A task in a process of its own."""
    with warnings.catch_warnings():
        # a value may be rarely wanted; that of a single run is given there
        warnings.simplefilter("ignore", ModelWarning)
        return task(job, piece, on_and_on)
