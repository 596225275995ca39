"""Two discs and a clutch whose pressure is free: least heat with a bounded jerk, and least squared jerk.

The problems of benchmarks/peers/by_nosnoc.py, as models of this package, with what is known of them apart from it.
"""

from __future__ import annotations

import random
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.linalg import expm

import clutchwork as cw

Array = NDArray[np.float64]
END, LOCKED_BY = 2.1, 1.5  # s
MOST, JERK, WEIGHT = 80.0, 250.0, 1e-3  # N m, rad/s3, s3/(kg m2)


@dataclass(frozen=True)
class Launch:
    """An engine at speed under a torque, and a load at rest with a drag, both as discs."""

    engine: float = 0.2  # kg m2
    load: float = 0.8  # kg m2
    speed: float = 100.0  # rad/s
    torque: float = 20.0  # N m
    drag: float = 0.2  # N m s

    def driveline(self, profile: Array) -> cw.Driveline:
        """With torques of the clutch [N m] at equal instants up to LOCKED_BY."""
        d = cw.Driveline("launch")
        engine, load = d.shaft("engine", inertia=self.engine, speed=self.speed), d.shaft("load", inertia=self.load)
        d.add(cw.Torque("drive", shaft=engine, torque=self.torque))
        d.add(cw.Damper("drag", base=d.housing, follower=load, damping=self.drag))
        times = np.linspace(0.0, LOCKED_BY, len(profile))
        points = [(float(t), float(p)) for t, p in zip(times, profile, strict=True)]
        lining = cw.Coulomb(static=1.0, kinetic=1.0)
        d.add(cw.Clutch("c1", base=engine, follower=load, friction=lining, gain=1.0, pressure=cw.Table(points)))
        return d

    def least_heat(self, pieces: int, **how: Any) -> cw.Calibration:
        """Least heat and weighted square of the torque's rate; the jerk of the load is bounded, lock by LOCKED_BY."""
        times, rise = np.linspace(0.0, LOCKED_BY, pieces + 1), JERK * self.load
        return cw.calibrate(
            self.driveline(np.minimum(0.5 * rise * times, 0.9 * MOST)),
            END,
            free={"c1.pressure.values[2:]": (0.0, MOST)},
            minimise={"c1.heat": 1.0, cw.squared_slope("c1.pressure"): WEIGHT},
            subject_to=[cw.limit(cw.lock("c1"), upper=LOCKED_BY), cw.limit(cw.slope("c1.pressure"), -rise, rise)],
            **how,
        )

    def least_jerk(self, pieces: int, **how: Any) -> cw.Calibration:
        """Least squared jerk of the load; at LOCKED_BY the slip and its rate are zero."""
        times = np.linspace(0.0, LOCKED_BY, pieces + 1)
        # a ramp that leaves a third of the slip
        gone = self.speed + self.torque * LOCKED_BY / self.engine
        ramp = 1.4 * gone / (1.0 / self.engine + 1.0 / self.load) * times / LOCKED_BY**2
        rate = {"engine.acceleration": 1.0, "load.acceleration": -1.0}
        return cw.calibrate(
            self.driveline(ramp),
            LOCKED_BY,
            free={"c1.pressure.values[2:]": (0.0, 200.0)},
            minimise={cw.squared_slope("c1.pressure"): 1e-3 / self.load**2},
            # beyond zero slip there is nothing to be had: a millionth of it is left
            subject_to=[
                cw.limit("c1.slip", -1e-7 * self.speed, -1e-9 * self.speed),
                cw.limit(rate, 0.0, 0.0, name="rate of slip"),
            ],
            **how,
        )

    # ------------------------------------------------------------------------------------------- apart from the package

    def sliding(self, pieces: int) -> tuple[Array, Array]:
        """Speeds and torque at the end of each piece while the clutch slides, linear in the rates of all pieces.

        Shape (pieces, 3, pieces + 1): engine, load, torque; the last column is what is there without any rate.
        """
        A = np.zeros((5, 5))
        A[0, 2], A[0, 4] = -1.0 / self.engine, self.torque / self.engine
        A[1, 2], A[1, 1], A[2, 3] = 1.0 / self.load, -self.drag / self.load, 1.0
        step, found = expm(A * LOCKED_BY / pieces), []
        state = np.zeros((3, pieces + 1))
        state[0, -1] = self.speed
        for piece in range(pieces):
            more = np.zeros((2, pieces + 1))
            more[0, piece], more[1, -1] = 1.0, 1.0
            state = (step @ np.vstack([state, more]))[:3]
            found.append(state)
        return np.array(found), A

    def exact_least_jerk(self, pieces: int) -> tuple[float, Array]:
        """The least squared jerk and the torques, in closed form: least squares with two equations."""
        states, _ = self.sliding(pieces)
        last = states[-1]
        slip = last[0] - last[1]
        rate = -last[2] * (1.0 / self.engine + 1.0 / self.load) + last[1] * self.drag / self.load
        rate[-1] += self.torque / self.engine
        matrix, right = np.array([slip[:-1], rate[:-1]]), -np.array([slip[-1], rate[-1]])
        rates = matrix.T @ np.linalg.solve(matrix @ matrix.T, right)
        slips = (states[:, 0, :-1] - states[:, 1, :-1]) @ rates + states[:, 0, -1] - states[:, 1, -1]
        # it is the optimum where the clutch slides all the way
        assert np.min(slips) > -1e-9 * self.speed
        length = LOCKED_BY / pieces
        return 1e-3 * length * float(rates @ rates) / self.load**2, np.cumsum(rates) * length


