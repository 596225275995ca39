"""Ray: processes on this machine or on those of a cluster."""

from __future__ import annotations

import os
from collections.abc import Generator, Iterable
from itertools import islice
from typing import Any

from clutchwork.base.extras import need
from clutchwork.executors.executor import AHEAD, TRIES, ExecutorError, Task
from clutchwork.executors.process import called

# of the store of a cluster of our own; results are small
STORE = 100_000_000  # bytes


class OnRay:
    """Workers of Ray, one for each of its processors."""

    name = "Ray"

    def __init__(self, address: str | None, workers: int | None) -> None:
        # no usage reports and no open port unless the user wants them
        os.environ.setdefault("RAY_USAGE_STATS_ENABLED", "0")
        os.environ.setdefault("RAY_ACCEL_ENV_VAR_OVERRIDE_ON_ZERO", "0")
        self._ray = need("ray", "ray", "on='ray'")
        self._own = not self._ray.is_initialized()
        if self._own:
            self._begin(address, workers)
        self._workers = workers or max(1, int(self._ray.cluster_resources().get("CPU", 1)))

    def _begin(self, address: str | None, workers: int | None) -> None:
        quiet: dict[str, Any] = {"log_to_driver": False, "logging_level": "error"}
        local: dict[str, Any] = {"num_cpus": workers, "include_dashboard": False, "object_store_memory": STORE}
        try:
            self._ray.init(**quiet, **(local if address is None else {"address": address}))
        except (ConnectionError, RuntimeError, ValueError, OSError) as error:
            where = "on this machine" if address is None else f"at {address}"
            remedy = "check that it runs: ray status" if address else "look at its log below /tmp/ray"
            raise ExecutorError(f"Ray cannot be had {where}: {error}; {remedy}") from error

    @property
    def workers(self) -> int:
        """How many pieces are worked on at once."""
        return self._workers

    def run(self, task: Task, job: Any, pieces: Iterable[Any]) -> Generator[Any, None, None]:
        """Yield the result of each piece as it completes; Ray moves the pieces of a worker that died to another one."""
        ray, rest = self._ray, iter(pieces)
        call = ray.remote(num_cpus=1, max_retries=TRIES - 1)(called)
        shared, going = ray.put(job), list[Any]()
        try:
            while True:
                room = self._workers * (1 + AHEAD) - len(going)
                going += [call.remote(task, shared, piece) for piece in islice(rest, room)]
                if not going:
                    return
                (done,), going = ray.wait(going, num_returns=1)
                yield self._got(done)
        finally:
            for one in going:
                ray.cancel(one, force=True)

    def _got(self, done: Any) -> Any:
        """A result, or the error of the task itself."""
        errors = self._ray.exceptions
        try:
            return self._ray.get(done)
        except errors.RayTaskError as error:
            raise error.cause from None
        except (errors.WorkerCrashedError, errors.OutOfMemoryError, errors.NodeDiedError) as error:
            raise ExecutorError(f"workers of Ray died {TRIES} times at one chunk: {error}") from error

    def close(self) -> None:
        """End a cluster or a connection of our own."""
        if self._own:
            self._ray.shutdown()
