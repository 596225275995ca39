"""Every case of the Modelica Standard Library that is at hand, from its case.yaml, against the published results."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest
import yaml

from support import cases
from support.msl import compare
from support.msl.elements import missing
from support.msl.model import translate
from support.msl.signals import UnsupportedError

# accuracy of the published results (CONVENTIONS.md): 1e-5 of full scale, up to 1e-3 for undamped oscillators
TOLERANCE = 1e-5
# where "typically" is not kept, the error of the reference itself is known from a solution that needs no clutchwork:
# CoupledClutches 1.2e-5 (SciPy DOP853, 1e-11), the freewheel 3.3e-5 (the same), the sine on a mass 1.4e-5 (closed form)
LOOSER = {
    **dict.fromkeys(("rot_First", "tra_Oscillator", "rt_InitSpringDamper"), 1e-3),
    "rot_CoupledClutches": 1.5e-5,
    "rot_OneWayClutchDisengaged": 4e-5,
    "tra_Sensors": 1.5e-5,
}

REQUIRED = {
    "rot_First", "rot_ElasticBearing", "rot_CoupledClutches", "rt_TestFriction", "rot_OneWayClutchDisengaged",
    "rt_SupportTorque1", "rt_SimpleDriveTrain", "rt_Directions", "rt_TestSpeed", "tra_Brake", "tra_Damper",
    "tra_Oscillator",
}  # fmt: skip

FOLDER = cases.folder("msl")


def load(name: str) -> dict[str, Any]:
    return yaml.safe_load((FOLDER / name / "case.yaml").read_text())


def parameters() -> list[Any]:
    """One parameter per case folder; a case whose element types are not supported is expected to say so."""
    found = []
    for path in sorted(FOLDER.glob("*/case.yaml")):
        lacking = missing(load(path.parent.name))
        reason = f"not supported yet: {', '.join(lacking)}"
        marks = [pytest.mark.xfail(raises=UnsupportedError, reason=reason, strict=True)] if lacking else []
        found.append(pytest.param(path.parent.name, marks=marks))
    return found


def test_the_required_cases_are_there() -> None:
    # the thinned copies of the project hold fewer cases
    if FOLDER != cases.OWN / "msl":
        names = {path.parent.name for path in FOLDER.glob("*/case.yaml")}
        assert names >= REQUIRED
        assert not any(missing(load(name)) for name in REQUIRED)


@pytest.mark.parametrize("name", parameters())
def test_case(name: str) -> None:
    case = load(name)
    model = translate(case)
    times, columns = cases.table(FOLDER / name / "reference.csv")
    # 1e-9: two orders below what the reference itself can resolve
    run = model.driveline.simulate(float(case["stop_time"]), times=compare.grid(times), rtol=1e-9, atol=1e-11)
    assert run.status == "done", run.message
    problems = [str(m) for m in compare.signals(run, model, times, columns, LOOSER.get(name, TOLERANCE))]
    for contact in model.contacts:
        reference = compare.effective_modes(columns, contact)
        if reference is not None:
            problems += compare.modes(run, contact, times, reference)
            problems += compare.changes(run, contact, times, reference)
    assert not problems, "\n".join(problems)


def test_the_own_copies_are_cases_too() -> None:
    # they must not rot while the full set is there
    for path in sorted((cases.OWN / "msl").glob("*/case.yaml")):
        times, columns = cases.table(path.parent / "reference.csv")
        case = yaml.safe_load(path.read_text())
        assert set(columns) >= {output["csv"] for output in case["outputs"]}
        assert times[-1] == pytest.approx(case["stop_time"])


@pytest.mark.parametrize("name", ["tra_Brake", "tra_WhyArrows", "rot_CoupledClutches"])
def test_own_copy(name: str, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(f"{__name__}.FOLDER", Path(cases.OWN / "msl"))
    test_case(name)
