"""Dask: processes on this machine or on those of a cluster."""

from __future__ import annotations

import logging
from collections.abc import Generator, Iterable
from itertools import islice
from typing import Any

from clutchwork.base.extras import need
from clutchwork.executors.executor import AHEAD, TRIES, ExecutorError, Task
from clutchwork.executors.process import called


class OnDask:
    """Workers of Dask, one for each of its threads."""

    name = "Dask"

    def __init__(self, address: str | None, workers: int | None, client: Any = None) -> None:
        self._dask = need("distributed", "dask", "on='dask'")
        self._cluster: Any = None
        self._own = client is None
        self._client = client if client is not None else self._connected(address, workers)
        self._workers = workers or max(1, sum(self._client.nthreads().values()))

    def _connected(self, address: str | None, workers: int | None) -> Any:
        if address is None:
            quiet: dict[str, Any] = {"dashboard_address": None, "silence_logs": logging.ERROR}
            self._cluster = self._dask.LocalCluster(n_workers=workers, threads_per_worker=1, processes=True, **quiet)
        try:
            return self._dask.Client(self._cluster or address, set_as_default=False)
        except (OSError, ValueError) as error:
            remedy = "check the address that the scheduler said when it began: tcp://host:8786"
            raise ExecutorError(f"Dask cannot be had at {address}: {error}; {remedy}") from error

    @property
    def workers(self) -> int:
        """How many pieces are worked on at once."""
        return self._workers

    def run(self, task: Task, job: Any, pieces: Iterable[Any]) -> Generator[Any, None, None]:
        """What the task gives for each piece, as they come; Dask gives those of a dead worker to another."""
        rest, coming = iter(pieces), self._dask.as_completed(loop=self._client.loop)
        going = set[Any]()
        try:
            while True:
                room = self._workers * (1 + AHEAD) - len(going)
                new = [self._client.submit(called, task, job, piece, pure=False) for piece in islice(rest, room)]
                coming.update(new)
                going.update(new)
                if not going:
                    return
                done = next(coming)
                going.discard(done)
                yield self._got(done)
        finally:
            self._client.cancel(list(going))

    def _got(self, done: Any) -> Any:
        """A result, or the error of the task itself."""
        try:
            return done.result()
        except self._dask.KilledWorker as error:
            raise ExecutorError(f"workers of Dask died {TRIES} times at one chunk: {error}") from error

    def close(self) -> None:
        """End a cluster or a connection of our own."""
        if self._own:
            self._client.close()
            if self._cluster is not None:
                self._cluster.close()
