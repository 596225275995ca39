"""States of phases in which locked contacts follow loads go on with the same bits."""

from __future__ import annotations

from typing import Any

import pytest

import clutchwork as cw


def lossy_box() -> cw.Driveline:
    """Locked contacts beside meshes whose friction follows their loads."""
    d = cw.Driveline("lossy box")
    engine, wheels = d.shaft("engine", inertia=0.02, speed=0.0), d.shaft("wheels", inertia=0.06)
    d.add(cw.Torque("drive", shaft=engine, torque=-47.0))
    d.add(cw.Transmission("box", input=engine, output=wheels, gearbox="ford-10r80", gear="2", efficiency=0.77))
    return d


def lossy_ring() -> cw.Driveline:
    """A lossy mesh and a locked clutch that hold a shaft in two ways, beside a weaker one; one pressure falls."""
    d = cw.Driveline("lossy ring")
    a, b = d.shaft("a", inertia=0.08), d.shaft("b", inertia=0.07)
    d.add(cw.Torque("drive", shaft=b, torque=12.0))
    d.add(cw.LossyGear("mesh", input=a, output=b, ratio=-0.8, efficiency=0.6))
    law = cw.Coulomb(static=0.2, kinetic=0.15)
    d.add(cw.Brake("weak", shaft=b, friction=law, gain=1.0, normal_force=200.0, locked=True))
    force = cw.Table([(0.0, 700.0), (1.0, 50.0)])
    d.add(cw.Clutch("strong", base=a, follower=b, friction=law, gain=1.0, normal_force=force, locked=True))
    return d


@pytest.mark.parametrize("made", [lossy_box, lossy_ring])
@pytest.mark.parametrize("method", ["dopri5", "rodas5p"])
def test_what_follows_loads_goes_on_as_it_was_sorted(made: Any, method: str) -> None:
    """Which of the locked contacts come first in a set was decided at the start of the phase."""
    whole = cw.simulate(made(), 0.9, output="steps", method=method)
    for t in whole.time[1:-1]:
        rest = cw.simulate(made(), 0.9, start=whole.state(at=float(t)), output="steps", method=method)
        assert rest.rows.tobytes() == whole.rows[-len(rest.time) :].tobytes(), t
