"""A driveline and the controller of its gearbox, run together."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from math import inf, isfinite
from numbers import Real
from typing import SupportsFloat

from clutchwork.base import UseError, dataclass, quote
from clutchwork.base.errors import expect
from clutchwork.declare.calls import explained
from clutchwork.run.trajectory import Trajectory
from clutchwork.shifts.controller import ShiftController
from clutchwork.shifts.given import refuse_prefix
from clutchwork.shifts.hybrid import HybridController
from clutchwork.shifts.record import Measured
from clutchwork.shifts.torque_sources import Source, TorqueShare
from clutchwork.stepping.simulator import Simulator

Controller = ShiftController | HybridController
# what else is set at a time [s]: values by signal
Also = Callable[[float, Simulator], Mapping[str, float]]
CALL, ROUND_OFF = "cw.shifts.drive", 1e-9  # s
PEDAL = "give a number from 0 to 1, down to -1 where machines brake"
ALSO = "give a function of time and Simulator that returns values by signal, such as {'brake.torque': 100.0}"


@dataclass(frozen=True)
class Sensed:
    """Which signals of a driveline the controller sees, and which one it acts on beside the pressures.

    Parameters:
        torque: signals whose sum is the torque at the input [N m], such as ("converter.turbine.torque",
        "lock_up.torque"); one with a minus before it counts negative; none: what `sources` were asked for
        throttle: signal of the throttle of the engine, set to that of the driver times what the controller asks for;
        none: the engine is one of the `sources`
        input: speed of the input of the gearbox [rad/s], by default of its input member
        output: the same of its output
        oil: temperature of the oil [K], where a shift map asks for it
        grade: of the road [rad], where one does
        charge: of the battery, where a `HybridController` asks for it
    """

    torque: tuple[str, ...] = ()
    throttle: str = ""
    input: str = ""
    output: str = ""
    oil: str = ""
    grade: str = ""
    charge: str = ""

    def __post_init__(self) -> None:
        """One name stands for a list of one."""
        if isinstance(self.torque, str):
            object.__setattr__(self, "torque", (self.torque,))


class _SensorReader:
    """Reads what the controller knows; the names are put together once."""

    def __init__(self, sensed: Sensed, sim: Simulator, control: Controller, share: TorqueShare) -> None:
        box, prefix = control.box, control.prefix
        self.sim, self.share, self.change = sim, share, 0.0
        self.ends = [sensed.input or f"{prefix}.{box.input}.speed", sensed.output or f"{prefix}.{box.output}.speed"]
        self.signs = [-1.0 if name[0] == "-" else 1.0 for name in sensed.torque]
        self.plain = [*self.ends, *(name.removeprefix("-") for name in sensed.torque)]
        beside = (("oil", sensed.oil), ("grade", sensed.grade), ("charge", sensed.charge))
        self.beside = {name: signal for name, signal in beside if signal}
        inner = {"synchroniser": ".forward_dog"}
        names = [f"{prefix}.{element.name}{inner.get(element.kind, '')}" for element in box.elements]
        self.elements = [element.name for element in box.elements]
        # a dog clutch has a rate of its angle
        self.slips = [f"{name}.slip" if f"{name}.slip" in sim else f"{name}.rate" for name in names]
        teeth = {e: f"{name}.sleeve" for e, name in zip(self.elements, names, strict=True) if f"{name}.sleeve" in sim}
        self.dogs = list(teeth)
        self.all = [*self.plain, *self.slips, *teeth.values()]

    def __call__(self, throttle: float) -> Measured:
        values = self.sim[self.all].tolist()
        first, second, *torques = values[: len(self.plain)]
        rest = values[len(self.plain) :]
        demand, least, most = self.share.limits(throttle, first)
        total = sum(sign * torque for sign, torque in zip(self.signs, torques, strict=True))
        if self.share.sources and not torques:
            total = min(max(demand + self.change, least), most)
        slips = dict(zip(self.elements, rest, strict=False))
        sleeves = dict(zip(self.dogs, rest[len(slips) :], strict=True))
        given = {name: float(self.sim[signal]) for name, signal in self.beside.items()}
        if self.share.sources:
            given |= {"demand": demand, "least": least, "most": most}
        return Measured(first, second, total, throttle, slips, sleeves, **given)


def _check_times(begin: float, until: float, steps: Mapping[str, float]) -> None:
    """UseError for an end that is none or is over, and for steps that do not go on."""
    expect(CALL, "until", until, Real, "give a time in s")
    if not isfinite(until) or until < begin - ROUND_OFF:
        raise UseError(CALL, [f"until is {until:g} s, and it is {begin:g} s: give a time that comes, in s"])
    for name, value in steps.items():
        if not isinstance(value, Real) or not 0.0 < value < inf:
            raise UseError(CALL, [f"{name} is {quote(value)}: give a time above 0 s, such as 0.01"])


def _is_pedal(value: object) -> bool:
    # np.where makes arrays of one number
    return isinstance(value, SupportsFloat) and not getattr(value, "ndim", 0) and -1.0 <= float(value) <= 1.0


def _given(throttle: Callable[[float], float] | float, time: float) -> float:
    """The pedal at a time; UseError where a function returns none."""
    value = throttle(time) if callable(throttle) else throttle
    if not _is_pedal(value):
        raise UseError(CALL, [f"throttle returned {quote(value)} at {time:g} s: {PEDAL}"])
    return value


@explained(CALL, throttle="0.3", control="control", sim="sim", until="10.0")
def drive(
    sim: Simulator,
    control: Controller,
    until: float,
    *,
    throttle: Callable[[float], float] | str | float,
    sensed: Sensed | None = None,
    also: Also | None = None,
    sources: Sequence[Source] = (),
    period: float = 0.01,
    resting: float = 0.05,
) -> Trajectory:
    """Run a driveline under the controller of its gearbox, up to a time [s]; the trajectory up to there.

    Use it for shifts on a schedule or by request: `control.records` has them afterwards. It can be called again to go
    on. UseError where nothing says the torque at the input, a dual-clutch gearbox has no `sources`, or a pedal is
    beyond -1 to 1.

    Parameters: throttle, of the driver, 0 to 1, below 0 where machines brake, a number, a function of time or a signal
    such as "driver.throttle"; sensed, signals that are read; also, what else is set, such as brakes; sources, motors
    and engine that give what a shift asks for, the first one first; period, from one call of the controller to the next
    while it shifts [s]; resting, the same between shifts.
    """
    expect(CALL, "sim", sim, Simulator, "give a cw.Simulator of the driveline")
    expect(CALL, "control", control, Controller, "give a ShiftController or a HybridController")
    expect(CALL, "sensed", sensed or Sensed(), Sensed, "give cw.shifts.Sensed(torque=...)")
    refuse_prefix(CALL, sim.system, control.box, control.prefix)
    _check_times(sim.time, until, {"period": period, "resting": resting})
    if not isinstance(throttle, str) and not callable(throttle) and not _is_pedal(throttle):
        raise UseError(CALL, [f"throttle is {quote(throttle)}: {PEDAL}, a function of time, or a signal"])
    if also is not None and not callable(also):
        raise UseError(CALL, [f"also is {quote(also)}: {ALSO}"])
    share, sensed = TorqueShare(sources), sensed or Sensed()
    asks = control.asks or ("" if control.always or sensed.torque else "nothing says the torque at the input")
    if control.always and sources:
        raise UseError(CALL, ["this controller commands engine and machines itself: leave sources out"])
    if asks and not sources:
        raise UseError(CALL, [f"{asks}: give sources, such as cw.shifts.EngineSource.of(engine)"])
    if isinstance(control, HybridController) and control.settings.electric and not sensed.charge:
        raise UseError(CALL, ['electric of the settings needs the charge: give Sensed(charge="battery.charge")'])
    read, set_, last = _SensorReader(sensed, sim, control, share), dict[str, float](), sim.time
    while sim.time < until - ROUND_OFF:
        time = sim.time
        pedal = float(sim[throttle] if isinstance(throttle, str) else _given(throttle, time))
        wanted = {} if set_ else control.commands
        now = read(pedal)
        wanted |= control.step(time, now)
        step = min(period if control.shifting or control.always else resting, until - time)
        torques, left = share.signals(control, now, pedal, time - last, step)
        read.change, last = control.torque_change(now), time
        wanted |= torques
        if sensed.throttle:
            wanted[sensed.throttle] = left
        if also is not None:
            beside = also(time, sim)
            expect(CALL, f"at {time:g} s, what also returned", beside, Mapping, ALSO)
            wanted |= beside
        changed = {name: value for name, value in wanted.items() if set_.get(name) != value}
        if changed:
            sim.set(changed)
            set_ |= changed
        sim.advance(step)
    return sim.run
