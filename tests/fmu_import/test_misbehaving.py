"""FMUs that crash, hang, end their process or report errors: each ends in one sentence. docs/guide/fmu-import.md"""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

import clutchwork as cw
from support.c_fmus import COMPILER, small

pytestmark = pytest.mark.skipif(COMPILER is None, reason="no C compiler")

PERIOD = 0.1
BEGIN, ENTER, EXIT, STEP, END = 0, 100, 200, 300, 400
IN_STEP = "in its step from 0.2 to 0.3 s"
AT_START = "at its start at 0 s"

CASES = {
    "crash": (STEP + 1, f"crashed (SIGSEGV) {IN_STEP}"),
    "exit": (STEP + 2, f"ended its process by itself, with exit code 0 {IN_STEP}"),
    "exit with a code": (STEP + 13, f"ended its process by itself, with exit code 7 {IN_STEP}"),
    "hang": (STEP + 3, f"gave no answer within 3 s; raise time_limit= if it may take longer {IN_STEP}"),
    "stopped process": (STEP + 12, f"gave no answer within 3 s; raise time_limit= if it may take longer {IN_STEP}"),
    "error": (STEP + 4, f"reported an error (fmi2DoStep: the valve is stuck) {IN_STEP}"),
    "discard": (STEP + 5, f"refused to go on (fmi2DoStep) {IN_STEP}"),
    "fatal": (STEP + 6, f"reported a fatal error (fmi2DoStep) {IN_STEP}"),
    "pending": (STEP + 11, f"wants to go on in the background, which is not supported (fmi2DoStep) {IN_STEP}"),
    "not a number": (STEP + 7, f"gave nan as its output 'y' {IN_STEP}"),
    "infinity": (STEP + 8, f"gave inf as its output 'y' {IN_STEP}"),
    "abort": (STEP + 9, f"crashed (SIGABRT) {IN_STEP}"),
    "closed files": (STEP + 10, f"ended its process by itself, with exit code 1 {IN_STEP}"),
    "error at the start": (EXIT + 4, f"reported an error (fmi2ExitInitializationMode: the valve is stuck) {AT_START}"),
    "crash at the start": (ENTER + 1, f"crashed (SIGSEGV) {AT_START}"),
}


def driven(torque: Any) -> cw.Driveline:
    """A shaft with a torque."""
    d = cw.Driveline("driven")
    d.add(cw.Torque("t", shaft=d.shaft("a", inertia=2.0), torque=torque))
    return d


