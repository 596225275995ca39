"""Which executor `on` means."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from clutchwork.base import UseError, quote
from clutchwork.executors.executor import Executor
from clutchwork.executors.on_dask import OnDask
from clutchwork.executors.on_ray import OnRay
from clutchwork.executors.threads import Threads

WAYS = (
    "'ray' or 'dask' for processes on this machine, 'ray://host:10001' or 'host:6379' for a cluster of Ray, "
    "'tcp://host:8786' for one of Dask, or a Client of Dask"
)
DASK = ("tcp://", "tls://", "ucx://", "ws://", "wss://", "inproc://")


@contextmanager
def executor(call: str, on: Any, threads: int, asked: int | None) -> Iterator[Executor]:
    """The workers that `on` means, closed in the end.

    Parameters: threads, how many run at once in this process; asked, how many workers were asked for, None for all
    that there are.
    """
    made = _executor(call, on, threads, asked)
    try:
        yield made
    finally:
        made.close()


def _executor(call: str, on: Any, threads: int, asked: int | None) -> Executor:
    if on is None:
        return Threads(threads)
    if hasattr(on, "scheduler_info") and hasattr(on, "submit"):
        return OnDask(None, asked, on)
    if on == "dask" or (isinstance(on, str) and on.startswith(DASK)):
        return OnDask(None if on == "dask" else on, asked)
    if on in ("ray", "auto") or (isinstance(on, str) and (on.startswith("ray://") or on.rpartition(":")[2].isdigit())):
        return OnRay(None if on == "ray" else on, asked)
    raise UseError(call, [f"on is {quote(on)}: give {WAYS}"])
