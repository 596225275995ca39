"""CoupledClutches of the Modelica Standard Library: four discs, three clutches, against a lean SciPy RK45."""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

import clutchwork as cw
from benchmarks.core import Prepared
from benchmarks.report import Row
from benchmarks.timing import cpu, ratio, rounds
from clutchwork.declare.options import Method

T_END = 1.5
# the cosine passes zero at 1.25 s
KNOTS = (0.4, 0.9, 1.25, T_END)
KINETIC, STATIC = 10.0, 11.0


def driveline() -> cw.Driveline:
    """Normalised forces: cosine, step at 0.4 s, step at 0.9 s."""
    d = cw.Driveline("CoupledClutches")
    J = [d.shaft(f"J{i}", inertia=1.0, speed=10.0 if i == 1 else 0.0) for i in range(1, 5)]
    d.add(cw.Torque("torque", shaft=J[0], torque=cw.Sine(amplitude=10.0, frequency=5.0)))
    law = cw.Coulomb(static=0.55, kinetic=0.5)
    forces = (
        cw.Sine(amplitude=20.0, frequency=0.2, phase=math.pi / 2),
        cw.Step(height=20.0, start=0.4),
        cw.Step(height=20.0, start=0.9),
    )
    for i, force in enumerate(forces):
        d.add(cw.Clutch(f"clutch{i + 1}", base=J[i], follower=J[i + 1], friction=law, gain=1.0, normal_force=force))
    return d


class Lean:
    """The same by hand for SciPy: one right-hand side per set of modes, terminal events, plain Python floats."""

    def __init__(self, rtol: float, atol: float) -> None:
        self.rtol, self.atol = rtol, atol
        self.slip = np.zeros((3, 4))
        for i in range(3):
            self.slip[i, i : i + 2] = -1.0, 1.0
        self.events: list[tuple[float, int, int]] = []

    @staticmethod
    def force(i: int, t: float) -> float:
        """Normalised force of clutch i."""
        return max(math.cos(0.4 * math.pi * t), 0.0) if i == 0 else float(t >= (0.4, 0.9)[i - 1])

    def load(self, t: float, modes: tuple[int, ...], forces: tuple[float, ...]) -> np.ndarray:
        """Applied torques."""
        Q = np.array([10.0 * math.sin(10 * math.pi * t), 0.0, 0.0, 0.0])
        for i, mode in enumerate(modes):
            if mode and forces[i] > 0:
                Q[i] += mode * KINETIC * forces[i]
                Q[i + 1] -= mode * KINETIC * forces[i]
        return Q

    def matrices(self, modes: tuple[int, ...]) -> tuple[np.ndarray, np.ndarray]:
        """Acceleration and multipliers from the applied torques."""
        locked = [i for i, mode in enumerate(modes) if mode == 0]
        S = np.zeros((3, 4))
        if locked:
            B = self.slip[locked]
            S[locked] = -np.linalg.solve(B @ B.T, B)
        return np.eye(4) + self.slip.T @ S, S

    def solve(self) -> np.ndarray:
        """Speeds at the end; 2 stands for an open clutch."""
        self.events.clear()
        w, t = np.array([10.0, 0.0, 0.0, 0.0]), 0.0
        modes: tuple[int, ...] = (-1, 2, 2)
        for stop in KNOTS:
            while t < stop:
                t, w, modes = self.phase(t, stop, w, modes)
        return w

    def phase(
        self, t: float, stop: float, w: np.ndarray, modes: tuple[int, ...]
    ) -> tuple[float, np.ndarray, tuple[int, ...]]:
        """Until something changes."""
        # others take the driveline alone, and wait for no import of SciPy
        from scipy.integrate import solve_ivp

        middle = 0.5 * (t + stop)
        forces = [lambda t, i=i: self.force(i, t) if i == 0 else self.force(i, middle) for i in range(3)]

        def now(t: float) -> tuple[float, ...]:
            return tuple(f(t) for f in forces)

        modes = tuple(self.closed(i, m, w, now(middle)[i]) for i, m in enumerate(modes))
        sliding = tuple(0 if m == 2 else m for m in modes)
        signs = tuple(m if m in (-1, 1) else 0 for m in sliding)
        constraint = tuple(0 if m == 0 else 1 for m in modes)
        A, S = self.matrices(constraint)

        def slope(t: float, y: np.ndarray) -> np.ndarray:
            return A @ self.load(t, signs, now(t))

        guards = []
        for i, mode in enumerate(modes):
            if mode == 0:
                guards.append((i, lambda t, y, i=i: STATIC * forces[i](t) - abs(S[i] @ self.load(t, signs, now(t)))))
            elif mode != 2:
                guards.append((i, lambda t, y, i=i, m=mode: m * (y[i + 1] - y[i])))
        found = [g for _, g in guards]
        for guard in found:
            guard.terminal, guard.direction = True, -1  # type: ignore[attr-defined]
        s = solve_ivp(slope, (t, stop), w, "RK45", events=found, rtol=self.rtol, atol=self.atol)
        t, w = float(s.t[-1]), s.y[:, -1].copy()
        after = list(modes)
        for (i, _), hits in zip(guards, s.t_events, strict=True):
            if len(hits):
                after[i] = self.switched(i, t, w, modes, signs, now(t), S)
                self.events.append((t, i, after[i]))
                if after[i] == 0:
                    w[i] = w[i + 1] = 0.5 * (w[i] + w[i + 1])
        return t, w, tuple(after)

    def closed(self, i: int, mode: int, w: np.ndarray, force: float) -> int:
        """An open clutch that gets a force slides or sticks; one that loses it opens."""
        if force <= 0:
            return 2
        if mode != 2:
            return mode
        slip = w[i + 1] - w[i]
        return 0 if abs(slip) < 1e-12 else int(math.copysign(1, slip))

    def switched(
        self,
        i: int,
        t: float,
        w: np.ndarray,
        modes: tuple[int, ...],
        signs: tuple[int, ...],
        forces: tuple[float, ...],
        S: np.ndarray,
    ) -> int:
        """The mode after an event of clutch i."""
        if modes[i] == 0:
            return -int(math.copysign(1, S[i] @ self.load(t, signs, forces)))
        trial = tuple(0 if k == i or m == 0 else 1 for k, m in enumerate(modes))
        rest = tuple(0 if k == i else s for k, s in enumerate(signs))
        needed = abs(self.matrices(trial)[1][i] @ self.load(t, rest, forces))
        return 0 if needed <= STATIC * forces[i] else -modes[i]


