"""Work at any instant, also inside of steps, is as exact as the tolerance asks for: docs/theory/integrators.md (17)."""

from __future__ import annotations

import warnings
from math import acos, pi, sin
from typing import Any

import numpy as np
import pytest
from scipy.integrate import quad

import clutchwork as cw
from reference.friction import core, sets
from support.amount import amount

RANGE = 3.0


def wound(law: Any, amplitude: float, frequency: float) -> float:
    """Heat [J] of a cycle of a saturating wind-up.

    The slip is -amplitude cos; it turns round with the wind-up at its limit, and winds up to the other one.
    """
    rate = 2.0 * pi * frequency
    # over which the wind-up goes from one limit to the other
    caught = acos(1.0 - 2.0 * RANGE * law.elastic / amplitude) / rate

    def power(t: float) -> float:
        v = amplitude * rate * sin(rate * t)
        place = min(RANGE, -RANGE + amplitude * (1.0 - np.cos(rate * t)) / law.elastic)
        falls = (law.static - law.kinetic) * (1.0 - np.exp(-((v / law.speed) ** 2)))
        return float(v * (law.static * np.tanh(place + law.viscous * v / law.speed) - falls))

    parts = [quad(power, a, b, epsabs=1e-16, epsrel=1e-13, limit=400)[0] for a, b in ((0, caught), (caught, pi / rate))]
    return 2.0 * sum(parts)


@pytest.mark.parametrize("method", ["auto", "rodas5p", "dopri5"])
@pytest.mark.parametrize("seed", range(amount(12)))
def test_heat_of_a_cycle_of_a_saturating_law(seed: int, method: str) -> None:
    rng = np.random.default_rng([3071, seed])
    law = cw.Mykhalevych(**sets.WOUND | {"viscous": float(rng.uniform(0.3, 1.5))})
    frequency, amplitude = float(10 ** rng.uniform(-0.5, 0.5)), law.elastic * float(10 ** rng.uniform(0.6, 1.3))
    signal = cw.Sine(amplitude=2.0 * pi * frequency * amplitude, frequency=frequency, phase=pi / 2)
    wanted = wound(law, amplitude, frequency)
    # the same cycle from any instant, when the wind-up has been at its limit
    begin = (1.0 + float(rng.random())) / frequency
    for rtol in (1e-6, 1e-8, 1e-10, 1e-12):
        run = core.run(
            core.moved(law, signal), [begin, begin + 1.0 / frequency], rtol=rtol, atol=1e-3 * rtol, method=method
        )
        assert float(np.diff(run["c.heat"])[0]) == pytest.approx(wanted, rel=10.0 * rtol)


# the naive sign jumps inside of steps
@pytest.mark.parametrize("name", [name for name in sets.ALL if not name.startswith("naive_sign")])
def test_heat_of_any_law_converges_at_any_instant(name: str) -> None:
    rng = np.random.default_rng([3072, list(sets.ALL).index(name)])
    law = sets.ALL[name]
    signal = cw.Sine(amplitude=2.0 * pi * float(10 ** rng.uniform(-4.5, -3.0)), frequency=1.0, phase=pi / 2)
    times = np.sort(rng.uniform(0.0, 1.2, 20))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", cw.ModelWarning)
        model = core.moved(law, signal)
        tight = model.simulate(1.2, rtol=1e-12, atol=1e-16).at(times)["c.heat"]
        for rtol in (1e-6, 1e-8, 1e-10):
            found = model.simulate(1.2, rtol=rtol, atol=1e-4 * rtol).at(times)["c.heat"]
            assert np.max(np.abs(found - tight)) < 50.0 * rtol * np.max(np.abs(tight))
