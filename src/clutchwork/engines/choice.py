"""Which engine `on` means."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from clutchwork.base.errors import UseError
from clutchwork.base.shown import shown
from clutchwork.engines.engine import Engine
from clutchwork.engines.threads import Threads

WAYS = (
    "'ray' or 'dask' for processes on this machine, 'ray://host:10001' or 'host:6379' for a cluster of Ray, "
    "'tcp://host:8786' for one of Dask, or a Client of Dask"
)
DASK = ("tcp://", "tls://", "ucx://", "ws://", "wss://", "inproc://")


@contextmanager
def engine(call: str, on: Any, threads: int, asked: int | None) -> Iterator[Engine]:
    """The workers that `on` means, closed in the end.

    Parameters: threads, how many run at once in this process; asked, how many workers were asked for, None for all
    that there are.
    """
    made = _engine(call, on, threads, asked)
    try:
        yield made
    finally:
        made.close()


def _engine(call: str, on: Any, threads: int, asked: int | None) -> Engine:
    if on is None:
        return Threads(threads)
    if hasattr(on, "scheduler_info") and hasattr(on, "submit"):
        from clutchwork.engines.on_dask import OnDask

        return OnDask(None, asked, on)
    if on == "dask" or (isinstance(on, str) and on.startswith(DASK)):
        from clutchwork.engines.on_dask import OnDask

        return OnDask(None if on == "dask" else on, asked)
    if on in ("ray", "auto") or (isinstance(on, str) and (on.startswith("ray://") or on.rpartition(":")[2].isdigit())):
        from clutchwork.engines.on_ray import OnRay

        return OnRay(None if on == "ray" else on, asked)
    raise UseError(call, [f"on is {shown(on)}: give {WAYS}"])
