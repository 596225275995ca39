"""Cycles of slip: friction takes energy, and Maxwell-slip laws remember loops within loops."""

from __future__ import annotations

from math import pi
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import clutchwork as cw
from clutchwork.declare.schema import Role
from reference.friction import core, sets
from reference.friction.histories import sweeps
from support import samples
from support.amount import part

# amplitudes [m] from deep in the elastic zone to sliding, and frequencies [Hz] on both sides of the Stribeck speed
AMPLITUDES = st.floats(-6.0, -2.5).map(lambda x: round(10.0**x, 9))
FREQUENCIES = st.floats(-0.5, 1.0).map(lambda x: round(10.0**x, 3))


def stored(law: Any, run: Any) -> np.ndarray:
    """Elastic energy [J] of the states: stiffness is force per deflection."""
    if not law.own_states():
        return np.zeros(len(run.time))
    elements = getattr(law, "elements", None)
    stiffness = [share * law.static / d for d, share in elements] if elements else [law.stiffness]
    parts = [run[f"c.{s.name}"] ** 2 / (2.0 * k) for s, k in zip(law.own_states(), stiffness, strict=True)]
    return np.sum(parts, axis=0)


@pytest.mark.parametrize("name", sets.PASSIVE)
@settings(max_examples=part(6))
@given(first=AMPLITUDES, second=AMPLITUDES, frequency=FREQUENCIES, phase=st.floats(0.0, 6.0))
def test_friction_dissipates_in_every_motion(
    name: str, first: float, second: float, frequency: float, phase: float
) -> None:
    """Work less stored energy never falls; over a cycle that closes, work alone is that."""
    law, other = sets.PASSIVE[name], frequency * 2.3
    waves = [
        cw.Sine(amplitude=2.0 * pi * frequency * first, frequency=frequency, phase=phase),
        cw.Sine(amplitude=2.0 * pi * other * second, frequency=other),
    ]
    # at the ends of steps, where the work is that of the quadrature; rows inside a step have the cubic through its
    # powers, whose error no tolerance bounds: docs/theory/integrators.md (16)
    run = core.run(core.moved(law, *waves), [1.5 / frequency], steps=True)
    lost = run["c.heat"] - stored(law, run)
    assert len(lost) > 20
    # energy that was turned over, at the tolerance of the run
    assert np.min(np.diff(lost)) >= -1e-8 * run["c.heat"][-1] - 1e-16


def cycle(law: cw.Law, amplitude: float, frequency: float) -> tuple[float, float]:
    """Heat [J] of the fourth cycle of a sine about the place of rest, and how well it closes."""
    signal = cw.Sine(amplitude=2.0 * pi * frequency * amplitude, frequency=frequency, phase=pi / 2)
    run = core.run(core.moved(law, signal), [0.0, 3.0 / frequency, 4.0 / frequency])
    gap = max(float(abs(np.diff(run[f"c.{s.name}"])[-1])) for s in law.own_states())
    return float(np.diff(run["c.heat"])[-1]), gap


@pytest.mark.parametrize("name", sets.SWINGS)
@settings(max_examples=part(12))
@given(amplitude=AMPLITUDES, frequency=FREQUENCIES)
def test_friction_dissipates_in_every_swing(name: str, amplitude: float, frequency: float) -> None:
    heat, gap = cycle(sets.SWINGS[name], amplitude, frequency)
    assert gap < 1e-5
    # a purely elastic cycle loses nothing; the cycle closes within the gap, which is worth gap x amplitude
    assert heat >= -(1e-9 + 2.0 * gap) * amplitude


@settings(max_examples=part(10))
@given(there=st.floats(2e-5, 5e-4), back=st.floats(1e-6, 1e-4), time=st.floats(0.005, 0.3))
def test_gms_gives_away_no_more_than_its_bound(there: float, back: float, time: float) -> None:
    """Sliding fast, stepping back slowly: (26) bounds the gain of each reversal."""
    law: Any = sets.DRIFT["gms"]
    bound = sum(share * deflection / (2 * law.static) for deflection, share in law.elements) * 0.3**2
    slip = sweeps((0.0, there, there - back, there, there - back, there, 0.0), time=time)
    run = core.run(core.moved(law, cw.Table(list(slip.points))), np.linspace(0.0, 6.0 * time, 601))
    lost = run["c.heat"] - stored(law, run)
    assert np.min(np.diff(lost)) >= -bound
    assert lost[-1] >= -6 * bound


