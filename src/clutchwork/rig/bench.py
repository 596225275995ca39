"""The test bench: one body with one contact, pushed by forces or moved with a given speed."""

from __future__ import annotations

import warnings
from numbers import Real
from typing import Any

import numpy as np

from clutchwork.base import ModelWarning, dataclass
from clutchwork.base.arrays import Array
from clutchwork.declare.node import Domain, Law, Node, SignalLike
from clutchwork.declare.options import Options
from clutchwork.driveline.driveline import Driveline
from clutchwork.elements.bearing_friction import BearingFriction
from clutchwork.elements.prescribed_speed import PrescribedSpeed
from clutchwork.elements.torque import Torque
from clutchwork.rig.presets import Preset
from clutchwork.run.failure import StoppedEarly
from clutchwork.run.trajectory import Trajectory

# tight, because creep of 1e-9 m is to be seen beside sliding of 0.1 m
ACCURATE = Options(rtol=1e-8, atol=1e-12)


@dataclass(frozen=True)
class Bench:
    """One law on the bench, loaded so that its friction is that of the preset."""

    label: str
    law: Law
    preset: Preset
    options: Options = ACCURATE

    @property
    def load(self) -> float:
        """Normal load [N] under which the law has the static force of the preset, or the kinetic where it has one only.

        So a lining with a coefficient of 0.12 is compared with the laws of the preset under the same forces.
        ValueError for a law whose static coefficient is a curve.
        """
        static = self.law.static
        if static is not None and not isinstance(static, Real):
            what = f"the rig has no temperature, and {self.label!r} is a {type(self.law).__name__} over it"
            raise ValueError(f"{what}: give its values at one temperature as a FrictionTable")
        if static is not None:
            return self.preset.force / float(static)
        kinetic: Any = self.preset.kinetic if self.law.kinetic is None else self.law.kinetic
        return self.preset.load * self.preset.kinetic / float(kinetic)

    def body(self, d: Driveline, name: str = "body", **start: Any) -> Node:
        """Add a shaft or a mass, as the preset wants it."""
        if self.preset.domain is Domain.ROTATION:
            return d.shaft(name, inertia=start.pop("mass", self.preset.mass), **start)
        return d.mass(name, mass=start.pop("mass", self.preset.mass), **start)

    def pushed(self, *forces: SignalLike) -> Driveline:
        """A body at rest on the ground, pushed by the sum of some forces [N]."""
        d = Driveline(f"{self.label}, pushed")
        body = self.body(d)
        d.add(BearingFriction("friction", shaft=body, friction=self.law, torque=self.load))
        for number, force in enumerate(forces, 1):
            d.add(Torque(f"push{number}", shaft=body, torque=force))
        return d

    def moved(self, speed: SignalLike, start: float = 0.0) -> Driveline:
        """A body that moves over the ground with a given speed [m/s], which begins with `start`."""
        d = Driveline(f"{self.label}, moved")
        body = self.body(d, speed=start)
        d.add(BearingFriction("friction", shaft=body, friction=self.law, torque=self.load))
        d.add(PrescribedSpeed("motion", shaft=body, speed=speed))
        return d

    def simulate(self, d: Driveline, t_end: float, **changes: Any) -> Trajectory:
        """Run up to t_end [s]; a run that stops early is reported by the table, not by a warning.

        Nor does it warn that a law of a preset can generate energy: the effect of that is part of the comparison.
        """
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", StoppedEarly)
            if self.law in [self.preset.law(kind) for kind in self.preset.laws]:
                warnings.simplefilter("ignore", ModelWarning)
            return d.simulate(t_end, options=self.options.changed(changes))


def friction(run: Trajectory) -> Array:
    """Friction force against the motion [N]."""
    return -np.asarray(run["friction.torque"], dtype=float)


def position(run: Trajectory, body: str = "body") -> Array:
    """Displacement of a body [m]."""
    name = f"{body}.position" if f"{body}.position" in run else f"{body}.angle"
    return np.asarray(run[name], dtype=float)


def speed(run: Trajectory, body: str = "body") -> Array:
    """Speed of a body [m/s]."""
    return np.asarray(run[f"{body}.speed"], dtype=float)
