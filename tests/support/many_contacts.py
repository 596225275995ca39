"""Drivelines whose n contacts all lock at one instant and all break away at another, with their closed forms.

Shafts of inertia J stand in a row; contact i lies between shafts i - 1 and i. While all slip forward with the torques
K_i = J c i (n - i + 1) / 2 every slip falls by c per second, and so they end together where they start equal. Torques
r J (n / 2 - i) on the shafts put M_i = r J i (n - i + 1) / 2 on the locked contacts, the same share of all capacities.
"""

from __future__ import annotations

import clutchwork as cw

INERTIA, SLIP, RATE = 0.5, 10.0, 20.0  # kg m2, rad/s at the start, rad/s2
LOCK = SLIP / RATE  # s
RAMP = 8.0  # rad/s3, of r
SHARE = 2.0  # of the static torque in the kinetic one
BREAK = 1.0 + SHARE * RATE / RAMP  # s, the ramp starts at 1 s


def row(n: int) -> cw.Driveline:
    """A row of n + 1 shafts with n contacts."""
    d = cw.Driveline(f"{n} contacts at once")
    shafts = [d.shaft(f"s{i}", inertia=INERTIA, speed=SLIP * (n - i)) for i in range(n + 1)]
    law = cw.Coulomb(static=0.1 * SHARE, kinetic=0.1)
    for i in range(1, n + 1):
        force = 10.0 * kinetic(n, i)
        d.add(cw.Clutch(f"c{i}", base=shafts[i - 1], follower=shafts[i], friction=law, gain=1.0, normal_force=force))
    for i, shaft in enumerate(shafts):
        slope = RAMP * INERTIA * (n / 2 - i)
        d.add(cw.Torque(f"t{i}", shaft=shaft, torque=cw.Table([(0.0, 0.0), (1.0, 0.0), (101.0, 100.0 * slope)])))
    return d


def kinetic(n: int, i: int) -> float:
    """Kinetic torque of contact i [N m]."""
    return 0.5 * INERTIA * RATE * i * (n - i + 1)


def star(n: int) -> cw.Driveline:
    """n equal shafts on one hub by equal clutches, so that each of them acts on all others; the hub is driven."""
    d = cw.Driveline(f"{n} clutches on a hub")
    hub = d.shaft("hub", inertia=10.0 * INERTIA)
    law = cw.Coulomb(static=0.1 * SHARE, kinetic=0.1)
    for i in range(1, n + 1):
        shaft = d.shaft(f"s{i}", inertia=INERTIA, speed=SLIP)
        d.add(cw.Clutch(f"c{i}", base=hub, follower=shaft, friction=law, gain=1.0, normal_force=100.0))
    # at 1 s + BREAK it accelerates all shafts by what a clutch holds
    torque = SHARE * 10.0 * (10.0 + n)
    d.add(cw.Torque("drive", shaft=hub, torque=cw.Table([(0.0, 0.0), (1.0, 0.0), (101.0, 100.0 * torque)])))
    return d
