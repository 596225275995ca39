"""States of FMUs: rollback, other instances, other processes, damage."""

from __future__ import annotations

import random
import subprocess
import sys
from pathlib import Path

import pytest

from support.fmus import Fmu

SEEN = ["w1.speed", "w8.speed", "F2.heat", "F4.torque"]
START = {"F1.pressure": 2e5, "F2.pressure": 6e5, "F4.pressure": 8e5}


def pressure(k: int) -> float:
    """Of F1 in step k [Pa]."""
    return 1e5 * (k % 7)


def test_rollback_in_every_step(six_speed: Fmu) -> None:
    with six_speed.running(START) as plain, six_speed.running(START) as rolled:
        for k in range(100):
            plain.set("F1.pressure", pressure(k))
            plain.step(0.01 * k, 0.01)
            before = rolled.state()
            rolled.set("F1.pressure", 9e5)
            rolled.rate("F2.pressure", -1e6)
            rolled.step(0.01 * k, 0.02)
            rolled.go_to(before)
            rolled.set("F1.pressure", pressure(k))
            rolled.rate("F2.pressure", 0.0)
            rolled.step(0.01 * k, 0.01)
            assert rolled.get(SEEN) == plain.get(SEEN), k


def test_another_instance_goes_on_with_the_same_bits(six_speed: Fmu) -> None:
    parameters = {"F2.gain": 0.07, "w8.inertia": 6.0}
    with six_speed.running({**START, **parameters}) as one:
        one.step(0.0, 0.5)
        one.set("F1.gain", 0.3)
        state = one.state()
        # of another life, with other parameters
        other = six_speed.instance()
        other.begin({"w8.inertia": 7.0})
        other.go_to(state)
        for run in (one, other):
            run.step(0.5, 0.5)
        assert other.get([*SEEN, "F1.gain", "w8.inertia"]) == one.get([*SEEN, "F1.gain", "w8.inertia"])
        other.free()


def test_a_state_from_before_the_initialisation(six_speed: Fmu) -> None:
    run = six_speed.instance()
    start = run.state()
    ends = []
    for _ in range(2):
        run.begin(START)
        run.step(0.0, 1.0)
        ends.append(run.get(SEEN))
        run.go_to(start)
    assert ends[0] == ends[1]
    run.raw.reset()
    run.begin(START)
    run.step(0.0, 1.0)
    assert run.get(SEEN) == ends[0]
    run.free()


CHILD = """
import sys
from pathlib import Path
from support.fmus import Fmu
fmu = Fmu(Path(sys.argv[1]), Path(sys.argv[2]))
run = fmu.instance()
run.go_to(run.read(Path(sys.argv[3]).read_bytes()))
run.step(0.5, 0.5)
print(repr(run.get(sys.argv[4].split(","))))
"""


def test_another_process_goes_on_with_the_same_bits(six_speed: Fmu, tmp_path: Path) -> None:
    with six_speed.running({**START, "w8.inertia": 6.0}) as run:
        run.step(0.0, 0.5)
        run.set("F1.gain", 0.3)
        (tmp_path / "state").write_bytes(run.saved(run.state()))
        run.step(0.5, 0.5)
        want = run.get(SEEN)
    path = str(six_speed.folder.parent / "six.fmu")
    command = [sys.executable, "-c", CHILD, path, str(tmp_path / "unpacked"), str(tmp_path / "state"), ",".join(SEEN)]
    tests = str(Path(__file__).parents[1])
    done = subprocess.run(command, capture_output=True, text=True, check=True, env={"PYTHONPATH": tests})
    assert done.stdout.strip() == repr(want)
    assert done.stderr == ""


def test_damaged_states_are_refused(six_speed: Fmu) -> None:
    source = random.Random(1)
    with six_speed.running(START) as run:
        run.step(0.0, 0.5)
        content = run.saved(run.state())
        cases = [b"", content[:7], content[:-8], content + bytes(8), bytes(len(content))]
        for _ in range(60):
            bad = bytearray(content)
            bad[source.randrange(len(bad))] ^= 1 << source.randrange(8)
            cases.append(bytes(bad))
        for bad in cases:
            with pytest.raises(Exception, match=r"status 3|Error"):
                run.read(bad)
            assert "state" in run.messages[-1][2]
        run.go_to(run.read(content))
        run.step(0.5, 0.5)
