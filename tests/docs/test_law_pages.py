"""Every friction law has a live page: all its numbers are turned, and wherever its sliders stand it runs to the end."""

from __future__ import annotations

import sys
import warnings
from functools import cache
from itertools import combinations, product
from numbers import Real
from operator import mul
from typing import Any

import numpy as np
import pytest

import clutchwork as cw
from clutchwork.declare.schema import REGISTRY, Role, specs
from clutchwork.page.page import quiet_data
from support.project import ROOT

sys.path.insert(0, str(ROOT / "tools"))

import gen_docs
import law_pages

KINDS = law_pages.kinds()
# it ends where its disc first comes to rest
ENDS_EARLY = "naive_sign"
# random positions
ANYWHERE = 4
# of which a slider would leave what other numbers allow
STAYS = {"elastoplastic": {"plastic"}}


@cache
def system(kind: str) -> cw.System:
    """The three rigs of a law."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return law_pages.driveline(kind).assemble()


@cache
def data(kind: str) -> dict[str, Any]:
    """What the page of a law holds."""
    return quiet_data(system(kind), law_pages.T_END, law_pages.OPTIONS, law_pages.wanted(kind))


def status(kind: str, changes: dict[str, Any]) -> str:
    """How a run with other numbers ends."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        return cw.simulate(system(kind).changed(changes), law_pages.T_END).status


@pytest.mark.parametrize("kind", KINDS)
def test_a_law_has_three_rigs_and_all_its_numbers(kind: str) -> None:
    made, law = data(kind), law_pages.law_of(kind)
    assert [(one["y"], one["x"]) for one in made["loops"]] == [
        ("sweep.torque", "swept.speed"),
        ("loop.torque", "moved.angle"),
    ]
    assert [panel["names"] for panel in made["panels"]] == [["disc.speed", "drum.speed"]]
    numbers = {
        item.name
        for item, spec in specs(type(law))
        if isinstance(getattr(law, item.name), Real) and not (spec.flag or spec.choices or spec.whole)
    }
    turned = {one["name"].rpartition(".")[2]: one for one in made["sliders"] if one["name"].startswith("*.")}
    assert set(turned) == numbers - STAYS.get(kind, set())
    for name, one in turned.items():
        assert one["names"] == [f"{rig}.friction.{name}" for rig in ("sweep", "loop", "stick")]
        assert one["values"][0] < one["values"][-1]
    # between their ends every combination is one, so that all are turned without stops
    assert made["pairs"] == []


def positions(count: int) -> list[list[float]]:
    """Where so many sliders stand, from 0 to 1: any two of them at each pair of low, middle, high; then anywhere.

    The first ones are an orthogonal array: linear functions, none a multiple of another, of three digits of base 3.
    """
    digits = [*product(range(3), repeat=3)]
    functions = [one for one in digits if next((digit for digit in one if digit), 0) == 1]
    assert count <= len(functions)
    levels = [[sum(map(mul, one, at)) % 3 / 2 for one in functions[:count]] for at in digits]
    return levels + np.random.default_rng(15).uniform(size=(ANYWHERE, count)).tolist()


def test_any_two_sliders_stand_at_all_pairs_of_places() -> None:
    places = positions(13)
    for one, other in combinations(range(13), 2):
        assert len({(row[one], row[other]) for row in places[:-ANYWHERE]}) == 9


@pytest.mark.parametrize("kind", KINDS)
def test_wherever_its_sliders_stand_it_runs_to_the_end(kind: str) -> None:
    # without a fall of the coefficient its disc slides on
    expected = {"chatter", "done"} if kind == ENDS_EARLY else {"done"}
    assert status(kind, {}) == ("chatter" if kind == ENDS_EARLY else "done")
    sliders = data(kind)["sliders"]
    for row in positions(len(sliders)):
        changes = {}
        for one, place in zip(sliders, row, strict=True):
            low, high = one["values"][0], one["values"][-1]
            changes |= dict.fromkeys(one["names"], high if place == 1.0 else low + place * (high - low))
        assert status(kind, changes) in expected, changes


@pytest.mark.parametrize("kind", KINDS)
def test_the_rigs_show_what_the_words_say(kind: str) -> None:
    """The sweep has the steady curve, the loop is one, and the disc is at rest on the drum where a law holds."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        run = cw.simulate(system(kind), law_pages.T_END, options=law_pages.OPTIONS)
    cls = REGISTRY[Role.LAW][kind]
    upward = run["sweep.torque"][np.argmax(run["swept.speed"])]
    assert 0.15 * law_pages.SOFT.load <= upward <= 0.4 * law_pages.SOFT.load
    loss = float(np.sum(0.5 * (run["loop.torque"][1:] + run["loop.torque"][:-1]) * np.diff(run["moved.angle"])))
    assert loss > 0.0
    # the law that never rests is seen for most of the time, with a smaller loop
    assert run.time[-1] > (0.7 if kind == ENDS_EARLY else 0.999) * law_pages.T_END
    if cls.sticks:
        assert "locked" in set(run["stick.state"])
        assert law_pages.RIGID in law_pages.words(kind)
    else:
        assert "locked" not in set(run["stick.state"])


@pytest.mark.parametrize("kind", KINDS)
def test_the_reference_and_the_guide_show_it(kind: str) -> None:
    page = "\n".join(gen_docs._law(kind, REGISTRY[Role.LAW][kind]))
    assert f'src="../../live/law-{kind}.html#compact"' in page
    guide = (ROOT / "docs/guide/choose-a-friction-law.md").read_text(encoding="utf-8")
    assert f"../../src/clutchwork/laws/{kind}.py#turn-the-parameters" in guide
