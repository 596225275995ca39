"""Gradients of random drivelines of all laws and elements against differences of runs at 1e-12."""

from __future__ import annotations

import warnings

import pytest

import clutchwork as cw
from support import gradient_cases, samples
from support.amount import amount
from support.any_model import gradients

ELEMENTS = samples.declared(*samples.ELEMENT_ROLES)
# guards that are the least of several, stops that are struck together, a speed that is round-off
SEEN = {"laws": (24,), "stops": (22,), "contacts": (24,)}


def report(case, seed, count):
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", cw.ModelWarning)
        warnings.simplefilter("ignore", cw.FaultWarning)
        warnings.simplefilter("ignore", cw.StoppedEarly)
        return gradient_cases.checked(case, seed, count)


@pytest.mark.random
@pytest.mark.parametrize("kind", gradient_cases.KINDS)
def test_random_drivelines(kind):
    compared, refused, wrong = 0, list[str](), list[str]()
    seeds = dict.fromkeys([*range(amount(6)), *SEEN.get(kind, ())])
    for seed in seeds:
        found = report(gradient_cases.KINDS[kind](seed), seed, 2)
        compared, refused = compared + found.compared, [*refused, *found.refused]
        wrong += [f"seed {seed}: {text}" for text in found.wrong]
    assert not wrong, "\n".join(wrong)
    # one of two may have an event that no derivative passes
    assert compared > 2 * len(seeds)


@pytest.mark.random
def test_models_of_everything():
    """What the campaign of `support.any_model.gradients` draws, thinned out."""
    compared, found = 0, list[str]()
    for seed in range(61000, 61000 + amount(8)):
        tally = gradients.examined(seed, 2)
        compared += tally.compared
        found += [f"seed {seed}: {words}" for words in tally.wrong + tally.apart]
    assert not found, "\n".join(found)
    assert compared > 0


@pytest.mark.parametrize("cls", ELEMENTS, ids=lambda cls: cls.kind)
def test_every_element(cls):
    found = report(gradient_cases.of_element(cls), 1, 3)
    assert found.wrong == []
    # a torque that grows with the speed it makes has no end
    assert found.compared > 0 or "the run: not_finite" in found.refused
