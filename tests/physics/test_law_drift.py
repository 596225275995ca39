"""The drift test: clutchwork against an independent integration, and the creep of every law."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import clutchwork as cw
from clutchwork.declare.schema import REGISTRY, Role
from reference.friction import core, sets
from reference.friction.build import counterpart
from reference.friction.compare import assert_agree
from reference.friction.histories import FIRST, SECOND, Drift
from reference.friction.solve import solve
from reference.friction.systems import Pushed

# what the specification asks of a creep against its figures
FIGURE = 0.05

# the drift test with four periods of the sine in place of thirty: every part of it, in a third of the time
SHORT = replace(FIRST, end=7.0, rest=0.3)


def creep(law: cw.Law, history: Drift) -> tuple[float, float]:
    """Displacement [m] over the sine without its first period, and over the part after 10.5 s."""
    times = [0.0, history.begin + 1.0 / history.frequency, 10.5, history.end]
    _, first, late, last = core.run(core.drift(law, history), times)["m.position"]
    return float(last - first), float(last - late)


@pytest.mark.parametrize("name", sets.DRIFT)
def test_drift_agrees_with_the_independent_integration(name: str) -> None:
    law = sets.DRIFT[name]
    times = np.arange(0.013, SHORT.end + SHORT.rest, 0.02)
    expected = solve(Pushed(counterpart(law), SHORT), times, knots=SHORT.knots, atol=1e-10)
    assert_agree(law, core.run(core.drift(law, SHORT), times), expected)


@pytest.mark.parametrize(
    ("name", "figure"),
    [
        ("tanh", 3.5e-3),
        ("regularised_stribeck", 4.6e-3),
        ("lugre", 8.0e-4),
        ("dahl", 1.5e-3),
        ("elastoplastic", 1.5e-9),
        ("mykhalevych literal", -1.7e-2),
    ],
)
def test_creep_of_the_first_set(name: str, figure: float) -> None:
    """Figures of the specification, found there by an independent solver."""
    assert creep(sets.DRIFT[name], FIRST)[0] == pytest.approx(figure, rel=FIGURE)


# the elasto-plastic law at 0.6 is dealt with below
@pytest.mark.parametrize(
    ("peak", "name", "figure"),
    [
        (0.6, "tanh", 5602e-6),
        (0.6, "lugre", 412e-6),
        (0.8, "tanh", 7644e-6),
        (0.8, "lugre", 1678e-6),
        (0.8, "elastoplastic", 84e-6),
    ],
)
def test_creep_of_the_second_set(peak: float, name: str, figure: float) -> None:
    """These figures have four digits where the specification has them; ours differ by less than 0.1 %."""
    law = {
        "tanh": cw.Tanh(kinetic=0.8, speed=1e-3),
        "lugre": cw.LuGre(**sets.BRISTLE_2),
        "elastoplastic": cw.ElastoPlastic(**sets.BRISTLE_2, elastic=5.6e-5),
    }[name]
    assert creep(law, SECOND[peak])[0] == pytest.approx(figure, rel=1e-3)


def test_creep_of_the_elasto_plastic_law_just_above_its_elastic_limit() -> None:
    """0.6 N against a limit of 0.56 N.

    The specification quotes 0.28 um. Its own equations give 0.245 um: by this core, by the independent integration,
    and within 2 % by the quadrature over one loading at the level of rest, which needs no solver of motion.
    """
    law = cw.ElastoPlastic(**sets.BRISTLE_2, elastic=5.6e-5)
    found, _ = creep(law, SECOND[0.6])
    z = np.linspace(5.6e-5, 6.0e-5, 20001)
    alpha = 0.5 - 0.5 * np.cos(np.pi * (z - 5.6e-5) / (1e-4 - 5.6e-5))
    quadrature = 15 * float(np.trapezoid(1.0 / (1.0 - alpha * z / 1e-4) - 1.0, z))
    assert found == pytest.approx(quadrature, rel=0.02)
    times = [0.0, 6.0, 21.0]
    expected = solve(Pushed(counterpart(law), SECOND[0.6]), times, knots=SECOND[0.6].knots).position
    assert found == pytest.approx(expected[2] - expected[1], rel=1e-3)


@pytest.mark.parametrize("name", ["elastoplastic", "mykhalevych", "mykhalevych clip", "mykhalevych passive"])
def test_does_not_creep_in_the_first_set(name: str) -> None:
    assert abs(creep(sets.DRIFT[name], FIRST)[0]) < 1e-8


@pytest.mark.parametrize("kind", ["leuven", "gms"])
@pytest.mark.parametrize("viscous", [0.4, 0.0])
def test_maxwell_slip_shakes_down_in_the_first_set(kind: str, viscous: float) -> None:
    """Weak elements damp what the stiff ones let swing; from 10.5 s on nothing moves on."""
    curve = sets.CURVE | {"viscous": viscous}
    order = {"order": 50.0} if kind == "leuven" else {}
    law = REGISTRY[Role.LAW][kind](**curve, elements=sets.MANY, **order)
    assert abs(creep(law, FIRST)[1]) < 1e-8


@pytest.mark.parametrize("name", ["tanh", "regularised_stribeck", "lugre", "dahl"])
def test_creeps_in_the_first_set(name: str) -> None:
    """Known of these laws, and no better here than elsewhere: most of a deflection in each period."""
    assert creep(sets.DRIFT[name], FIRST)[1] > 5e-4


@pytest.mark.parametrize(
    "law",
    [cw.Coulomb(static=1.0, kinetic=0.7), cw.Stribeck(**sets.CURVE), cw.Karnopp(**sets.CURVE, band=1e-3)],
    ids=["coulomb", "stribeck", "karnopp"],
)
def test_sticks_exactly_in_the_first_set(law: cw.Law) -> None:
    run = core.run(core.drift(law, FIRST), np.linspace(0.0, 22.0, 2201))
    held = (run.time > FIRST.begin) & (run.time <= 22.0)
    assert np.all(run["c.slip"][held] == 0.0)
    assert np.ptp(run["m.position"][held]) == 0.0
