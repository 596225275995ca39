"""Synthetic measurements of friction: what a rig with a known law would show, with noise."""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

import clutchwork as cw
from clutchwork.base.errors import ModelWarning
from clutchwork.fit.adjustable import faults
from clutchwork.fit.ordinates import axis, ordinates, tables, with_ordinates
from clutchwork.fit.sliding import coefficients
from clutchwork.laws.bases.tables import Tabulated
from support import samples

Array = NDArray[np.float64]

# values that an excitation of seconds and 1e-4 rad can show; all others are the examples of the declarations
SHOWN = {
    "slow": 0.13,
    "damping": 0.5,
    "exponent": 2.0,
    "attraction": 30.0,
    "order": 1.5,
    "width": 0.05,
}
# factors of start values; those of the others is 1.4
OFF = {"static": 0.8, "kinetic": 0.8, "slow": 0.8, "stiffness": 0.7, "elastic": 0.8}
LOAD = 20.0  # N m, on average
NOISE = 0.01  # N m


@dataclass(frozen=True)
class Data:
    """What was measured."""

    time: Array
    slip: Array
    torque: Array
    load: Array
    temperature: Array | None = None

    @property
    def arguments(self) -> dict[str, Any]:
        """As `fit_law` takes them."""
        made = {name: getattr(self, name) for name in ("time", "slip", "torque", "load")}
        return made if self.temperature is None else made | {"temperature": self.temperature}


def true_law(cls: Any) -> Any:
    """A law whose parameters the excitation shows."""
    law: Any = samples.law(cls)
    known = {item.name for item in fields(law)}
    return replace(law, **{name: value for name, value in SHOWN.items() if name in known})


def start_law(law: Any, names: list[str]) -> Any:
    """The law with some parameters off by a factor, the coefficients by the same one."""
    made = replace(law, **{name: OFF.get(name, 1.4) * getattr(law, name) for name in names})
    if faults(made):
        # coefficients that belong together
        made = replace(law, **{name: 0.8 * getattr(law, name) for name in names})
    moved = {
        name: with_ordinates(law, name, [0.8 * y for y in ordinates(law, name).values()]) for name in tables(type(law))
    }
    if not faults(replace(made, **moved)):
        return replace(made, **moved)
    return replace(made, **{name: rows for name, rows in moved.items() if not faults(replace(made, **{name: rows}))})


def excitation() -> tuple[Array, Array]:
    """Times [s] and slips [rad/s]: small and large displacements, slow and fast, one after the other."""
    parts = [
        (3e-5, 1.0, 2),
        (1e-4, 1.0, 2),
        (6e-5, 40.0, 3),
        (2e-4, 0.5, 2),
        (0.03, 0.5, 2),
        (0.5, 0.5, 2),
        (2.0, 0.5, 1),
    ]
    times, slips = [0.0], [0.0]
    for amplitude, frequency, periods in parts:
        t = np.arange(1, 60 * periods + 1) / (60.0 * frequency)
        slips += (amplitude * 2.0 * np.pi * frequency * np.sin(2.0 * np.pi * frequency * t)).tolist()
        times += (times[-1] + t).tolist()
    return np.array(times), np.array(slips)


def measured(law: Any, seed: int = 2, noise: float = NOISE) -> Data:
    """Samples that determine all parameters of a law."""
    made = rested(law) if law.sticks else run(law, *excitation())
    made.torque[:] += noise * np.random.default_rng(seed).standard_normal(len(made.torque))
    return made


def run(law: Any, times: Array, slips: Array) -> Data:
    """The torque along a slip, computed by a clutch between two shafts; counted with the slip."""
    d = cw.Driveline("rig")
    plate, drum = d.shaft("plate", inertia=1.0), d.shaft("drum", inertia=1.0)
    load = LOAD * (1.0 + 0.2 * np.sin(3.0 * times))
    d.add(cw.PrescribedSpeed("hold", shaft=plate, speed=0.0))
    d.add(
        cw.PrescribedSpeed("drive", shaft=drum, speed=cw.Table(list(zip(times.tolist(), slips.tolist(), strict=True))))
    )
    pressing = cw.Table(list(zip(times.tolist(), load.tolist(), strict=True)))
    d.add(cw.Clutch("c", base=plate, follower=drum, friction=law, gain=1.0, normal_force=pressing))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ModelWarning)
        made = d.simulate(float(times[-1]), times=times, rtol=1e-10, atol=1e-12)
    made.raise_for_status()
    return Data(times, slips, -made["c.torque"], load)


def rested(law: Any, repeats: int = 12, temperatures: Sequence[float] = ()) -> Data:
    """Break-aways under a slow ramp of the torque, each followed by a sweep of the slip, to both sides in turn.

    Along a table the sweep reaches its end, and the repeats pass from the first of its temperatures to the last.
    """
    torque, slip, warm = [], [], []
    known = temperatures or axis(law, "K")
    fastest = max(axis(law, "rad/s"), default=12.0) if isinstance(law, Tabulated) else 12.0
    for number in range(repeats):
        side = 1.0 if number % 2 == 0 else -1.0
        sweep = np.geomspace(fastest / 600.0, fastest, 40)
        at = np.full(40, np.linspace(known[0], known[-1], repeats)[number]) if known else None
        static = coefficients(law, np.zeros(1), None if at is None else at[:1])[1][0]
        ramp = np.linspace(0.0, 1.0, 40) * static * LOAD
        torque += [*(side * ramp), *(side * LOAD * coefficients(law, sweep, at)[0])]
        slip += [*np.zeros(40), *(side * sweep)]
        warm += [] if at is None else [*at, *at]
    time = 0.01 * np.arange(len(slip))
    temperature = np.array(warm) if known else None
    return Data(time, np.array(slip), np.array(torque), np.full(len(slip), LOAD), temperature)
