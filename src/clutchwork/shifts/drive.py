"""A driveline and the controller of its gearbox, run together."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING

from clutchwork.base.classes import dataclass
from clutchwork.shifts.controller import ShiftController
from clutchwork.shifts.record import Measured
from clutchwork.shifts.torque_sources import TorqueSource, shared

if TYPE_CHECKING:
    from clutchwork.run.trajectory import Trajectory
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
        oil: temperature of the oil [K], where a shift map asks for it
        grade: of the road [rad], where one does
    """

    torque: tuple[str, ...]
    throttle: str = ""
    input: str = ""
    output: str = ""
    oil: str = ""
    grade: str = ""

    def __post_init__(self) -> None:
        """One name stands for a list of one."""
        if isinstance(self.torque, str):
            object.__setattr__(self, "torque", (self.torque,))

    def read(self, sim: Simulator, control: ShiftController, throttle: float) -> Measured:
        """What the controller knows at the present time of a run; throttle, of the driver."""
        return _SensorReader(self, sim, control)(throttle)


class _SensorReader:
    """Reads what the controller knows; the names are put together once."""

    def __init__(self, sensed: Sensed, sim: Simulator, control: ShiftController) -> None:
        box, prefix = control.box, control.prefix
        self.sim, self.control = sim, control
        self.ends = [sensed.input or f"{prefix}.{box.input}.speed", sensed.output or f"{prefix}.{box.output}.speed"]
        self.signs = [-1.0 if name[0] == "-" else 1.0 for name in sensed.torque]
        self.plain = [*self.ends, *(name.removeprefix("-") for name in sensed.torque)]
        self.beside = {name: signal for name, signal in (("oil", sensed.oil), ("grade", sensed.grade)) if signal}
        names = [f"{prefix}.{element.name}" for element in box.elements]
        self.elements = [element.name for element in box.elements]
        # a dog clutch has a rate of its angle
        self.slips = [f"{name}.slip" if f"{name}.slip" in sim else f"{name}.rate" for name in names]
        self.dogs = [name for name in self.elements if f"{prefix}.{name}.sleeve" in sim]
        self.sleeves = [f"{prefix}.{name}.sleeve" for name in self.dogs]

    def __call__(self, throttle: float) -> Measured:
        first, second, *torques = self.sim[self.plain].tolist()
        total = sum(sign * torque for sign, torque in zip(self.signs, torques, strict=True))
        slips = dict(zip(self.elements, self.sim[self.slips].tolist(), strict=True))
        sleeves = dict(zip(self.dogs, self.sim[self.sleeves].tolist(), strict=True)) if self.dogs else {}
        beside = {name: float(self.sim[signal]) for name, signal in self.beside.items()}
        return Measured(first, second, total, throttle, slips, sleeves, **beside)


def drive(
    sim: Simulator,
    control: ShiftController,
    until: float,
    *,
    sensed: Sensed,
    throttle: Callable[[float], float],
    also: Also | None = None,
    sources: Sequence[TorqueSource] = (),
    period: float = 0.01,
    resting: float = 0.05,
) -> Trajectory:
    """Run a driveline under the controller of its gearbox, up to a time [s]; the trajectory up to there.

    Use it for shifts on a schedule or by request: `control.records` has them afterwards. It can be called again to go
    on.

    Parameters: throttle, of the driver over time, 0 to 1; also, what else is set, such as brakes; sources, motors that
    give what a shift asks for before the engine does, the first one first; period, from one call
    of the controller to the next while it shifts [s]; resting, the same between shifts.
    """
    read = _SensorReader(sensed, sim, control)
    set_: dict[str, float] = {}
    while sim.time < until - 1e-9:
        time, pedal = sim.time, float(throttle(sim.time))
        wanted = {} if set_ else control.commands
        now = read(pedal)
        wanted |= control.step(time, now)
        torques, left = shared(control, now, sources, pedal)
        wanted |= torques
        if sensed.throttle:
            wanted[sensed.throttle] = left
        if also is not None:
            wanted |= also(time, sim)
        changed = {name: value for name, value in wanted.items() if set_.get(name) != value}
        if changed:
            sim.set(changed)
            set_ |= changed
        sim.advance(min(period if control.shifting else resting, until - time))
    return sim.run
