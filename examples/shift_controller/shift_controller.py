"""A shift controller with states, called every 10 ms: python examples/shift_controller/shift_controller.py [FOLDER]."""

from __future__ import annotations

import sys
from dataclasses import dataclass
from pathlib import Path

import clutchwork as cw

MODEL = Path(__file__).resolve().parents[1] / "six_speed" / "model.toml"
PERIOD = 0.01  # s
FULL = 2e6  # Pa
ON, OFF, HELD = "F1", "F2", "F4"  # closes, opens, stays closed: third gear to fourth


@dataclass
class ShiftController:
    """Third gear to fourth: F1 takes over from F2, then pulls the turbine down.

    waiting   third gear
    filling   F1 is filled, F2 falls towards what it has to hold
    torque    F1 takes over the torque, until F2 slips
    inertia   F2 is open; the slip of F1 follows a straight line down to zero
    closing   F1 holds: up to full pressure
    done      fourth gear
    """

    begin: float = 2.0  # s, when the shift is asked for
    duration: float = 0.6  # s, of the inertia phase
    state: str = "waiting"
    since: float = 0.0  # s, begin of the state
    on: float = 0.0  # Pa
    off: float = FULL  # Pa
    slip: float = 0.0  # rad/s, of the oncoming clutch where the inertia phase begins
    base: float = 0.0  # Pa, of the oncoming clutch there, and what the integral adds

    def step(self, time: float, slip_on: float, slip_off: float) -> dict[str, float]:
        """Pressures [Pa] for the next 10 ms, from two slips [rad/s] at a time [s]."""
        match self.state:
            case "waiting":
                self._wait(time)
            case "filling":
                self._fill(time)
            case "torque":
                self._take_over(time, slip_on, slip_off)
            case "inertia":
                self._pull_down(time, slip_on)
            case "closing":
                self._close(time)
        return {f"{ON}.pressure": self.on, f"{OFF}.pressure": self.off}

    def _enter(self, state: str, time: float) -> None:
        self.state, self.since = state, time

    def _wait(self, time: float) -> None:
        if time >= self.begin - 1e-9:
            self._enter("filling", time)

    def _fill(self, time: float) -> None:
        self.on, self.off = 0.08e6, max(0.15e6, self.off - 12e6 * PERIOD)
        if time - self.since >= 0.2:
            self._enter("torque", time)

    def _take_over(self, time: float, slip_on: float, slip_off: float) -> None:
        self.on += 0.6e6 * PERIOD
        self.off = max(0.0, self.off - 1.5e6 * PERIOD)
        if abs(slip_off) > 0.5:
            self.off, self.slip, self.base = 0.0, slip_on, self.on
            self._enter("inertia", time)

    def _pull_down(self, time: float, slip_on: float) -> None:
        wanted = self.slip * max(0.0, 1.0 - (time - self.since) / self.duration)
        # more pressure pulls the slip down
        excess = abs(slip_on) - abs(wanted)
        self.base += 1e5 * excess * PERIOD
        self.on = min(max(self.base + 1.5e4 * excess, 0.0), FULL)
        if abs(slip_on) < 0.2:
            self._enter("closing", time)

    def _close(self, time: float) -> None:
        self.on = min(FULL, self.on + 10e6 * PERIOD)
        if self.on == FULL:
            self._enter("done", time)


def gearbox(**changes: object) -> cw.Simulator:
    """The six-speed gearbox at rest in third gear; changes as of `System.changed`."""
    sim = cw.Simulator(cw.Driveline.load(MODEL).assemble().changed({"w1.speed": 0.0, **changes}))
    sim.set({f"{ON}.pressure": 0.0, f"{OFF}.pressure": FULL, f"{HELD}.pressure": FULL})
    return sim


def lining(factor: float) -> dict[str, object]:
    """The lining of the oncoming clutch with its coefficients times a factor, as changes of the gearbox."""
    cold = {"static": 0.16, "slow": 0.14, "fast": 0.065}
    return {f"{ON}.friction.{name}": factor * value for name, value in cold.items()}


def drive(
    sim: cw.Simulator,
    controller: ShiftController,
    until: float,
) -> list[tuple[float, str]]:
    """Let a controller shift up to a time [s]; when it entered which state."""
    states = [(sim.time, controller.state)]
    while sim.time < until - 1e-9:
        sim.set(controller.step(sim.time, *sim[[f"{ON}.slip", f"{OFF}.slip"]]))
        if controller.state != states[-1][1]:
            states.append((sim.time, controller.state))
        sim.advance(PERIOD)
    return states


def picture(run: cw.Trajectory, path: Path) -> None:
    """Pressures, slips and the torque of the output shaft during the shift."""
    pressures, slips = (f"{ON}.pressure", f"{OFF}.pressure"), (f"{ON}.slip", f"{OFF}.slip")
    run.plot(pressures, slips, "shaft.torque", zoom=(1.9, 3.3), path=path)


if __name__ == "__main__":
    sim, folder = gearbox(), Path(sys.argv[1] if len(sys.argv) > 1 else "out/shift_controller")
    for time, state in drive(sim, ShiftController(), 4.0):
        print(f"{time:5.2f} s  {state}")
    print(sim.events)
    folder.mkdir(parents=True, exist_ok=True)
    picture(sim.run, folder / "shift_controller.png")