@pytest.fixture(scope="module")
def path(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """An FMU that misbehaves as its parameter `mode` says, from the step `when` on."""
    return small(tmp_path_factory.mktemp("c") / "valve.fmu")


@pytest.mark.parametrize("case", CASES)
def test_an_fmu_that_fails_ends_the_run_with_its_name_and_the_instant(path: Path, case: str) -> None:
    mode, words = CASES[case]
    parameters = {"mode": mode, "when": 3 if mode >= STEP else 0, "bias": 1.0}
    # a step of it takes microseconds, and the start of Python does not count
    limit = 3.0 if "no answer" in words else 60.0
    fmu = cw.FMU(path, PERIOD, parameters=parameters, trust=True, time_limit=limit)
    with pytest.raises(cw.SimulationError) as raised:
        driven(fmu["y"]).simulate(1.0)
    assert str(raised.value) == f"FMU 'valve' {words}"
    run = raised.value.trajectory
    # up to where its outputs are known
    assert run.time[-1] == pytest.approx(0.3) if mode >= STEP else not len(run)


def test_what_asks_for_the_end_is_told_as_that(path: Path) -> None:
    fmu = cw.FMU(path, PERIOD, parameters={"mode": STEP + 5, "bias": 3.0}, trust=True)
    with pytest.raises(cw.SimulationError, match=r"asked for the end of the run \(fmi2DoStep\)"):
        driven(fmu["y"]).simulate(1.0)


def test_no_instance_no_library_and_missing_functions_are_told(tmp_path: Path) -> None:
    guid = cw.FMU(small(tmp_path / "guid.fmu", guid="{wrong}"), PERIOD, trust=True)
    with pytest.raises(
        cw.SimulationError, match=r"FMU 'guid' gave no instance \(fmi2Instantiate\) at its start at 0 s"
    ):
        driven(guid["y"]).simulate(1.0)
    lacking = cw.FMU(small(tmp_path / "lacks.fmu", defines=["NO_GET"]), PERIOD, trust=True)
    with pytest.raises(
        cw.SimulationError, match=r"FMU 'lacks' cannot be loaded .its library has no fmi2GetReal. at its"
    ):
        driven(lacking["y"]).simulate(1.0)
    hanging = cw.FMU(small(tmp_path / "h.fmu", defines=["HANG_WHEN_LOADED"]), PERIOD, trust=True, time_limit=3.0)
    with pytest.raises(cw.SimulationError, match=r"FMU 'h' gave no answer within 3 s; raise .* at its start at 0 s"):
        driven(hanging["y"]).simulate(1.0)


def test_a_library_that_is_none_is_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("support.c_fmus.library", lambda *_: b"no library")
    fmu = cw.FMU(small(tmp_path / "text.fmu"), PERIOD, trust=True)
    with pytest.raises(cw.SimulationError, match=r"FMU 'text' cannot be loaded .*small.so: .* at its start at 0 s"):
        driven(fmu["y"]).simulate(1.0)


def test_the_command_line_reports_it(path: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    from clutchwork.command.main import main

    fmu = cw.FMU(path, PERIOD, parameters={"mode": STEP + 1, "when": 3, "bias": 1.0}, trust=True)
    driven(fmu["y"]).save(tmp_path / "model.toml")
    words = f"FMU 'valve' crashed (SIGSEGV) {IN_STEP}"
    assert main(["run", str(tmp_path / "model.toml"), "--trust", "--t-end", "1", "--json"]) == 1
    said = capsys.readouterr()
    assert said.err == f"clutchwork: {words}\n"
    told = json.loads(said.out)
    assert (told["status"], told["message"]) == ("failed", words)
    assert told["time_s"] == pytest.approx(0.3)
    # with nothing computed yet, too
    fmu = cw.FMU(path, PERIOD, parameters={"mode": ENTER + 1}, trust=True)
    driven(fmu["y"]).save(tmp_path / "model.toml")
    assert main(["run", str(tmp_path / "model.toml"), "--trust", "--t-end", "1"]) == 1
    assert capsys.readouterr().err == f"clutchwork: FMU 'valve' crashed (SIGSEGV) {AT_START}\n"


@pytest.mark.parametrize("mode", [END + 1, END + 2, END + 3, END + 4], ids=["crash", "exit", "hang", "error"])
def test_how_it_ends_is_of_no_account(path: Path, mode: int) -> None:
    fmu = cw.FMU(path, PERIOD, parameters={"mode": mode, "bias": 1.0}, trust=True)
    assert driven(fmu["y"]).simulate(0.5)["t.torque"][-1] == pytest.approx(0.4)


@pytest.mark.parametrize("mode", [STEP + 14, STEP + 15], ids=["prints", "reads"])
def test_what_it_prints_or_reads_goes_nowhere(path: Path, mode: int) -> None:
    """2.4 MB in each step, more than any pipe takes; and what it reads of its standard input is empty."""
    program = f"""
import clutchwork as cw
from fmu_import.test_misbehaving import driven
if __name__ == "__main__":
    fmu = cw.FMU({str(path)!r}, 0.1, parameters={{"mode": {mode}, "bias": 1.0}}, trust=True)
    print(driven(fmu["y"]).simulate(0.5)["t.torque"][-1])
"""
    tests = str(Path(__file__).resolve().parents[1])
    done = subprocess.run(
        [sys.executable, "-c", program], capture_output=True, text=True, env={"PYTHONPATH": tests}, input="typed\n"
    )
    assert (done.stderr, done.returncode) == ("", 0)
    assert float(done.stdout) == pytest.approx(0.4)


@pytest.mark.parametrize(
    ("mode", "words"),
    [
        (1, r"reported an error \(fmi3DoStep: the valve is stuck\)"),
        (2, r"asked for the end of the run \(fmi3DoStep\)"),
        (3, r"refused to go on \(fmi3DoStep, which came back early\)"),
        (4, r"crashed \(SIGABRT\)"),
    ],
)
def test_fmi_3_fails_in_the_same_words(tmp_path: Path, mode: int, words: str) -> None:
    fmu = cw.FMU(small(tmp_path / "three.fmu", "3.0"), PERIOD, parameters={"mode": mode}, trust=True)
    with pytest.raises(cw.SimulationError, match=rf"FMU 'three' {words} in its step from 0 to 0.1 s"):
        driven(fmu["y"]).simulate(1.0)


def test_an_interrupted_step_is_not_taken_for_another_one(path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Ctrl-C while an FMU is busy: what it would have answered later is that of no other instant."""
    sim = cw.Simulator(driven(cw.FMU(path, PERIOD, parameters={"bias": 1.0}, trust=True)["y"]))
    sim.advance(0.25)
    from clutchwork.fmu_import.process import Process

    def interrupted(*_: object) -> bytes:
        raise KeyboardInterrupt

    with monkeypatch.context() as context:
        context.setattr(Process, "_answer", interrupted)
        with pytest.raises(KeyboardInterrupt):
            sim.advance(0.1)
    with pytest.raises(cw.SimulationError, match=r"FMU 'valve' was interrupted before it had answered: start again"):
        sim.advance(0.3)
    sim.reset()
    sim.advance(0.45)
    assert sim["t.torque"] == pytest.approx(0.4)


def test_a_simulator_stays_failed_and_begins_anew_after_a_reset(path: Path) -> None:
    fmu = cw.FMU(path, PERIOD, parameters={"mode": STEP + 1, "when": 3, "bias": 1.0}, trust=True)
    sim = cw.Simulator(driven(fmu["y"]))
    for _ in range(2):
        sim.advance(0.3)
        with pytest.raises(cw.SimulationError, match=r"SIGSEGV"):
            sim.advance(0.3)
        sim.reset()
