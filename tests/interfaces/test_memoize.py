"""What a System keeps for its runs: found once, the same for all threads, gone with it, in no copy of it."""

from __future__ import annotations

import gc
import pickle
import weakref
from concurrent.futures import ThreadPoolExecutor
from threading import Barrier
from typing import Any

import numpy as np
from tests.support import random_drivelines

import clutchwork as cw
from clutchwork.assembly.wiring import wiring
from clutchwork.base.memoize import KEPT, memoize
from clutchwork.results.channels import channels


def system(seed: int = 3) -> cw.System:
    return random_drivelines.describe(seed).driveline().assemble()


def test_runs_of_a_system_share_what_belongs_to_it() -> None:
    made = system()
    one, other = cw.simulate(made, 0.1), cw.simulate(made, 0.2, dt=0.01)
    assert one.wiring is other.wiring is wiring(made)
    assert one.channels is other.channels is channels(made, True, True)
    assert made.to_bytes() is made.to_bytes()
    bare = cw.simulate(made, 0.1, work=False)
    assert bare.channels is not one.channels
    assert set(bare.names) < set(one.names)


def test_what_a_user_changes_of_one_run_is_not_seen_in_another() -> None:
    made = system()
    one, other = cw.simulate(made, 0.1), cw.simulate(made, 0.1)
    one.units["more"] = "kg"
    one.rows[:] = 0.0
    assert "more" not in other.units
    assert np.any(other.rows)


def test_it_does_not_grow_with_runs() -> None:
    made = system()
    run = cw.simulate(made, 0.1)
    _ = run.names, run.energy
    before = len(vars(made)[KEPT])
    for number in range(5):
        run = cw.simulate(made, 0.1 + 0.01 * number, points=10 + number, rtol=1e-6 / (1 + number))
        _ = run.names, run.energy
    assert len(vars(made)[KEPT]) == before


def test_it_goes_with_the_system() -> None:
    made = system()
    parts = [weakref.ref(made), weakref.ref(wiring(made)), weakref.ref(channels(made))]
    run = cw.simulate(made, 0.1)
    del made
    assert parts[0]() is run.system
    del run
    gc.collect()
    assert [part() for part in parts] == [None, None, None]


def test_copies_leave_it_out() -> None:
    made = system()
    fresh = pickle.dumps(made)
    run = cw.simulate(made, 0.1)
    bare = pickle.dumps(run)
    _ = run.names, run.channels, run.wiring
    assert pickle.dumps(made) == fresh
    assert pickle.dumps(run) == bare
    assert KEPT not in vars(pickle.loads(fresh))


def test_threads_get_the_same() -> None:
    for seed in range(5):
        made, start = system(seed), Barrier(8)

        def ask(_: int, made: cw.System = made, start: Barrier = start) -> tuple[Any, ...]:
            start.wait()
            run = cw.simulate(made, 0.05)
            return run.wiring, run.channels, run.rows.tobytes(), run.events

        with ThreadPoolExecutor(8) as pool:
            found = list(pool.map(ask, range(8)))
        assert len({id(item[0]) for item in found}) == 1
        assert len({id(item[1]) for item in found}) == 1
        assert len({item[2] for item in found}) == 1
        assert all(item[3] == found[0][3] for item in found)


class Thing:
    """Something that never changes."""


def test_further_arguments_are_told_apart() -> None:
    calls = []

    @memoize
    def found(thing: Thing, number: int) -> list[int]:
        calls.append(number)
        return [number]

    one, other = Thing(), Thing()
    assert found(one, 1) is found(one, 1)
    assert found(one, 2) == [2]
    assert found(other, 1) is not found(one, 1)
    assert calls == [1, 2, 1]
