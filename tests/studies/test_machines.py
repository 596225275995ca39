"""Sweeps and studies on Ray and on Dask: the bits of one machine, a worker that is killed is made up for."""

from __future__ import annotations

import os
import signal
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest

import clutchwork as cw
from support import scattered, slow_study

pytest.importorskip("pyarrow")
pytest.importorskip("scipy")
psutil = pytest.importorskip("psutil")
pytestmark = pytest.mark.filterwarnings("ignore")
EXECUTORS = {"ray": "ray", "dask": "distributed"}


@pytest.fixture(params=EXECUTORS)
def on(request: pytest.FixtureRequest) -> Iterator[str]:
    """An executor that leaves no process behind."""
    pytest.importorskip(EXECUTORS[request.param])
    before = set(psutil.Process().children(recursive=True))
    yield request.param
    left = set(psutil.Process().children(recursive=True)) - before
    # multiprocessing keeps one for itself
    own = [one for one in left if "resource_tracker" not in " ".join(one.cmdline())]
    assert psutil.wait_procs(own, 30)[1] == []


def test_a_worker_that_is_killed_is_made_up_for(on: str, tmp_path: Path) -> None:
    """The first worker that has written is killed while it is at its next chunk."""
    killed = list[int]()

    def kill(done: int, _: int) -> None:
        if not killed:
            (name, *_) = cw.Study.load(tmp_path).workers
            killed.append(int(name.rpartition(" ")[2]))
            os.kill(killed[0], signal.SIGKILL)

    found = slow_study.study(tmp_path, on=on, threads=2, progress=kill)
    assert found.complete
    workers = {int(name.rpartition(" ")[2]) for name in found.workers}
    # others took over, and no chunk was written in this process
    assert killed[0] in workers
    assert os.getpid() not in workers
    assert len(workers) >= 2
    assert not psutil.pid_exists(killed[0])
    expected = cw.sweep(scattered.discs(), **slow_study.asked())
    for name in found.names:
        assert found[name].tobytes() == expected[name].tobytes()


@contextmanager
def running(on: str) -> Iterator[Any]:
    """Two workers of somebody else, whom a sweep leaves alone."""
    if on == "ray":
        import ray

        os.environ["RAY_USAGE_STATS_ENABLED"] = "0"
        ray.init(num_cpus=2, include_dashboard=False, log_to_driver=False, object_store_memory=80_000_000)
        try:
            yield "ray"
            assert ray.is_initialized()
        finally:
            ray.shutdown()
    else:
        import distributed

        with (
            distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster,
            distributed.Client(cluster) as client,
        ):
            yield client
            assert client.status == "running"


def test_a_sweep_has_the_same_bits(on: str) -> None:
    outputs = [*scattered.OUTPUTS, cw.at("load.speed", [0.5, 1.0]), "c1.state", lambda run: run.t_end]
    given: dict[str, Any] = {"t_end": 3.0, "vary": scattered.design(200), "outputs": outputs}
    expected, done = cw.sweep(scattered.discs(), **given), list[int]()
    # a rule between two values is seen by the worker that has both
    odd = {"c1.friction.static": [0.2] * 100, "c1.friction.kinetic": [0.1] * 50 + [0.15] * 49 + [0.25]}
    with running(on) as executor:
        found = cw.sweep(scattered.discs(), **given, on=executor, progress=lambda one, _: done.append(one))
        with pytest.raises(cw.ModelError, match="is below the kinetic coefficient"):
            cw.sweep(scattered.discs(), 1.0, vary=cw.variants(odd), outputs="load.speed", on=executor)
    for name in expected.names:
        assert found[name].tobytes() == expected[name].tobytes()
    assert found.codes.tolist() == expected.codes.tolist()
    assert done == sorted(done)
    assert done[-1] == 200
    assert len(done) > 2
