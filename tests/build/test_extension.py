"""Two new files make a component: the examples of docs/extend.md in a copy of the project, nothing else edited."""

from __future__ import annotations

import re
import subprocess
from pathlib import Path

import pytest

from support import project

PAGE = (project.ROOT / "docs" / "extend.md").read_text(encoding="utf-8")
# a path on a line of its own, and the whole file below it
FILES: dict[str, str] = dict(
    re.findall(r"^`((?:src|cpp)/[\w/.]+)`\n\n```\w+\n(.*?)^```", PAGE, re.DOTALL | re.MULTILINE)
)
KINDS = sorted({Path(name).stem for name in FILES})

# closed forms of every example
USE = """
import math
import sys
import clutchwork as cw

TIGHT = dict(rtol=1e-11, atol=1e-12)

# torque -2 peak x/(1 + x^2): ln x + x^2/2 falls by 2 peak t/(J speed)
d = cw.Driveline("eddy brake")
a = d.shaft("a", inertia=0.5, speed=30.0)
d.add(cw.EddyBrake("brake", shaft=a, peak=4.0, speed=10.0))
run = d.simulate(2.0, **TIGHT)
x = run["a.speed"][-1] / 10.0
assert abs(math.log(x) + x * x / 2 - (math.log(3.0) + 4.5 - 2 * 4.0 * 2.0 / (0.5 * 10.0))) < 1e-8, x

# J/N times the integral of 1/coefficient is the time to rest
d = cw.Driveline("lorentzian")
a = d.shaft("a", inertia=0.5, speed=60.0)
law = cw.Lorentzian(static=0.3, peak=0.25, kinetic=0.16, speed=25.0)
d.add(cw.Brake("b", shaft=a, friction=law, gain=1.0, normal_force=100.0))
run = d.simulate(4.0, **TIGHT)
y, root = 60.0 / 25.0, math.sqrt(0.25 * 0.16)
time = 0.5 / 100.0 * 25.0 * (y / 0.16 + (1 - 0.25 / 0.16) / root * math.atan(y * 0.16 / root))
(lock,) = [e.time for e in run.events if e.after == "locked"]
assert abs(lock - time) < 1e-8, (lock, time)

# the release pressure falls by 1.2 MPa/s: closed from 1/6 s on, then the torque grows by 6 N m/s
def lock_up(release):
    d = cw.Driveline("lock-up")
    a = d.shaft("a", inertia=0.5, speed=2.0)
    law = cw.Coulomb(static=0.1, kinetic=0.1)
    pressures = dict(apply=5e5, release=release)
    d.add(cw.HydraulicClutch("c", base=d.housing, follower=a, friction=law, gain=1e-4, ratio=0.5, **pressures))
    return d

falling = lock_up(cw.Ramp(height=-1.2e6, duration=1.0, offset=1.2e6))
run = falling.simulate(1.0, **TIGHT)
(locked,) = [e.time for e in run.events if e.after == "locked"]
assert abs(locked - 1 / 6 - math.sqrt(1 / 3)) < 1e-8, locked

# bounds of an input are those of its signal
try:
    lock_up(cw.Sine(amplitude=1e5, frequency=1.0)).assemble()
except cw.ModelError as error:
    assert "release" in str(error) and "must be >= 0 Pa" in str(error), error
else:
    raise AssertionError("a negative pressure went through")

# bristles from rest, bent one way: elastic = kinetic tanh(stiffness displacement/kinetic)
d = cw.Driveline("bouc wen")
a = d.shaft("a", inertia=1.0)
d.add(cw.PrescribedSpeed("p", shaft=a, speed=1e-3))
law = cw.BoucWen(kinetic=0.2, stiffness=1e3, share=0.6)
d.add(cw.BearingFriction("b", shaft=a, friction=law, torque=10.0))
run = d.simulate(0.3, **TIGHT)
assert abs(run["b.elastic"][-1] - 0.2 * math.tanh(1e3 * 0.3e-3 / 0.2)) < 1e-9

# model files know them, and help() shows their parameters
falling.save(sys.argv[1])
again = cw.Driveline.load(sys.argv[1]).simulate(1.0, **TIGHT)
assert [e.time for e in again.events if e.after == "locked"] == [locked]
import pydoc

words = pydoc.plain(pydoc.render_doc(cw.BoucWen))
assert "share" in words and "shape of the way back, elastic at 1/2" in words, words
print("used")
"""


@pytest.fixture(scope="module")
def copy(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The project with every example of the page pasted."""
    made = project.copy(tmp_path_factory.mktemp("extended") / "project", "tests", "docs", "examples")
    for name, text in FILES.items():
        (made / name).write_text(text)
    return made


@pytest.fixture(scope="module")
def site(copy: Path) -> Path:
    """Where the copy is installed: one build for all examples."""
    folder = copy.parent / "site"
    built = project.install(copy, folder)
    assert built.returncode == 0, built.stdout + built.stderr
    return folder


def passed(done: subprocess.CompletedProcess[str]) -> str:
    """Output of a run of pytest that had no failure."""
    assert done.returncode == 0, done.stdout[-10_000:] + done.stderr
    return done.stdout


def test_the_page_shows_both_files_of_every_example() -> None:
    assert {"lorentzian", "bouc_wen", "eddy_brake", "hydraulic_clutch"} <= set(KINDS)
    for kind in KINDS:
        (folder,) = {Path(name).parent.name for name in FILES if Path(name).stem == kind}
        assert f"src/clutchwork/{folder}/{kind}.py" in FILES
        assert f"cpp/include/clutchwork/{folder}/{kind}.hpp" in FILES


def test_type_checkers_and_editors_know_the_examples(site: Path) -> None:
    stub = (site / "clutchwork/__init__.pyi").read_text()
    assert "class HydraulicClutch(Element):" in stub
    assert "class Lorentzian(Law):" in stub


def test_the_demonstration_runs_from_what_is_installed(site: Path, tmp_path: Path) -> None:
    shown = project.run_in(site, "-m", "clutchwork", "demo", folder=tmp_path)
    assert "2.4886 -> 1.8302 by gears" in shown.stdout, shown.stderr
    assert (site / "clutchwork/examples/six_speed/pressures.csv").is_file()


def test_the_examples_compute_what_they_say(site: Path, tmp_path: Path) -> None:
    used = project.run_in(site, "-c", USE, str(tmp_path / "model.toml"))
    assert used.stdout.strip() == "used", used.stderr


# what iterates over the registry; of the rest only what is called after one of the examples
WHOLE = (
    "tests/registry",
    "tests/rig/test_choice.py",
    "tests/rig/test_examples_of_laws.py",
    "tests/examples/test_reference.py",
    "tests/model/test_words.py",
)
BY_NAME = ("tests/physics", "tests/fit/test_recovery.py", "tests/model", "tests/interfaces/test_copies.py")
PYTEST = ("-m", "pytest", "-q", "-p", "no:cacheprovider", "--no-header", "--tier", "first")


def test_the_tests_over_all_components_pass_with_them(copy: Path, site: Path) -> None:
    report = passed(project.run_in(site, *PYTEST, "-rs", *WHOLE, folder=copy))
    # what our own laws have beside is asked for, in words and without a failure
    assert "lorentzian is not listed in OURS and lacks source:" in report
    assert "bouc_wen is not listed in OURS and lacks source:" in report
    names = " or ".join(word for kind in KINDS for word in (kind, kind.replace("_", "")))
    assert " passed" in passed(project.run_in(site, *PYTEST, "-k", names, *BY_NAME, folder=copy))
