"""Runs advanced in groups have the bits of runs alone: random drivelines, random groups."""

from __future__ import annotations

import re
from typing import Any

import numpy as np
import pytest

from clutchwork import _core
from clutchwork.assembly.system import System
from support import random_contacts, random_drivelines, random_large, six_speed
from support.amount import amount, seeds
from support.any_model import model
from support.pages import page
from support.project import ROOT
from support.sweep import sweep

METHODS = {"auto": 0.0, "rodas5p": 1.0}


def run(system: System, rng: np.random.Generator, method: str, **options: float) -> Any:
    """A run of a driveline whose numbers are a little different."""
    made = _core.Run(system.to_bytes())
    for name, value in {"method": METHODS[method], "work": 0.0, "angles": 0.0, **options}.items():
        made.set_option(name, value)
    for offset, value in enumerate(system.arrays["params"]):
        changed = float(value * rng.uniform(0.97, 1.03))
        if made.is_settable(offset, changed):
            made.set_param(offset, changed)
    return made


def told(made: Any) -> tuple[bytes, ...]:
    """Everything that a run tells at the end."""
    return made.row().tobytes(), made.events().tobytes(), repr(made.statistics()).encode(), repr(made.detail()).encode()


def advance(made: Any, t_end: float) -> int:
    """Alone, without output."""
    return int(made.advance(t_end, np.zeros(0), np.zeros((0, made.row_size)))[0])


def check(systems: list[System], seed: int, t_end: float, method: str, **options: float) -> None:
    """The same runs alone and in a group, in two parts of the time."""
    groups = []
    for _ in range(2):
        rng = np.random.default_rng(seed)
        groups.append([run(system, rng, method, **options) for system in systems])
    alone, together = groups
    for t in (0.4 * t_end, t_end):
        assert _core.advance_group(together, t) == [advance(one, t) for one in alone]
        assert [told(one) for one in together] == [told(one) for one in alone]


@pytest.mark.parametrize("seed", seeds(24))
def test_random_drivelines(seed: int) -> None:
    """Groups of one structure, of any size, with both choices of the method and with integrals now and then."""
    rng = np.random.default_rng(seed)
    build = random_large if seed % 6 == 5 else random_contacts
    system = build.driveline(seed).assemble()
    options = {"work": float(seed % 4 == 0), "angles": float(seed % 3 == 0)}
    method = "auto" if seed % 2 else "rodas5p"
    check([system] * int(rng.integers(2, 12)), seed, 1.0, method, **options)


@pytest.mark.parametrize("seed", seeds(6))
def test_mixed_groups(seed: int) -> None:
    """Neighbours in a group may be of different structures."""
    rng = np.random.default_rng(seed)
    pool = [random_contacts.driveline(k).assemble() for k in range(3)] + [six_speed.gearbox(six_speed.SHIFT).assemble()]
    check([pool[int(k)] for k in rng.integers(0, len(pool), 13)], seed, 1.0, "rodas5p")


@pytest.mark.parametrize("seed", seeds(8))
def test_in_pieces_with_work(seed: int) -> None:
    """Signals that vary are read elsewhere for the work: a run in pieces starts each with those of its own time."""
    system = random_drivelines.describe(seed).driveline().assemble()
    alone, together = (
        [run(system, np.random.default_rng([seed, k]), "rodas5p", work=1.0) for k in range(8)] for _ in "ab"
    )
    for t in (0.2, 0.4, 0.6, 0.8, 1.0):
        assert _core.advance_group(together, t) == [advance(one, t) for one in alone]
    assert [told(one) for one in together] == [told(one) for one in alone]


@pytest.mark.random
@pytest.mark.filterwarnings("ignore::clutchwork.ModelWarning")
def test_models_of_everything() -> None:
    """Whatever is declared; one of the eight spends its budget of steps, and some models end before their time."""

    def checked(seed: int) -> str:
        made = model.model(seed)
        system, t_end = model.driveline(made).assemble(), made["simulation"]["t_end"]
        options = {"work": float(seed % 3 == 0), "angles": float(seed % 2)}
        alone, together = ([], [])
        for group in (alone, together):
            rng = np.random.default_rng(seed)
            for budget in (1e4, 1e4, 15.0, 1e4, 1e4, 1e4, 1e4, 1e4):
                method = "auto" if seed % 4 == 3 else "rodas5p"
                group.append(run(system, rng, method, max_steps=budget, **options))
        for t in (0.4 * t_end, t_end):
            found, expected = _core.advance_group(together, t), [advance(one, t) for one in alone]
            if found != expected:
                return f"at {t} s they end with {found}, alone with {expected}"
        wrong = [k for k in range(8) if told(alone[k]) != told(together[k])]
        return f"runs {wrong} differ" if wrong else ""

    sweep(checked, amount(20))


def test_six_speed_shift() -> None:
    """The shift, in all of its modes."""
    check([six_speed.gearbox(six_speed.SHIFT).assemble()] * 16, 1, 4.0, "rodas5p")


def test_page_names_what_runs_in_lanes() -> None:
    """The table of the page and the headers name the same components."""
    named = set(
        re.findall(r"`(\w+)`", " ".join(re.findall(r"^\| (?:torques|contacts) \|.*$", page("theory/lanes.md"), re.M)))
    )
    headers = (ROOT / "cpp/include/clutchwork/elements").glob("*.hpp")
    texts = {path: path.read_text(encoding="utf-8") for path in headers}
    found = {
        name
        for text in texts.values()
        if "bool lanes = true" in text
        for name in re.findall(r"^struct (\w+) : declared", text, re.M)
    }
    found |= {
        name
        for text in texts.values()
        for name, base in re.findall(r"^struct (\w+) : (\w+) \{", text, re.M)
        if base in found
    }
    assert named == found
