"""Ctrl-C: heard soon in every mode of output, and what was computed is kept."""

from __future__ import annotations

import os
import pickle
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest

import clutchwork as cw

# how long after the signal a run may go on [s], and what a crowded machine is forgiven
HEARD, CROWD = 0.5, 10.0

# a run that would take hours, with rows now and then
LONG = """
import sys, time
import numpy as np
import clutchwork as cw
d = cw.Driveline("long")
a = d.shaft("a", inertia=1.0, speed=3.0)
b = d.shaft("b", inertia=2.0)
d.add(cw.SpringDamper("k", base=a, follower=b, stiffness=900.0, damping=0.0))
d.add(cw.Torque("t", shaft=a, torque=cw.Sine(amplitude=1.0, frequency=5.0)))
system = d.assemble()
read = cw.Sampled(lambda t, signals: signals["a.speed"], period=1e-4)
e = cw.Driveline("controlled")
e.add(cw.Torque("t", shaft=e.shaft("a", inertia=1.0), torque=read))
sampled = e.assemble()
f = cw.Driveline("free")
f.add(cw.Torque("t", shaft=f.shaft("a", inertia=1.0, speed=1.0), torque=0.0))
free = f.assemble()
said = []
def ready(*_):
    if not said:
        said.append(print("ready", flush=True))
kept = dict(max_steps=10**12, max_events=10**12)
modes = {
    "smooth": lambda: cw.simulate(system, 1e7, **kept),
    "steps": lambda: cw.simulate(system, 1e7, output="steps", **kept),
    "coarse grid": lambda: cw.simulate(system, 1e7, dt=1e6, **kept),
    "two instants": lambda: cw.simulate(system, 1e7, times=[0.0, 1e7], **kept),
    "bare": lambda: cw.simulate(system, 1e7, times=[0.0, 1e7], angles=False, work=False, **kept),
    "explicit": lambda: cw.simulate(system, 1e7, times=[0.0, 1e7], method="dopri5", **kept),
    "fine grid": lambda: cw.simulate(system, 1e5, dt=0.05, **kept),
    "rows of one step": lambda: cw.simulate(free, 1e6, dt=0.2, progress=ready, **kept),
    "controller": lambda: cw.simulate(sampled, 1e4, output="steps", **kept),
}
"""

MODES = (
    "smooth",
    "steps",
    "coarse grid",
    "two instants",
    "bare",
    "explicit",
    "fine grid",
    "rows of one step",
    "controller",
)

HEAR = """
# the run of one step is over soon: it says itself that it is under way
if sys.argv[1] != "rows of one step":
    ready()
try:
    modes[sys.argv[1]]()
except cw.Interrupted as stop:
    run = stop.trajectory
    print(time.time(), run.status, len(run), run.time[-1] if len(run) else 0.0, np.isfinite(run.rows).all(), flush=True)
    assert isinstance(stop, KeyboardInterrupt) and run.message in str(stop)
"""


# a shell lets what runs in its background ignore Ctrl-C, children included
LISTEN = "import signal; signal.signal(signal.SIGINT, signal.default_int_handler)\n"


