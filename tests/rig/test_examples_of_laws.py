"""Laws without numbers in the presets take part in every experiment with the examples of their declaration."""

from __future__ import annotations

from math import isfinite

import pytest

from clutchwork import rig
from clutchwork.declare.schema import REGISTRY, Role, specs

FIRST = rig.PRESETS["first"]
OTHERS = tuple(kind for kind in FIRST.laws if kind not in FIRST.fields)


@pytest.mark.parametrize("kind", OTHERS)
def test_parameters_are_the_examples_of_the_declaration(kind: str) -> None:
    law = FIRST.law(kind)
    examples = {item.name: spec.example for item, spec in specs(REGISTRY[Role.LAW][kind]) if spec.example is not None}
    assert examples
    assert {name: getattr(law, name) for name in examples} == examples


@pytest.mark.parametrize("name", rig.EXPERIMENTS)
def test_every_experiment_takes_them(name: str) -> None:
    result = getattr(rig, name)(OTHERS)
    assert list(result.laws) == list(OTHERS)
    assert result.complete
    # judder has no rate of decay where a limit cycle is left
    numbers = [cell for line in result.table.lines for cell in line if isinstance(cell, float) and isfinite(cell)]
    assert len(numbers) >= len(OTHERS)
