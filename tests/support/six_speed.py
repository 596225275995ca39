"""The six-speed planetary gearbox and its two runs: the launch with the 3-4 shift, and the benchmark shift.

Data: the paper behind the main reference case (inertias kg m2, tooth ratios z_ring/z_sun, clutch constants m3).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import clutchwork as cw

INERTIA = {"w1": 19.37, "w2": 2.73, "w3": 1.89, "w4": 2.25, "w5": 1.50, "w6": 27.31, "w7": 4.20, "w8": 5.77}
K1, K2, K3, K4 = 2.78, 1.83, 2.35, 2.0
STIFFNESS, DAMPING = 1165745.0, 1678.8
GAIN = {"F1": 0.2652, "F2": 0.0682, "F4": 0.1789}
STATIC = 0.16
KNEE = 209.4395

# coefficient 0.065 + 0.075 exp(-0.2756 re |w|), re = 0.2890 m
LAW = {"static": STATIC, "slow": 0.140, "fast": 0.065, "speed": 1 / (0.2756 * 0.2890)}

# engine: 4000 - 4.7746 w up to the knee, then 3000 - 190.9859 (w - knee); the lines miss each other by 0.01 N m
ENGINE = [(0.0, 4000.0), (KNEE, 4000.0 - 4.7746 * KNEE), (KNEE + 100.0, 3000.0 - 19098.59)]

# name: (base, follower); slip = follower - base
CLUTCHES = {"F1": ("w2", "w1"), "F2": ("housing", "w3"), "F4": ("housing", "w5")}

# the benchmark shift: third gear locked at rest, 3-4 shift (pressures in Pa)
SHIFT = {
    "F1": [(0.0, 0.0), (2.0, 0.0), (2.2, 0.25e6), (3.0, 0.6e6), (3.2, 2e6)],
    "F2": [(0.0, 2e6), (2.0, 2e6), (2.3, 0.0)],
    "F4": [(0.0, 2e6)],
}


def gearbox(
    pressures: Mapping[str, Any],
    speeds: Mapping[str, float] | None = None,
    *,
    stiffer: float = 1.0,
    law: cw.Law | None = None,
) -> cw.Driveline:
    """Gearbox with engine and load; the pressure of a clutch is a list of points or a signal."""
    d, w = members(speeds or {}, stiffer=stiffer)
    for name, (base, follower) in CLUTCHES.items():
        given = pressures[name]
        pressure = cw.Table([(float(t), float(p)) for t, p in given]) if isinstance(given, Sequence) else given
        friction = law or cw.Exponential(**LAW)
        d.add(
            cw.Clutch(name, base=w[base], follower=w[follower], friction=friction, gain=GAIN[name], pressure=pressure)
        )
    d.add(cw.SpeedTorque("engine", shaft=w["w1"], torque=ENGINE))
    d.add(cw.ResistingTorque("load", shaft=w["w8"], torque=4000.0, speed=0.5))
    return d


def members(speeds: Mapping[str, float], *, stiffer: float = 1.0) -> tuple[cw.Driveline, dict[str, cw.Node]]:
    """The eight members, four planetary rows and the elastic shaft, without clutches and torques.

    `stiffer` multiplies the stiffness of the shaft; its damping goes with the root, so that the damping ratio stays.
    """
    d = cw.Driveline("six-speed gearbox")
    # a speed that is not given follows from the others
    w = {name: d.shaft(name, inertia=J, speed=speeds.get(name)) for name, J in INERTIA.items()}
    w["housing"] = d.housing
    d.add(cw.Planetary("divider", sun=w["w3"], ring=w["w1"], carrier=w["w2"], ratio=K1))
    d.add(cw.Planetary("row1", sun=w["w4"], ring=w["w5"], carrier=w["w6"], ratio=K2))
    d.add(cw.Planetary("row2", sun=w["w4"], ring=w["w6"], carrier=w["w8"], ratio=K3))
    d.add(cw.Planetary("row3", sun=w["w6"], ring=w["w7"], carrier=w["w8"], ratio=K4))
    # base w2 and follower w4: the torque on the follower is M_shaft of the reference
    rates = {"stiffness": STIFFNESS * stiffer, "damping": DAMPING * stiffer**0.5}
    d.add(cw.SpringDamper("shaft", base=w["w2"], follower=w["w4"], **rates))
    return d, w