def _interrupted(code: str, *arguments: str, after: float = 1.0) -> tuple[float, subprocess.Popen[str]]:
    """Start Python code, send it Ctrl-C some time after it is ready; when that was."""
    child = subprocess.Popen(
        [sys.executable, "-c", LISTEN + code, *arguments],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    assert child.stdout is not None
    assert child.stdout.readline() == "ready\n"
    time.sleep(after)
    sent = time.time()
    child.send_signal(signal.SIGINT)
    return sent, child


@pytest.mark.skipif(os.name == "nt", reason="signals of POSIX")
@pytest.mark.parametrize("mode", MODES)
def test_ctrl_c_is_heard_in_every_mode_and_the_trajectory_is_kept(mode):
    sent, child = _interrupted(LONG + HEAR, mode, after=0.05 if mode == "rows of one step" else 1.0)
    out, err = child.communicate(timeout=60)
    assert child.returncode == 0, err
    heard, status, rows, reached, finite = out.split()
    assert float(heard) - sent < HEARD + CROWD
    assert status == "interrupted"
    # grids that are wider than what was reached hold their first instant alone
    assert int(rows) >= 1
    assert finite == "True"
    assert float(reached) < 1e7


@pytest.mark.skipif(os.name == "nt", reason="signals of POSIX")
def test_the_command_line_writes_what_it_has_and_exits_with_130(tmp_path):
    model = tmp_path / "model.toml"
    model.write_text("""
name = "long"
[[shaft]]
name = "a"
inertia = 1.0
speed = 3.0
[[shaft]]
name = "b"
inertia = 2.0
[[element]]
name = "k"
type = "spring_damper"
base = "a"
follower = "b"
stiffness = 900.0
damping = 0.0
[simulation]
t_end = 1e5
dt = 0.05
""")
    code = """
import sys
from clutchwork.command.main import main
print("ready", flush=True)
sys.exit(main(sys.argv[1:]))
"""
    table = tmp_path / "made.csv"
    _, child = _interrupted(code, "run", str(model), "--csv", str(table), "--quiet", after=2.0)
    out, err = child.communicate(timeout=120)
    assert child.returncode == 130, (out, err)
    assert "the run was interrupted" in err
    assert table.read_text().count("\n") > 10


def test_a_handler_may_raise_what_it_wants():
    code = """
def alarm(number, frame):
    raise TimeoutError("enough")
import signal
signal.signal(signal.SIGINT, alarm)
print("ready", flush=True)
try:
    modes["two instants"]()
except TimeoutError as error:
    print(error)
"""
    _, child = _interrupted(LONG + code, after=0.5)
    out, err = child.communicate(timeout=60)
    assert out == "enough\n", err


def _shaft() -> cw.System:
    d = cw.Driveline("one")
    d.add(cw.Torque("t", shaft=d.shaft("a", inertia=1.0), torque=cw.Sine(amplitude=1.0, frequency=40.0)))
    return d.assemble()


def test_other_threads_work_while_the_core_runs():
    seen = []

    def count():
        while not done.is_set():
            seen.append(time.perf_counter())
            time.sleep(0.001)

    done, other = threading.Event(), threading.Thread(target=count)
    other.start()
    began = time.perf_counter()
    cw.simulate(_shaft(), 400.0, times=[400.0])
    ended = time.perf_counter()
    done.set()
    other.join()
    assert sum(began < instant < ended for instant in seen) > 10


def test_listening_changes_no_bit(monkeypatch):
    """A handler that runs and returns leaves the run as it is."""
    system = _shaft()
    quiet = cw.simulate(system, 60.0, dt=0.01)
    heard = []
    before = signal.signal(signal.SIGINT, lambda *_: heard.append(time.time()))
    stop = threading.Event()

    def disturb():
        while not stop.wait(0.02):
            signal.raise_signal(signal.SIGINT)

    other = threading.Thread(target=disturb)
    other.start()
    try:
        disturbed = cw.simulate(system, 60.0, dt=0.01)
    finally:
        stop.set()
        other.join()
        signal.signal(signal.SIGINT, before)
    assert disturbed.rows.tobytes() == quiet.rows.tobytes()
    assert disturbed.statistics["evaluations"] == quiet.statistics["evaluations"]


def test_an_interrupt_between_two_calls_of_the_core_keeps_the_trajectory():
    def impatient(reached: float, _: float) -> None:
        if reached > 1.0:
            raise KeyboardInterrupt

    with pytest.raises(cw.Interrupted) as caught:
        cw.simulate(_shaft(), 60.0, output="steps", progress=impatient)
    run = caught.value.trajectory
    assert run.status == "interrupted"
    assert 1.0 < run.time[-1] < 60.0
    assert len(run.time) == len(run["a.speed"])
    assert "stopped at" in run.message


def test_an_interrupt_while_the_output_is_refined_keeps_the_whole_run(monkeypatch):
    from clutchwork.run import simulation

    passes, plain = [], simulation.record

    def record(recording, *rest):
        passes.append(recording)
        if len(passes) == 2:
            raise KeyboardInterrupt
        plain(recording, *rest)

    monkeypatch.setattr(simulation, "record", record)
    d = cw.Driveline("free")
    d.add(cw.Torque("t", shaft=d.shaft("a", inertia=1.0), torque=1.0))
    with pytest.raises(cw.Interrupted) as caught:
        # steps of one length have no rows between them, so that the run is repeated
        d.simulate(2.0, method="fixed", step=0.01)
    run = caught.value.trajectory
    assert len(passes) == 2
    assert run.time[-1] == 2.0
    assert run["a.speed"][-1] == pytest.approx(2.0)


def test_what_was_interrupted_can_be_sent_on():
    def impatient(*_: float) -> None:
        raise KeyboardInterrupt

    with pytest.raises(cw.Interrupted) as caught:
        cw.simulate(_shaft(), 60.0, output="steps", progress=impatient)
    copy = pickle.loads(pickle.dumps(caught.value))
    assert np.array_equal(copy.trajectory.rows, caught.value.trajectory.rows)
    assert str(copy) == str(caught.value)