def draws(count: int) -> Iterator[Launch]:
    """Random launches: torque 5 to 30 N m, speed 60 to 140 rad/s, load 0.4 to 1.6 kg m2, drag 0 to 0.4 N m s."""
    rng = random.Random(7)
    for _ in range(count):
        torque, speed, load, drag = rng.uniform(5, 30), rng.uniform(60, 140), rng.uniform(0.4, 1.6), rng.uniform(0, 0.4)
        yield Launch(torque=torque, speed=speed, load=load, drag=drag)


def costs(launch: Launch, profiles: Array) -> Array:
    """Heat and weighted square of the torque's rate of many profiles, by closed forms and quadrature; NaN without lock.

    Shape of profiles (count, knots). The speed of the load is that of a linear equation under a linear torque.
    """
    count, knots = profiles.shape
    length, a = LOCKED_BY / (knots - 1), launch.drag / launch.load
    nodes, shares = np.polynomial.legendre.leggauss(8)
    engine, load = np.full(count, launch.speed), np.zeros(count)
    heat, done = np.zeros(count), np.zeros(count, dtype=bool)
    rates = np.diff(profiles) / length

    def moved(tau: Array, piece: int) -> tuple[Array, Array, Array]:
        start, rate = profiles[:, piece], rates[:, piece]
        first = -np.expm1(-a * tau) / a
        second = (tau - first) / a
        torque = start + rate * tau
        one = engine + (launch.torque * tau - start * tau - 0.5 * rate * tau**2) / launch.engine
        other = load * np.exp(-a * tau) + (start * first + rate * second) / launch.load
        return one, other, torque

    for piece in range(knots - 1):
        end = np.full(count, length)
        one, other, _ = moved(end, piece)
        locks = ~done & (one - other <= 0.0)
        low, high = np.zeros(count), end.copy()
        for _ in range(60 if np.any(locks) else 0):
            middle = 0.5 * (low + high)
            slips = np.subtract(*moved(middle, piece)[:2])
            low, high = np.where(slips > 0.0, middle, low), np.where(slips > 0.0, high, middle)
        end = np.where(locks, 0.5 * (low + high), end)
        for node, share in zip(nodes, shares, strict=True):
            w1, w2, torque = moved(0.5 * (1.0 + node) * end, piece)
            heat += np.where(done, 0.0, 0.5 * share * end * torque * (w1 - w2))
        engine, load, _ = moved(end, piece)
        done |= locks
    rest = WEIGHT * length * np.sum(rates**2, axis=1)
    return np.where(done, heat + rest, np.nan)
