"""docs/validation.md: it names every group of tests and nothing else, and what it calls not modelled is not there."""

from __future__ import annotations

import re
import warnings
from collections.abc import Callable
from typing import Any

import pytest

import clutchwork as cw
from clutchwork.declare.node import Domain
from clutchwork.declare.schema import REGISTRY, Role, specs
from support import samples
from support.pages import code, page, table
from support.project import ROOT

PAGE = page("validation.md")
NAMED = [name for row in table(PAGE, "claim") for name in code(row[-1])]
# folders whose files are named one by one
ONE_BY_ONE = ("physics", "properties", "reference")
# how a file of tests opens; what Python caches beside them is none
OPENS = {".py": '"""', ".cpp": "// "}
FILES = [path for path in (ROOT / "tests").rglob("test_*.*") if path.suffix in OPENS]


def test_everything_named_exists() -> None:
    assert [name for name in NAMED if not (ROOT / name).exists()] == []


def test_every_test_is_named() -> None:
    files = [path.relative_to(ROOT) for path in FILES]
    folders = {str(path.parent) for path in files if path.parts[1] not in ONE_BY_ONE}
    single = {str(path) for path in files if path.parts[1] in ONE_BY_ONE}
    assert sorted(single - set(NAMED)) == []
    assert sorted(folder for folder in folders if not any(name.startswith(folder) for name in NAMED)) == []


def test_every_file_of_tests_opens_with_what_it_shows() -> None:
    """The generated list of all tests repeats these words."""
    assert [path.name for path in FILES if path.read_text(encoding="utf-8")[:3] != OPENS[path.suffix]] == []


def _named(claim: str) -> set[str]:
    """Classes that the bullet of a claim names."""
    bullet = re.search(rf"^- \*\*{claim}\*\*(.*?)(?=^- |\Z)", PAGE, re.DOTALL | re.MULTILINE)
    assert bullet
    return {name for name in code(bullet[1]) if name in dir(cw)}


def _heat(cls: Any) -> float:
    """What an element and all inside of it lose in a run of an example."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        run = samples.driveline(cls).simulate(0.1)
    assert len(run) > 1, cls
    return sum(abs(line.heat) for line in run.losses().lines if line.element.partition(".")[0] == "x")


def _gears() -> None:
    """A rigid element has ports and constant numbers that make up its ratio, and no more; it has no heat."""
    allowed = ("ratio", "radius", "teeth", "module")
    for cls in REGISTRY[Role.GEAR].values():
        assert all(item.name.startswith(allowed) for item, spec in specs(cls) if spec.what != "port"), cls
        assert _heat(cls) == 0.0, cls
    # those that lose, and those that have play, are named
    whole = [cls for cls in samples.declared(Role.COMPOSITE) if any("bound" in part.hooks for part in _parts(cls))]
    play = [cls for kind, cls in REGISTRY[Role.CONTACT].items() | REGISTRY[Role.TORQUE].items() if "backlash" in kind]
    # a differential where its locking torque is asked for
    assert {cls.__name__ for cls in [*whole, *play]} | {"Differential"} == _named("Gears")


def _parts(cls: Any) -> list[Any]:
    """The elements inside of one."""
    element = next(element for element in samples.driveline(cls).elements if type(element) is cls)
    return [part for part in element.parts() if isinstance(part, cw.Element)]


def _varying_ratios() -> None:
    """A transmission has no heat of its own."""
    known = [cls for cls in samples.declared(Role.TORQUE) if "ratio" in cls.hooks]
    assert known
    for cls in known:
        assert _heat(cls) == 0.0, cls


def _impacts() -> None:
    """Restitutions are numbers, and what is locked beside a stop slips after an impact."""
    stops = [cls for cls in samples.declared(Role.CONTACT) if "end" in cls.hooks]
    found = {spec.what for cls in stops for item, spec in specs(cls) if "restitution" in item.name}
    assert found == {"param"}
    d = cw.Driveline()
    a, b, c = d.shaft("a", inertia=1.0, speed=1.0), d.shaft("b", inertia=1.0), d.shaft("c", inertia=1.0)
    d.add(cw.Backlash("play", base=a, follower=b, gap=0.2))
    law = cw.Coulomb(static=0.2, kinetic=0.1)
    d.add(cw.Clutch("c1", base=b, follower=c, friction=law, gain=1.0, pressure=1.0, locked=True))
    run = d.simulate(0.2)
    event = next(event for event in run.events if event.cause == "impact")
    assert run.at([event.time, event.time])["c.speed"] == pytest.approx([0.0, 0.0])
    assert run.at([event.time, event.time])["b.speed"] == pytest.approx([0.0, 0.5])
    assert _named("Impacts") == {"ElasticBacklash", "ElasticGap"}


def _sideways() -> None:
    """A member has one speed."""
    assert [domain.value for domain in Domain] == ["rotation", "translation"]
    d = cw.Driveline()
    d.shaft("a", inertia=1.0)
    d.mass("b", mass=1.0)
    speeds = [name for name in d.simulate(0.1).names if name.endswith(".speed")]
    assert speeds == ["a.speed", "b.speed"]


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
    "Ratios that vary": _varying_ratios,
    "Impacts": _impacts,
    "Sideways motion": _sideways,
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
