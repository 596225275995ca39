"""Small drivelines of what derivatives have found hard, asked in every way."""

from __future__ import annotations

import pytest

from support import hard_gradients
from support.amount import amount


@pytest.mark.random
@pytest.mark.parametrize("kind", hard_gradients.KINDS)
def test_derivatives_are_right_and_agree(kind: str) -> None:
    first, count = list(hard_gradients.KINDS).index(kind), len(hard_gradients.KINDS)
    compared, refused = 0, list[str]()
    for number in range(amount(3)):
        seed = first + count * number
        found = hard_gradients.checked(seed, 2)
        compared, refused = compared + found.compared, refused + found.refused
        assert not found.wrong + found.apart, f"seed {seed}: {found.wrong + found.apart}"
    assert compared > 0
    # differences on both sides agree there, so that the derivative exists; of a few drivelines one may be refused
    assert len(refused) <= max(1.0, 0.01 * compared), "\n".join(refused)
