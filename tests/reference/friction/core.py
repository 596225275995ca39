"""The histories as clutchwork models: a unit mass with one contact to the ground."""

from __future__ import annotations

import warnings
from math import pi
from typing import Any

import clutchwork as cw
from reference.friction.histories import Drift

# far below what the comparisons ask for
TIGHT: dict[str, Any] = {"rtol": 1e-10, "atol": 1e-12}


def pushed(law: cw.Law, *forces: Any, mass: float = 1.0) -> cw.Driveline:
    """A mass pushed by the sum of some forces [N]; its contact "c" carries 1 N."""
    d = cw.Driveline("pushed")
    body = d.mass("m", mass=mass)
    d.add(cw.BearingFriction("c", shaft=body, friction=law, torque=1.0))
    for number, force in enumerate(forces):
        d.add(cw.Torque(f"f{number}", shaft=body, torque=force))
    return d


def moved(law: cw.Law, *speeds: Any, load: Any = 1.0) -> cw.Driveline:
    """A mass whose speed is the sum of some signals [m/s]; its contact "c" carries a load [N] that may vary."""
    d = cw.Driveline("moved")
    base: cw.Node | None = None
    for number, speed in enumerate(speeds):
        node = d.mass(f"m{number}" if number < len(speeds) - 1 else "m", mass=1.0, speed=None)
        d.add(cw.PrescribedSpeed(f"p{number}", shaft=node, base=base, speed=speed))
        base = node
    d.add(cw.Brake("c", shaft=d.nodes[-1], friction=law, gain=1.0, normal_force=load))
    return d


def drift(law: cw.Law, history: Drift) -> cw.Driveline:
    """The drift test: the sine ends by one of opposite sign."""
    turns = 2.0 * pi * ((history.frequency * (history.end - history.begin)) % 1.0)
    swing, frequency = history.swing, history.frequency
    return pushed(
        law,
        cw.Table(list(history.corners)),
        cw.Sine(amplitude=swing, frequency=frequency, start=history.begin),
        cw.Sine(amplitude=-swing, frequency=frequency, start=history.end, phase=turns),
    )


def run(d: cw.Driveline, times: Any, *, steps: bool = False, **options: Any) -> Any:
    """A tight run with samples at given times or at all steps; published parameters may be warned of."""
    output = {"output": "steps"} if steps else {"times": times}
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", cw.ModelWarning)
        return d.simulate(float(times[-1]), **output | TIGHT | options)
