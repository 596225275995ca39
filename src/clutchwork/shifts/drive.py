"""A driveline and the controller of its gearbox, run together."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING

from clutchwork.base.classes import dataclass
from clutchwork.shifts.controller import Measured, ShiftController

if TYPE_CHECKING:
    from clutchwork.results.trajectory import Trajectory
    from clutchwork.stepping.simulator import Simulator

# what else is set at a time [s]: values by signal
Also = Callable[[float, "Simulator"], Mapping[str, float]]


@dataclass(frozen=True)
class Sensed:
    """Which signals of a driveline the controller sees, and which one it acts on beside the pressures.

    Parameters:
        torque: signals whose sum is the torque at the input [N m], such as ("converter.turbine.torque",
            "lock_up.torque"); one with a minus before it counts negative
        throttle: signal of the throttle of the engine, set to that of the driver times what the controller asks for
        input: speed of the input of the gearbox [rad/s], by default of its input member
        output: the same of its output
    """

    torque: tuple[str, ...]
    throttle: str = ""
    input: str = ""
    output: str = ""

    def read(self, sim: Simulator, control: ShiftController, throttle: float) -> Measured:
        """What the controller knows."""
        box, prefix = control.box, control.prefix
        ends = [self.input or f"{prefix}.{box.input}.speed", self.output or f"{prefix}.{box.output}.speed"]
        names = [element.name for element in box.elements]
        values = [float(v) for v in sim[[*ends, *(f"{prefix}.{name}.slip" for name in names), *self._plain]]]
        torques = values[2 + len(names) :]
        total = sum(-v if name[0] == "-" else v for name, v in zip(self.torque, torques, strict=True))
        return Measured(values[0], values[1], total, throttle, dict(zip(names, values[2:], strict=False)))

    @property
    def _plain(self) -> tuple[str, ...]:
        return tuple(name.removeprefix("-") for name in self.torque)


def drive(
    sim: Simulator,
    control: ShiftController,
    until: float,
    *,
    sensed: Sensed,
    throttle: Callable[[float], float],
    also: Also | None = None,
    period: float = 0.01,
    resting: float = 0.05,
) -> Trajectory:
    """Run a driveline under the controller of its gearbox, up to a time [s]; the trajectory up to there.

    Use it for shifts on a schedule or by request: `control.records` has them afterwards. It can be called again to go
    on.

    Parameters: throttle, of the driver over time, 0 to 1; also, what else is set, such as brakes; period, from one call
    of the controller to the next while it shifts [s]; resting, the same between shifts.
    """
    set_: dict[str, float] = {}
    while sim.time < until - 1e-9:
        pedal = float(throttle(sim.time))
        now = sensed.read(sim, control, pedal)
        wanted = control.commands if sim.time == 0.0 else {}
        wanted |= control.step(sim.time, now)
        if sensed.throttle:
            wanted[sensed.throttle] = min(1.0, pedal * control.torque_factor)
        wanted |= dict(also(sim.time, sim)) if also else {}
        changed = {name: value for name, value in wanted.items() if set_.get(name) != value}
        if changed:
            sim.set(changed)
            set_ |= changed
        wait = period if control.shifting else resting
        sim.advance(min(wait, until - sim.time))
    return sim.run
