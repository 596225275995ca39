"""Bristles of GMS that stick are springs with dampers: a body on them swings as one does."""

from __future__ import annotations

from math import sqrt

import numpy as np
import pytest

import clutchwork as cw
from reference.friction import sets
from support.runs import TIGHT

MASS, LOAD, START = 2.0, 5.0, 1e-3  # kg, N, m/s
# so high a Stribeck speed that the elements break away as at rest
QUIET = {"static": 1.0, "kinetic": 0.7, "speed": 1e3}


@pytest.mark.parametrize("damping", [0.0, 5.0, 20.0])
def test_a_body_on_bristles_swings_as_on_a_spring_and_a_damper(damping: float) -> None:
    d = cw.Driveline("body")
    m = d.mass("m", mass=MASS, speed=START)
    law = cw.GMS(**QUIET, elements=sets.FEW, damping=damping)
    d.add(cw.BearingFriction("c", shaft=m, friction=law, torque=LOAD))
    run = d.simulate(0.1, dt=0.005, **TIGHT)
    # the swing stays below 1e-5 m, at which the first element would break away
    stiffness = LOAD * sum(share / deflection for deflection, share in sets.FEW)
    fading = 0.5 * LOAD * damping / MASS
    turning = sqrt(stiffness / MASS - fading**2)
    phase = turning * run.time
    closed = START * np.exp(-fading * run.time) * (np.cos(phase) - fading / turning * np.sin(phase))
    # four swings, each within the tolerance of 1e-10
    assert run["m.speed"] == pytest.approx(closed, abs=1e-8 * START)
