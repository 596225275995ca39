"""How a law predicts the torque of measured samples, by the sort of law."""

from __future__ import annotations

import warnings
from dataclasses import replace
from typing import TYPE_CHECKING, TypeAlias

import numpy as np
from numpy.typing import NDArray

from clutchwork.assembly.records import frozen
from clutchwork.base import ModelWarning
from clutchwork.base.arrays import Array
from clutchwork.declare.options import Options
from clutchwork.driveline.driveline import Driveline
from clutchwork.elements.brake import Brake
from clutchwork.elements.prescribed_speed import PrescribedSpeed
from clutchwork.fit.sliding import Sliding, Smooth, at_rest
from clutchwork.model.pools import Pools
from clutchwork.run.failure import StoppedEarly
from clutchwork.run.simulation import simulate
from clutchwork.signals.table import Table

if TYPE_CHECKING:
    from clutchwork.assembly.system import System
    from clutchwork.declare.node import Law
    from clutchwork.fit.measurement import Measurement

Model: TypeAlias = "Sliding | Smooth | Running"
RTOL, ATOL = 1e-9, 1e-11
# a run that fails counts as so many times the largest torque off
FAILED = 10.0


class Running:
    """Residuals of a law with states: every sample gives an equation.

    The slip is linear between the samples. A record that begins in motion is taken to have gone on like this before,
    one that begins at rest begins relaxed.
    """

    exact = False

    def __init__(self, measured: Measurement, law: Law, rest: float | None) -> None:
        self.measured = measured
        self.rest = at_rest(measured, rest)
        moving = abs(float(measured.slip[0])) > self.rest
        self.lead = float(measured.time[-1]) if moving else 0.0
        self.system, self.first = _bench(measured, law, self.lead)
        self.times = measured.time + self.lead

    @property
    def equations(self) -> NDArray[np.bool_]:
        """Samples that give an equation: all."""
        return np.ones(len(self.times), dtype=bool)

    def torque(self, law: Law) -> Array:
        """Torque of every sample [N m], of the sign of the slip while it slides."""
        options = Options(rtol=RTOL, atol=ATOL, times=self.times, angles=False, work=False)
        with warnings.catch_warnings():
            # a law that cannot be run is a bad one, and the search goes elsewhere
            warnings.simplefilter("ignore", StoppedEarly)
            run = simulate(_with_law(self.system, self.first, law), float(self.times[-1]), options=options)
        made = np.full(len(self.times), np.nan)
        made[: len(run)] = -run["contact.torque"]
        worst = FAILED * float(np.max(np.abs(self.measured.torque)))
        return np.where(np.isfinite(made), made, self.measured.torque + worst)


def _bench(measured: Measurement, law: Law, lead: float) -> tuple[System, int]:
    """A shaft with the measured slip, braked by the law under the measured load; where the law's parameters begin."""
    bench = Driveline("measurement")
    shaft = bench.shaft("slider", inertia=1.0)
    times = (measured.time + lead).tolist()
    slip = Table(list(zip(times, measured.slip.tolist(), strict=True)))
    load = Table(list(zip(times, measured.load.tolist(), strict=True)))
    bench.add(PrescribedSpeed("slip", shaft=shaft, speed=slip))
    bench.add(Brake("contact", shaft=shaft, friction=law, gain=1.0, normal_force=load))
    with warnings.catch_warnings():
        # what is rarely wanted of a law is told of the fitted one, not of every trial
        warnings.simplefilter("ignore", ModelWarning)
        system = bench.assemble()
    return system, int(system.contact_law_param[0])


def _with_law(system: System, first: int, law: Law) -> System:
    """The bench with other values of the law; its parameters are the last ones, its curves the only ones."""
    pools = Pools()
    pools.add(law, "law")
    arrays = dict(system.arrays)
    arrays["params"] = np.concatenate([system.params[:first], pools.params])
    arrays["points"] = np.array(pools.points, dtype=float).reshape(-1, 3)
    return replace(system, arrays=frozen(arrays))


def model_of(measured: Measurement, law: Law, rest: float | None) -> Model:
    """The model for a law: set-valued, a function of the slip, or with a memory."""
    if law.sticks:
        return Sliding(measured, law, rest)
    return Running(measured, law, rest) if law.own_states() else Smooth(measured, rest)