def break_away(rtol: float) -> float | None:
    """The time near 0.831 s at which a locked clutch lets go [s], None when it is stepped over."""
    run = cw.simulate(driveline(), T_END, rtol=rtol, atol=1e-2 * rtol, dt=T_END)
    found = [e.time for e in run.events if e.before == "locked" and abs(e.time - 0.831) < 2e-3]
    return found[0] if found else None


def error(system: cw.System, method: Method) -> float:
    """Largest error of the speeds on a grid of 1 ms against a run at tight tolerances [rad/s]."""
    exact, run = (
        cw.simulate(system, T_END, dt=1e-3, method=method, rtol=rtol, atol=1e-2 * rtol) for rtol in (1e-12, 1e-6)
    )
    return max(float(np.max(np.abs(run[f"J{i}.speed"] - exact[f"J{i}.speed"]))) for i in range(1, 5))


def rows(quick: bool = False) -> Iterator[Row]:
    """The lines of the table."""
    system, lean = driveline().assemble(), Lean(1e-6, 1e-8)
    prepared = {method: Prepared(system, T_END, method) for method in ("auto", "rodas5p")}
    # the same motion, or the comparison means nothing
    ours = cw.simulate(driveline(), T_END, dt=T_END, rtol=1e-6, atol=1e-8)
    gap = float(np.max(np.abs(lean.solve() - np.array([ours[f"J{i}.speed"][-1] for i in range(1, 5)]))))
    contestants = {name: each.measure(100) for name, each in prepared.items()} | {"scipy": lambda: cpu(lean.solve, 3)}
    taken = rounds(contestants, 2 if quick else 5)
    own = {name: 1e6 * sorted(taken[name])[len(taken[name]) // 2] for name in prepared}
    times, chosen = ratio(taken["scipy"], taken["auto"]), ratio(taken["auto"], taken["rodas5p"])
    yield Row("CoupledClutches: method chosen, core alone", f"{own['auto']:.0f} us")
    yield Row("CoupledClutches: method chosen / Rodas5P", f"{chosen:.2f}", "<= 0.70", chosen <= 0.70)
    yield Row("CoupledClutches: SciPy RK45 / ours", f"{times:.0f} x", ">= 300 x", times >= 300)
    for method in prepared:
        worst = error(system, method)
        limit = "<= 1e-5 rad/s" if method == "auto" else ""
        met = worst <= 1e-5 if limit else None
        yield Row(f"CoupledClutches: largest speed error, {method}", f"{worst:.1e} rad/s", limit, met)
    yield Row("CoupledClutches: speeds of the two apart at the end", f"{gap:.1e} rad/s")
    tolerances = [10.0**-k for k in range(3, 11)]
    found = [break_away(rtol) for rtol in tolerances]
    missed = [f"{rtol:g}" for rtol, t in zip(tolerances, found, strict=True) if t is None]
    words = f"missed at {', '.join(missed)}" if missed else f"{found[-1]:.6f} s, at all"
    yield Row("CoupledClutches: break-away at rtol 1e-3 ... 1e-10", words, "found at all", not missed)
