"""Many instances: one after another without growth, side by side in threads with the same bits."""

from __future__ import annotations

import gc
import threading
from pathlib import Path
from typing import Any

import pytest

from support.fmus import Fmu, Instance

START = {"F2.pressure": 6e5, "F4.pressure": 9e5}
SEEN = ["w1.speed", "w8.speed", "F2.heat"]


def memory() -> int:
    """Of this process [bytes]."""
    return 4096 * int(Path("/proc/self/statm").read_text().split()[1])


def free_state(run: Instance, state: Any) -> None:
    (run.raw.freeFMUState if hasattr(run.raw, "freeFMUState") else run.raw.freeFMUstate)(state)


def life(fmu: Fmu) -> None:
    """One instance with states, kept and read."""
    run = fmu.instance()
    run.begin(START)
    run.step(0.0, 0.1)
    states = [run.state()]
    states.append(run.read(run.saved(states[0])))
    run.go_to(states[1])
    for state in states:
        free_state(run, state)
    run.free()


@pytest.mark.skipif(not Path("/proc/self/statm").exists(), reason="needs the memory of a process as Linux gives it")
def test_a_thousand_lives_leave_nothing(six_speed: Fmu) -> None:
    """An instance takes 80 kB and a state 50 kB: one of ten that stayed would be 10 MB."""
    for _ in range(100):
        life(six_speed)
    gc.collect()
    before = memory()
    for _ in range(1000):
        life(six_speed)
    gc.collect()
    # what Python keeps of calls is some hundred kB
    assert memory() - before < 4e6


def test_threads_have_the_same_bits(six_speed: Fmu) -> None:
    found: list[list[float]] = [[] for _ in range(8)]

    def work(number: int) -> None:
        with six_speed.running(START) as run:
            for k in range(100):
                run.step(0.01 * k, 0.01)
            found[number] = run.get(SEEN)

    threads = [threading.Thread(target=work, args=(number,)) for number in range(len(found))]
    for one in threads:
        one.start()
    for one in threads:
        one.join()
    assert all(one == found[0] for one in found)
    assert found[0]


def test_made_in_one_thread_and_stepped_in_another(six_speed: Fmu) -> None:
    with six_speed.running(START) as plain, six_speed.running(START) as other:
        plain.step(0.0, 0.5)
        thread = threading.Thread(target=other.step, args=(0.0, 0.5))
        thread.start()
        thread.join()
        assert other.get(SEEN) == plain.get(SEEN)
