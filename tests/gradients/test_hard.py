"""Small drivelines of what derivatives have found hard, asked in every way."""

from __future__ import annotations

import pytest

from support import hard_gradients
from support.amount import amount


@pytest.mark.random
@pytest.mark.parametrize("kind", hard_gradients.KINDS)
def test_derivatives_are_right_and_agree(kind: str) -> None:
    first, count = list(hard_gradients.KINDS).index(kind), len(hard_gradients.KINDS)
    compared = 0
    for number in range(amount(3)):
        seed = first + count * number
        found = hard_gradients.checked(seed, 2)
        compared += found.compared
        assert not found.wrong + found.apart, f"seed {seed}: {found.wrong + found.apart}"
    assert compared > 0