def test_mykhalevych_with_too_little_inner_friction_drives_a_swing() -> None:
    """0.05 with 0.7 of the static friction: a limit cycle of the specification, far below the bound of 0.19 at rest."""
    law = cw.Mykhalevych(**sets.WOUND | {"viscous": 0.05})
    with pytest.warns(cw.ModelWarning, match="dissipative"):
        core.pushed(law).assemble()
    # a small swing whose speed reaches that of the Stribeck fall
    assert cycle(law, 2e-5, 0.01 / (2.0 * pi * 2e-5))[0] < 0.0
    assert cycle(cw.Mykhalevych(**sets.WOUND | {"viscous": 0.5}), 2e-5, 0.01 / (2.0 * pi * 2e-5))[0] > 0.0


@pytest.mark.parametrize("cls", [cls for cls in samples.declared(Role.LAW) if cls.sticks], ids=lambda cls: cls.kind)
def test_laws_that_stick_dissipate_at_any_slip(cls: type) -> None:
    law = samples.law(cls)
    run = core.run(core.moved(law, cw.Sine(amplitude=5.0, frequency=2.0)), np.linspace(0.0, 1.0, 201))
    assert np.max(run["c.power"]) <= 0.0
    assert np.min(np.diff(run["c.heat"])) >= 0.0


# --- memory ---

# so slow that the level is that of rest: a millionth of the Stribeck speed
QUIET: dict[str, float] = {"static": 1.0, "kinetic": 0.7, "speed": 1e3}
REMEMBER: dict[str, cw.Law] = {
    "leuven": cw.Leuven(**QUIET, elements=sets.FEW, order=80.0),
    "gms": cw.GMS(**QUIET, elements=sets.FEW, attraction=1e6),
}


def forces(law: cw.Law, places: tuple[float, ...]) -> np.ndarray:
    """Friction [N] at each of the places that the slip goes through."""
    slip = sweeps(places)
    run = core.run(core.moved(law, cw.Table(list(slip.points))), np.arange(len(places), dtype=float))
    return -run["c.torque"]


@pytest.mark.parametrize("name", REMEMBER)
def test_loops_close(name: str) -> None:
    """A loop within a loop within a loop: at each return to a turning point the force is back."""
    law = REMEMBER[name]
    places = (0.0, 6e-5, -2e-5, 3e-5, 0.0, 1e-5, 0.0, 3e-5, -2e-5, 6e-5)
    f = forces(law, places)
    for first, again in ((4, 6), (3, 7), (2, 8), (1, 9)):
        assert f[again] == pytest.approx(f[first], abs=1e-9)


@pytest.mark.parametrize("name", REMEMBER)
def test_a_closed_loop_is_forgotten(name: str) -> None:
    """Beyond its closing the force is that of the major branch, as if the minor loop had never been."""
    law = REMEMBER[name]
    straight = forces(law, (0.0, 4e-5, 6e-5, 9e-5))
    with_loop = forces(law, (0.0, 4e-5, 1e-5, 2e-5, 1e-5, 4e-5, 6e-5, 9e-5))
    assert with_loop[-3:] == pytest.approx(straight[-3:], abs=1e-9)
    # it was another branch meanwhile
    assert abs(with_loop[3] - forces(law, (0.0, 2e-5))[-1]) > 0.05


@pytest.mark.parametrize("name", REMEMBER)
def test_virgin_curve_and_masing_rule(name: str) -> None:
    """From a turning point on the branch is the virgin curve, twice as large."""
    law: Any = REMEMBER[name]
    reach = np.array([0.5e-5, 2e-5, 4e-5])
    f0 = forces(law, (0.0, 6e-5))[-1]
    virgin = [sum(min(x / d, 1.0) * share for d, share in law.elements) for x in reach]
    for x, force in zip(reach, virgin, strict=True):
        assert forces(law, (0.0, float(x)))[-1] == pytest.approx(force, abs=1e-9)
        assert forces(law, (0.0, 6e-5, 6e-5 - 2 * float(x)))[-1] == pytest.approx(f0 - 2 * force, abs=1e-9)


@pytest.mark.parametrize("name", ["lugre", "dahl", "elastoplastic"])
def test_one_state_remembers_no_loop(name: str) -> None:
    """What tells the Maxwell-slip laws from bristles: there the minor loop does not close."""
    force = forces(sets.PASSIVE[name], (0.0, 9e-5, 6e-5, 9e-5))
    assert abs(force[3] - force[1]) > 1e-3
