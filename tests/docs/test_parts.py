"""The page that compares part by part: nothing is claimed that is not declared, every element has its row."""

from __future__ import annotations

import re
import sys

import pytest

import clutchwork as cw
from clutchwork.model.components import component_problems
from support.project import ROOT

sys.path.insert(0, str(ROOT / "tools"))

import parts_page

KNOWN = parts_page.declared()
# what stands inside of others, or has no counterpart as a part of its own
INSIDE = {
    *("AirDrag", "Grade", "RollingResistance", "PlateContact", "JenkinsElement", "WetDrag", "Flyweights", "OilFlow"),
    *("BeltContact", "PolygonSprocket", "EngineTorque", "MotorTorque", "Displacement", "PressureValve"),
    *("RatioActuator", "VariableGear", "CamProfile", "PumpFlow", "PumpTorque"),
    *("DiaphragmSpring", "TorqueLimiter", "CentrifugalClutch", "FundamentalClutch", "Wear"),
}


@pytest.mark.parametrize("part", parts_page.parts(), ids=lambda part: part["what"])
def test_a_row(part) -> None:
    assert set(part) <= parts_page.KEYS
    assert part.get("ours") or part.get("names")
    assert all(hasattr(cw, name) for name in part.get("names", ()))
    for tool in ("modelica", "simscape"):
        assert f"{tool}_least" not in part or part.get(tool)


def test_what_is_claimed_is_there() -> None:
    page = parts_page.page()
    for name, kind in re.findall(r"\[(\w+)\]\(elements/(\w+)\.md\)", page):
        assert KNOWN[name].kind == kind
    for part in parts_page.parts():
        lacking = [name for name in part.get("ours", ()) if name not in KNOWN]
        assert not lacking or all(f"[{name}]" not in page for name in lacking)


USES = [part for part in parts_page.parts() if "use" in part and parts_page.given(part)[0] in KNOWN]


@pytest.mark.parametrize("part", USES, ids=lambda part: part["what"])
def test_a_use_needs_no_more(part) -> None:
    """What is counted makes a part without mistakes; no more fields than elsewhere."""
    d = cw.Driveline("use")
    known = {name: d.shaft(name, inertia=0.1) for name in "abc"} | {name: d.mass(name, mass=1e3) for name in "mn"}
    known |= {"x": d.thermal("x", capacity=500.0), "y": d.ambient("y"), "law": cw.Coulomb(static=0.4, kinetic=0.3)}
    name, fields = parts_page.given(part)
    makers = {name: lambda **given: KNOWN[name]("part", **given)}
    made = eval(part["use"], {"__builtins__": {}}, known | makers)
    assert [str(problem) for problem in component_problems(made)] == []
    others = [part[key] for key in ("modelica_least", "simscape_least") if key in part]
    assert len(fields) <= max(others, default=99), part["what"]


def test_every_element_has_a_row() -> None:
    """Or stands inside of another, or has no counterpart as a part of its own."""
    rows = {name for part in parts_page.parts() for name in part.get("ours", ())}
    assert sorted(KNOWN.keys() - rows - INSIDE) == []
