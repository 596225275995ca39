"""docs/validation.md: it names every group of tests and nothing else, and what it calls not modelled is not there."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any

import pytest

import clutchwork as cw
from clutchwork.declare.schema import REGISTRY, Role, specs
from support import samples
from support.pages import code, page, table
from support.project import ROOT

PAGE = page("validation.md")
NAMED = [name for row in table(PAGE, "claim") for name in code(row[-1])]
# folders whose files are named one by one
ONE_BY_ONE = ("physics", "properties", "reference")


def test_everything_named_exists() -> None:
    assert [name for name in NAMED if not (ROOT / name).exists()] == []


def test_every_test_is_named() -> None:
    files = [path.relative_to(ROOT) for path in (ROOT / "tests").rglob("test_*.*") if path.suffix in (".py", ".cpp")]
    folders = {str(path.parent) for path in files if path.parts[1] not in ONE_BY_ONE}
    single = {str(path) for path in files if path.parts[1] in ONE_BY_ONE}
    assert sorted(single - set(NAMED)) == []
    assert sorted(folder for folder in folders if not any(name.startswith(folder) for name in NAMED)) == []


def test_every_file_of_tests_opens_with_what_it_shows() -> None:
    """The generated list of all tests repeats these words."""
    openings = {path: path.read_text(encoding="utf-8")[:3] for path in (ROOT / "tests").rglob("test_*.*")}
    marks = {".py": '"""', ".cpp": "// "}
    assert [path.name for path, opening in openings.items() if marks.get(path.suffix, opening) != opening] == []


def _fields(*roles: Role) -> list[tuple[str, str, str]]:
    """(kind, field, meaning) of every field of the elements of some roles."""
    return [(cls.kind, item.name, spec.doc) for cls in samples.declared(*roles) for item, spec in specs(cls)]


def _gears() -> None:
    """A rigid element has ports and constant numbers that make up its ratio, and no more."""
    allowed = ("ratio", "radius", "teeth", "module")
    for cls in REGISTRY[Role.GEAR].values():
        assert all(item.name.startswith(allowed) for item, spec in specs(cls) if spec.what != "port"), cls


def _backlash() -> None:
    found = {kind for kind, _, doc in _fields(*samples.ELEMENT_ROLES) if "backlash" in doc}
    assert found == {"dog_clutch", "synchroniser"}


def _collisions() -> None:
    """No element joins masses or shafts by anything that has a gap, but teeth."""
    gaps = {kind for kind, name, _ in _fields(Role.TORQUE, Role.CONTACT) if name in ("gap", "clearance", "restitution")}
    assert gaps <= {"dog_clutch"}


def _massless() -> None:
    d = cw.Driveline()
    light, heavy = d.shaft("light"), d.shaft("heavy", inertia=1.0)
    d.add(cw.Clutch("c1", base=heavy, follower=light, friction=cw.Coulomb(static=0.2, kinetic=0.1), gain=1, pressure=1))
    (problem,) = d.check()
    assert "inertia is missing" in str(problem)
    assert "give it inertia > 0 kg m2" in str(problem)


def _shares() -> None:
    d = cw.Driveline()
    shaft, law = d.shaft("a", inertia=1.0), cw.Coulomb(static=0.2, kinetic=0.1)
    for name, gain in (("b1", 1.0), ("b2", 3.0)):
        d.add(cw.Brake(name, shaft=shaft, friction=law, gain=gain, pressure=100.0, locked=True))
    d.add(cw.Torque("load", shaft=shaft, torque=8.0))
    run = d.simulate(0.1)
    assert run.dependent
    assert [run[f"{name}.torque"][-1] for name in ("b1", "b2")] == pytest.approx([-2.0, -6.0])


CLAIMS: dict[str, Callable[[], Any]] = {
    "Gears": _gears,
    "Backlash": _backlash,
    "Collisions": _collisions,
    "Massless contacts": _massless,
    "Shares": _shares,
}


def test_every_claim_has_its_check() -> None:
    section = PAGE.partition("## What is not modelled")[2]
    bullets = re.findall(r"^- (?:\*\*(.+?)\*\*)?", section, re.MULTILINE)
    assert bullets == list(CLAIMS)


@pytest.mark.parametrize("claim", CLAIMS)
def test_what_is_not_modelled(claim: str) -> None:
    CLAIMS[claim]()


def test_what_is_modelled_is_not_denied() -> None:
    """Laws with states, temperatures and wear were once called not modelled."""
    section = re.sub(r"\(.*?\)", "", PAGE.partition("## What is not modelled")[2].lower())
    kinds = [kind for role, known in REGISTRY.items() if role is not Role.SIGNAL for kind in known if kind != "gear"]
    assert [kind for kind in kinds if re.search(rf"\b{kind.replace('_', ' ')}\b", section)] == []
    for word in ("bristle", "temperature", "thermal", "wear", "fault", "hysteresis"):
        assert word not in section, word
