"""An event-driven solver that shares no code with clutchwork: numpy, scipy and enumeration.

It is slow on purpose: every set of sticking contacts is tried at every event, smooth phases are integrated by
SciPy's DOP853 or Radau with terminal events and a small largest step. It exists to be compared with.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.integrate import solve_ivp

FORWARD, LOCKED, BACKWARD, OPEN = 1, 0, -1, 2

# below this slip [rad/s] a contact is a candidate for sticking: round-off of located crossings, far below any real slip
AT_REST = 1e-9


@dataclass(frozen=True)
class Contact:
    """A friction contact along one direction of the speeds."""

    name: str
    direction: np.ndarray
    force: Callable[[float], float]  # normal force times gain over time [N m]
    static: float
    kinetic: Callable[[float], float]  # coefficient over abs(slip)


@dataclass(frozen=True)
class Event:
    """A change of mode."""

    time: float
    contact: str
    before: int
    after: int


@dataclass
class Solution:
    """Events and the piecewise dense output."""

    events: list[Event]
    pieces: list[tuple[float, float, Callable[[float], np.ndarray]]]

    def __call__(self, times: Sequence[float] | np.ndarray) -> np.ndarray:
        """State at each time; at an event the right limit."""
        starts = np.array([piece[0] for piece in self.pieces])
        index = np.clip(np.searchsorted(starts, times, side="right") - 1, 0, None)
        return np.array([self.pieces[i][2](t) for i, t in zip(index, times, strict=True)])


@dataclass(frozen=True)
class Model:
    """M dv/dt = force(t, v, s) + sum of contacts; ds/dt = rates(t, v, s)."""

    mass: np.ndarray
    contacts: tuple[Contact, ...]
    force: Callable[[float, np.ndarray, np.ndarray], np.ndarray]
    rates: Callable[[float, np.ndarray, np.ndarray], np.ndarray]
    knots: tuple[float, ...] = ()

    def applied(self, t: float, v: np.ndarray, s: np.ndarray, modes: Sequence[int]) -> np.ndarray:
        """All forces but those of locked contacts."""
        total = self.force(t, v, s)
        for contact, mode in zip(self.contacts, modes, strict=True):
            if mode in (FORWARD, BACKWARD):
                slip = abs(contact.direction @ v)
                total = total - mode * contact.force(t) * contact.kinetic(slip) * contact.direction
        return total

    def multipliers(
        self, t: float, v: np.ndarray, s: np.ndarray, modes: Sequence[int]
    ) -> tuple[np.ndarray, np.ndarray]:
        """Torques of the locked contacts (least norm) and the acceleration of the speeds."""
        locked = [c.direction for c, mode in zip(self.contacts, modes, strict=True) if mode == LOCKED]
        total = self.applied(t, v, s, modes)
        if not locked:
            return np.zeros(0), np.linalg.solve(self.mass, total)
        rows = np.array(locked)
        compliance = rows @ np.linalg.solve(self.mass, rows.T)
        lam = -np.linalg.pinv(compliance, rcond=1e-11) @ (rows @ np.linalg.solve(self.mass, total))
        return lam, np.linalg.solve(self.mass, total + rows.T @ lam)

    def decide(self, t: float, v: np.ndarray, s: np.ndarray, modes: list[int], forced: dict[int, int]) -> list[int]:
        """Modes after an event, by trying all sets of the contacts at rest, most sticking first."""
        free = []
        base = list(modes)
        for i, contact in enumerate(self.contacts):
            slip = contact.direction @ v
            if contact.force(t) <= 0 and contact.force(t + 1e-9) <= 0:
                base[i] = OPEN
            elif i in forced:
                base[i] = forced[i]
            elif abs(slip) > AT_REST * (1 + np.max(np.abs(v))):
                base[i] = FORWARD if slip > 0 else BACKWARD
            else:
                free.append(i)
        trials = sorted(
            itertools.product((LOCKED, FORWARD, BACKWARD), repeat=len(free)), key=lambda m: -m.count(LOCKED)
        )
        for trial in trials:
            for i, mode in zip(free, trial, strict=True):
                base[i] = mode
            if self._fits(t, v, s, base, free):
                return list(base)
        raise AssertionError(f"no set of sticking contacts fits at t = {t}")

    def _fits(self, t: float, v: np.ndarray, s: np.ndarray, modes: list[int], free: list[int]) -> bool:
        lam, acceleration = self.multipliers(t, v, s, modes)
        held = iter(lam)
        for i, (contact, mode) in enumerate(zip(self.contacts, modes, strict=True)):
            if mode == LOCKED:
                if abs(next(held)) > contact.force(t) * contact.static * (1 + 1e-12):
                    return False
            elif i in free and mode * (contact.direction @ acceleration) <= 1e-9 * np.max(
                np.abs(acceleration), initial=1.0
            ):
                # one that starts to slip has to get somewhere; contacts held at their limit are not dealt with here
                return False
        return True

    def guards(self, modes: Sequence[int]) -> list[tuple[int, Callable[[float, np.ndarray], float]]]:
        """Functions that fall through zero where a contact has to change."""
        found = []
        n = len(self.mass)
        for i, (contact, mode) in enumerate(zip(self.contacts, modes, strict=True)):
            if mode in (FORWARD, BACKWARD):
                found.append((i, lambda t, y, c=contact, m=mode: m * (c.direction @ y[:n])))
            elif mode == LOCKED:
                place = sum(1 for m in modes[:i] if m == LOCKED)

                def margin(t: float, y: np.ndarray, c: Contact = contact, k: int = place) -> float:
                    return c.force(t) * c.static - abs(self.multipliers(t, y[:n], y[n:], modes)[0][k])

                found.append((i, margin))
        return found

    def project(self, v: np.ndarray, modes: Sequence[int]) -> np.ndarray:
        """Nearest speeds, in the sense of kinetic energy, at which locked contacts do not slip."""
        rows = np.array([c.direction for c, m in zip(self.contacts, modes, strict=True) if m == LOCKED])
        if not len(rows):
            return v
        impulse = np.linalg.pinv(rows @ np.linalg.solve(self.mass, rows.T), rcond=1e-11) @ (rows @ v)
        return v - np.linalg.solve(self.mass, rows.T @ impulse)


def solve(
    model: Model,
    v: np.ndarray,
    s: np.ndarray,
    t_end: float,
    *,
    rtol: float = 1e-10,
    atol: float = 1e-11,
    method: str = "DOP853",
    max_step: float = 2e-3,
) -> Solution:
    """Integrate from 0 to t_end."""
    n, t = len(v), 0.0
    modes = model.decide(t, v, s, [OPEN] * len(model.contacts), {})
    solution = Solution([], [])
    stops = [k for k in sorted(set(model.knots)) if 0 < k < t_end] + [t_end]
    for stop in stops:
        while t < stop:
            guards = model.guards(modes)
            events = []
            for _, guard in guards:
                event = lambda t, y, g=guard: g(t, y)  # noqa: E731
                event.terminal, event.direction = True, -1
                events.append(event)

            def slope(t: float, y: np.ndarray, modes: list[int] = modes) -> np.ndarray:
                acceleration = model.multipliers(t, y[:n], y[n:], modes)[1]
                return np.concatenate([acceleration, model.rates(t, y[:n], y[n:])])

            run = solve_ivp(
                slope,
                (t, stop),
                np.concatenate([v, s]),
                method,
                events=events,
                dense_output=True,
                rtol=rtol,
                atol=atol,
                max_step=max_step,
            )
            assert run.success, run.message
            solution.pieces.append((t, run.t[-1], run.sol))
            t, v, s = float(run.t[-1]), run.y[:n, -1], run.y[n:, -1]
            forced = {}
            if run.status == 1:
                for (i, _), hits in zip(guards, run.t_events, strict=True):
                    if len(hits) and modes[i] == LOCKED:
                        place = sum(1 for m in modes[:i] if m == LOCKED)
                        forced[i] = -int(np.sign(model.multipliers(t, v, s, modes)[0][place]))
            after = model.decide(t, v, s, modes, forced)
            v = model.project(v, after)
            solution.events += [
                Event(t, c.name, a, b) for c, a, b in zip(model.contacts, modes, after, strict=True) if a != b
            ]
            modes = after
    return solution
