"""Derivatives of a gear shift with events, and by differentiating a time stepping: python -m benchmarks.why_events.

The time stepping (Moreau's, with exact sticking) is what is written by hand where a program shall be differentiated. An
imaginary part of 1e-30 goes through all of it, which gives the derivative of the program to round-off
(W. Squire, G. Trapp, SIAM Review 40 (1998), doi 10.1137/S003614459631241X).
"""

from __future__ import annotations

import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

import clutchwork as cw

MODEL = Path(__file__).resolve().parents[1] / "examples" / "six_speed" / "model.toml"
START, INSTANTS = 2.0, (2.5, 3.0)  # s
STATIC = 0.16
CLUTCHES = ("F1", "F2", "F4")
SIGNALS = ("w1.speed", "w8.speed")
TINY = 1e-30

Complex = NDArray[np.complex128]


def gearbox() -> cw.System:
    """The six-speed gearbox at rest in third gear; from 2 s on it shifts to fourth."""
    start = {
        "w1.speed": 0.0,
        "F1.pressure": cw.Table([(0.0, 0.0), (2.0, 0.0), (2.2, 0.25e6), (3.0, 0.6e6), (3.2, 2e6)]),
        "F2.pressure": cw.Table([(0.0, 2e6), (2.0, 2e6), (2.3, 0.0)]),
        "F4.pressure": cw.Table([(0.0, 2e6)]),
    }
    return cw.Driveline.load(MODEL).assemble().changed(start)


def with_events(system: cw.System) -> NDArray[np.float64]:
    """Derivatives of the speeds [rad/s] at the instants by the static coefficient of all linings."""
    wanted = {f"{signal} at {instant} s": cw.at(signal, instant) for instant in INSTANTS for signal in SIGNALS}
    run = cw.simulate(system, INSTANTS[-1], rtol=1e-9, atol=1e-11)
    found = run.gradient(of=wanted, by=[f"{clutch}.friction.static" for clutch in CLUTCHES])
    return np.asarray(found.matrix.sum(axis=1))


@dataclass(frozen=True)
class Stepping:
    """The same gearbox, stepped over speeds w1, w2, w4, w8 and the torque of the elastic shaft."""

    step: float  # s

    # inertias [kg m2], and the speeds of all members by the independent ones
    inertia = np.array([19.37, 2.73, 1.89, 2.25, 1.50, 27.31, 4.20, 5.77])
    stiffness, damping = 1165745.0, 1678.8  # N m/rad, N m s/rad
    gains = np.array([0.2652, 0.0682, 0.1789])  # m3

    def members(self) -> NDArray[np.float64]:
        """Speeds of the eight members by the independent ones, from the four planetary rows."""
        rows = np.zeros((4, 8))
        for row, (sun, ring, carrier, ratio) in enumerate(
            [(2, 0, 1, 2.78), (3, 4, 5, 1.83), (3, 5, 7, 2.35), (5, 6, 7, 2.0)]
        ):
            rows[row, [sun, ring, carrier]] = 1.0, ratio, -(1.0 + ratio)
        free, others = [0, 1, 3, 7], [2, 4, 5, 6]
        speeds = np.zeros((8, 4))
        speeds[free] = np.eye(4)
        speeds[others] = -np.linalg.solve(rows[:, others], rows[:, free])
        return speeds

    def pressures(self, t: float) -> NDArray[np.float64]:
        """Of the three clutches [Pa]."""
        oncoming = np.interp(t, [2.0, 2.2, 3.0, 3.2], [0.0, 0.25e6, 0.6e6, 2e6])
        return np.array([oncoming, np.interp(t, [2.0, 2.3], [2e6, 0.0]), 2e6])

    def speeds(self, v: NDArray[np.float64], shaft: float, static: complex) -> list[Complex]:
        """Speeds w1 and w8 at the instants."""
        members, across = self.members(), np.array([0.0, 1.0, -1.0, 0.0])
        mass, h = members.T @ (self.inertia[:, None] * members), self.step
        slips = np.array([members[0] - members[1], members[2], members[4]])
        inverse = np.linalg.inv(mass + (h * self.damping + h * h * self.stiffness) * np.outer(across, across))
        mobility = slips @ inverse @ slips.T
        speed, torque, sticks = v.astype(complex), complex(shaft), np.array([False, True, True])
        found = []
        for number in range(1, round((INSTANTS[-1] - START) / h) + 1):
            pressure = self.pressures(START + number * h)
            slip = slips @ speed
            sliding = 0.065 + 0.075 * np.exp(-0.2756 * 0.2890 * slip * np.sign(slip.real))
            bound = h * self.gains * pressure * np.where(sticks, static, sliding)
            engine = 4000.0 - 4.7746 * speed[0]
            if speed[0].real >= 209.4395:
                engine = 3000.0 - 190.9859 * (speed[0] - 209.4395)
            outside = np.array([engine, 0.0, 0.0, -4000.0 * np.tanh(speed[3] / 0.5)]) - torque * across
            free = inverse @ (mass @ speed + h * outside)
            impulse = self.impulses(slips @ free, mobility, bound)
            speed = free + inverse @ slips.T @ impulse
            torque = torque + h * self.stiffness * (across @ speed)
            sticks = (np.abs(impulse.real) < bound.real * (1 - 1e-9)) & (pressure > 0)
            if any(abs(START + number * h - instant) < 0.5 * h for instant in INSTANTS):
                found.append(speed[[0, 3]])
        return found

    def impulses(self, slip: Complex, mobility: NDArray[np.float64], bound: Complex) -> Complex:
        """Of the contacts: each holds its slip at zero as far as its bound allows (projected Gauss-Seidel)."""
        impulse = np.zeros(3, dtype=complex)
        for _ in range(12):
            for i in range(3):
                wanted = impulse[i] - (slip[i] + mobility[i] @ impulse) / mobility[i, i]
                beyond = abs(wanted.real) > bound[i].real
                impulse[i] = bound[i] * np.sign(wanted.real) if beyond else wanted
        return impulse

    def derivatives(self, v: NDArray[np.float64], shaft: float) -> NDArray[np.float64]:
        """By the static coefficient, of this program."""
        found = self.speeds(v, shaft, STATIC + 1j * TINY)
        return np.concatenate([one.imag / TINY for one in found])


def table(steps: tuple[float, ...] = (1e-3, 1e-4)) -> dict[str, NDArray[np.float64]]:
    """Derivatives of w1 and w8 at 2.5 s and at 3 s, by each way."""
    system = gearbox()
    start = cw.simulate(system, START, rtol=1e-9, atol=1e-11, times=[START])
    v = np.array([start[f"{name}.speed"][-1] for name in ("w1", "w2", "w4", "w8")])
    found = {"with events": with_events(system)}
    # at the start the elastic shaft has a torque that is made of twist alone
    shaft = float(start["shaft.torque"][-1]) - Stepping.damping * (v[1] - v[2])
    for step in steps:
        found[f"time stepping, {step:g} s"] = Stepping(step).derivatives(v, shaft)
    return found


def main() -> None:
    """Print the table."""
    steps = tuple(float(x) for x in sys.argv[1:]) or (1e-3, 1e-4)
    found = table(steps)
    exact = found["with events"]
    print("by the static coefficient      w1(2.5 s)  w8(2.5 s)    w1(3 s)    w8(3 s)   w1(2.5 s) off")
    for name, values in found.items():
        print(f"{name:28}", *(f"{value:10.6f}" for value in values), f"{abs(values[0] / exact[0] - 1):14.0%}")


if __name__ == "__main__":
    main()
