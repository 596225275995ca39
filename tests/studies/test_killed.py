"""A study whose process is killed goes on: what was written stays, at most a chunk of each worker is lost."""

from __future__ import annotations

import os
import subprocess
import sys
import time
from pathlib import Path

import pytest

import clutchwork as cw
from support import scattered, slow_study
from support.project import ROOT

pytest.importorskip("pyarrow")
pytest.importorskip("scipy")
# what a crowded machine is given [s]
CROWD = 120.0


def killed(folder: Path, parts: int, *words: str) -> list[str]:
    """Files that are there when a study is killed that has written so many."""
    command = [sys.executable, "-m", "support.slow_study", str(folder), *words]
    child = subprocess.Popen(command, env={**os.environ, "PYTHONPATH": str(ROOT / "tests")})
    try:
        until = time.monotonic() + CROWD
        while len(written(folder)) < parts:
            assert child.poll() is None, "it ended before it could be killed"
            assert time.monotonic() < until, "it wrote too little"
            time.sleep(0.005)
    finally:
        child.kill()
        child.wait()
    return written(folder)


def written(folder: Path) -> list[str]:
    return sorted(path.name for path in (folder / "data").glob("part-*.parquet"))


def test_a_killed_study_goes_on_to_the_same_bits(tmp_path: Path) -> None:
    there = killed(tmp_path, 4, "2")
    assert 4 <= len(there) < slow_study.COUNT // slow_study.CHUNK
    before = {name: (tmp_path / "data" / name).stat().st_mtime_ns for name in there}
    half = cw.Study.load(tmp_path)
    assert len(half) == len(there) * slow_study.CHUNK
    found = slow_study.study(tmp_path, threads=2)
    assert {name: (tmp_path / "data" / name).stat().st_mtime_ns for name in there} == before
    expected = cw.sweep(scattered.discs(), **slow_study.asked())
    for name in found.names:
        assert found[name].tobytes() == expected[name].tobytes()
    assert found.complete
    assert not list((tmp_path / "data").glob(".*"))


def test_at_most_a_chunk_of_a_worker_is_lost(tmp_path: Path) -> None:
    log = tmp_path / "log"
    there = killed(tmp_path / "study", 3, "1", str(log))
    begun = log.stat().st_size
    assert begun - len(there) * slow_study.CHUNK <= slow_study.CHUNK
    found = slow_study.logged(tmp_path / "study", log, threads=1)
    assert found.complete
    # the four that tell the columns are run each time a study begins
    assert log.stat().st_size == slow_study.COUNT + 4 + (begun - 4 - len(there) * slow_study.CHUNK)
