"""Controller of a power split: engine on its line, machines, battery, mode shifts. docs/theory/shifts.md (24), (25)."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import field
from itertools import pairwise
from math import inf, isfinite
from numbers import Real
from typing import Any

from clutchwork.base import UseError, dataclass, listed, near, quote
from clutchwork.base.errors import expect
from clutchwork.declare.calls import explain
from clutchwork.gearbox.gearbox import Gearbox
from clutchwork.gearbox.motion import SPLIT
from clutchwork.shifts.actuation import Actuation
from clutchwork.shifts.exchange import ratio_of
from clutchwork.shifts.lines import Line, at
from clutchwork.shifts.plant import Plant
from clutchwork.shifts.profile import Trend
from clutchwork.shifts.record import Measured, ShiftRecord
from clutchwork.shifts.settings import ShiftSettings
from clutchwork.shifts.split_motion import SplitMotion, split_motion
from clutchwork.shifts.torque_sources import EngineSource, TorqueSource

# directions of the driver; share of its idle speed from which on an engine fires, and how far ahead it is led [rad/s]
FORWARD, REVERSE, FIRES, SOFTLY = "D", "R", 0.8, 50.0
# rate at which an element is brought to equal speeds [1/s], within a tenth of that of the calls
SYNCHRONISE = 10.0
# output speed below which no ratio is looked at, and machines brake less [rad/s]
# and share of the ratio between two modes that is hysteresis
SLOW, HYSTERESIS = 5.0, 0.05
# of the charge, that is left for starting an engine which stands
RESERVE = 0.05
CALL = "cw.shifts.HybridController"
# what settings must be
BOUNDS = {
    "charge": "give a number from 0 to 1",
    "charge_power": "give a power in W, 0 or above",
    "electric": "give a power in W, 0 or above",
    "follow": "give a rate in 1/s, above 0",
}
POINTS = "give points of two numbers, the first ones rising, such as [(0.0, 900.0), (300.0, 450.0)]"


@dataclass(frozen=True)
class HybridSettings:
    """What a hybrid controller is calibrated with.

    Parameters: output_torque, of the output at full pedal over its speed, points (rad/s, N m); engine_speed, of the
    engine over its power, points (W, rad/s); charge, of the battery that is aimed at; charge_power [W], for all that it
    lacks; electric [W], power below which the engine stands while the battery has what drives, 0: it never does;
    limits, of the power that the battery takes and gives at a charge [W], such as `battery.limits`; follow [1/s], at
    which the engine comes to its speed; shift, settings of the elements.
    """

    output_torque: Line
    engine_speed: Line
    charge: float = 0.6
    charge_power: float = 5e4
    electric: float = 0.0
    limits: Callable[[float], tuple[float, float]] = field(default=lambda _: (-inf, inf))
    follow: float = 4.0
    shift: ShiftSettings = field(default_factory=ShiftSettings)

    def __post_init__(self) -> None:
        """Numbers within their bounds, lines with points; all mistakes at once."""
        bad = [
            f"{name} is {quote(getattr(self, name))}: {bound}" for name, bound in BOUNDS.items() if not self._is(name)
        ]
        lines = {"output_torque": self.output_torque, "engine_speed": self.engine_speed}
        bad += [f"{name} is {quote(line)}: {POINTS}" for name, line in lines.items() if not _is_line(line)]
        if not callable(self.limits):
            bad.append(f"limits is {quote(self.limits)}: give a function of the charge, such as battery.limits")
        if not isinstance(self.shift, ShiftSettings):
            bad.append(f"shift is {quote(self.shift)}: give cw.shifts.ShiftSettings(...)")
        if bad:
            raise UseError("cw.shifts.HybridSettings", bad)

    def _is(self, name: str) -> bool:
        value, most = getattr(self, name), 1.0 if name == "charge" else inf
        number = isinstance(value, Real) and isfinite(value) and 0.0 <= float(value) <= most
        return number and bool(value or name != "follow")


def _is_line(line: Any) -> bool:
    """Whether it has points of two numbers, in rising order."""
    try:
        points = [(x, y) for x, y in line]
    except (TypeError, ValueError):
        return False
    if not all(isinstance(number, Real) for point in points for number in point):
        return False
    rises = all(one[0] < two[0] for one, two in pairwise(points))
    return bool(points) and rises and all(isfinite(x) and isfinite(y) for x, y in points)


class HybridController:
    """Drives a gearbox with machines: the engine gives the power, the machines hold its speed and drive the output.

    Use it for power splits with two machines, of one mode or several. In a split the torques of both machines follow
    from that of the output and the one that brings the engine to its speed. Where another mode fits better, the
    machines synchronise its element, which closes without slip; they take over what the other one carries, and that
    opens. `request("R")` drives backward by the machines, `request("D")` forward again.

    Parameters:
        box: the gearbox, with the rows of its modes
        plant: of `cw.shifts.plant_of`
        machines: a `TorqueSource` by the name of each machine in the box, at its own shaft
        engine: an `EngineSource`, or a `TorqueSource` of an engine whose torque is given at once
        settings: calibration
        mode: at the start, by default the first split of the shift table
        prefix: name of the Transmission

    `cw.shifts.drive` runs it, with `sensed=cw.shifts.Sensed(charge="battery.charge")`. UseError where a machine is
    missing, or the mode is not a split. What it did is in `records`.
    """

    def __init__(
        self,
        box: Gearbox,
        plant: Plant,
        *,
        machines: Mapping[str, TorqueSource],
        engine: EngineSource | TorqueSource,
        settings: HybridSettings,
        mode: str = "",
        prefix: str = "gearbox",
    ) -> None:
        """A controller at the start of a run."""
        expect(CALL, "box", box, Gearbox, "give a cw.Gearbox, such as cw.Gearbox.load('toyota-p410')")
        expect(CALL, "plant", plant, Plant, "give cw.shifts.plant_of(driveline, box)")
        expect(CALL, "engine", engine, EngineSource | TorqueSource, "give cw.shifts.EngineSource.of(engine)")
        expect(CALL, "settings", settings, HybridSettings, "give cw.shifts.HybridSettings(...)")
        expect(CALL, "machines", machines, Mapping, "give a cw.shifts.TorqueSource by the name of each machine")
        for name, source in machines.items():
            expect(CALL, f"machine {quote(name)}", source, TorqueSource, "give a cw.shifts.TorqueSource")
        self.modes = [row for row in box.gears if box.combination(box.closed_in(row)).kind == SPLIT]
        missing = [name for name in box.machines if name not in machines]
        if missing or len(box.machines) != 2:
            give = f"give sources for {listed(missing)}" if missing else f"{quote(box.name)} does not have two machines"
            raise UseError(CALL, [give])
        self.mode = mode or next(iter(self.modes), "")
        if self.mode not in self.modes:
            raise UseError(
                CALL, [f"{quote(self.mode)} is not a split{near(self.mode, self.modes, listed(self.modes))}"]
            )
        self.box, self.machines, self.engine, self.settings, self.prefix = box, machines, engine, settings, prefix
        self.motions = {row: split_motion(box, box.closed_in(row), plant.inertias) for row in self.modes}
        self.records: list[ShiftRecord] = []
        self.always, self.torque_factor, self.blip = True, 1.0, 0.0
        self.phase, self.target = "drive", ""
        self.direction, self.stands = FORWARD, False
        self._since = self._called = 0.0
        self._output = Trend()
        self._do = Actuation(box, plant, prefix, {}, settings.shift.cone)
        self._do.only(self.mode, settings.shift)
        self._do.start()

    def request(self, direction: str) -> None:
        """Forward, "D", or backward, "R": where the pedal drives to from now on."""
        if direction not in (FORWARD, REVERSE):
            raise UseError(CALL, [f"{quote(direction)} is not a direction: request {FORWARD!r} or {REVERSE!r}"])
        self.direction = direction

    @property
    def shifting(self) -> bool:
        """Whether a mode shift goes on."""
        return self.phase != "drive"

    @property
    def asks(self) -> str:
        """What it cannot do without `sources`: nothing, it has its own."""
        return ""

    def torque_change(self, _: Measured) -> float:
        """Of others, which it does not ask."""
        return 0.0

    @property
    def commands(self) -> dict[str, float]:
        """All commands of elements by signal."""
        return dict(self._do.sent)

    def step(self, time: float, now: Measured) -> dict[str, float]:
        """Commands by signal at a time [s]: of elements, machines and engine.

        The throttle of `now` is the driver's, below zero where he brakes with the machines.
        """
        charge = self.settings.charge if now.charge is None else now.charge
        period, self._called = max(0.0, time - self._called), time
        self._output.follow(now.output_speed, period)
        with_, speeds = self.settings, (now.input_speed, now.output_speed)
        sense = -1.0 if self.direction == REVERSE else 1.0
        wanted = now.throttle * at(with_.output_torque, abs(speeds[1]))
        # machines brake to rest, and not beyond, whichever way it rolls
        wanted *= sense if wanted >= 0.0 else min(1.0, max(-1.0, speeds[1] / SLOW))
        low, high = with_.limits(charge)
        given = min(max((charge - with_.charge) * with_.charge_power, low), high)
        power = max(0.0, wanted * speeds[1] - given)
        self.stands = self._may_stand(power, max(0.0, wanted * speeds[1]), charge)
        target = 0.0 if self.stands else at(with_.engine_speed, power)
        if with_.electric:
            # it is turned softly
            target = min(target, speeds[0] + SOFTLY)
        if self.phase == "drive":
            self._choose(time, target, now)
        if self.phase == "synchronise":
            target = self._between() * speeds[1]
        low, high = self.engine.limits(speeds[0])
        torque = min(max(power / max(speeds[0], 1.0), min(0.0, high)), high)
        # what the engine does not give it drags
        fires = not with_.electric or (not self.stands and speeds[0] > FIRES * at(with_.engine_speed, 0.0))
        # at rest its drag is friction, which holds it
        torque = max(torque, low) if fires else low * min(1.0, max(0.0, speeds[0] / SLOW))
        machines = self._torques(time, target, (torque, wanted), speeds, charge)
        self._shift(time, now)
        made = self._do.outputs(period) | {self.engine.signal: self.engine.command(torque, speeds[0])}
        return made | {self.machines[name].signal: value for name, value in machines.items()}

    def _may_stand(self, power: float, driving: float, charge: float) -> bool:
        """Whether little power is wanted of the engine, and the battery has what drives [W] without it."""
        with_, stands = self.settings, self.stands
        # an engine that runs comes to rest where there is more to spare
        left = charge - (1.0 if stands else 2.0) * RESERVE
        spare = with_.limits(left)[1] if left > 0.0 else 0.0
        enough = driving < (1.0 - HYSTERESIS * (not stands)) * spare
        return enough and power < (1.0 + HYSTERESIS * stands) * with_.electric

    def _torques(
        self, time: float, target: float, given: tuple[float, float], speeds: tuple[float, float], charge: float
    ) -> dict[str, float]:
        """Torque of each machine, blended where both modes hold."""
        torque, wanted = given
        limits = self.settings.limits(charge)
        modes = {self.mode: 1.0}
        if self.phase == "hand over":
            share = min(1.0, (time - self._since) / self.settings.shift.torque_time)
            modes = {self.mode: 1.0 - share, self.target: share}
        slope, rises = self._output.slope, self.settings.follow * (target - speeds[0])
        if self.phase != "drive":
            # in the gear of both modes the engine goes with the output
            rises = self._between() * slope
            rises += SYNCHRONISE * (target - speeds[0]) if self.phase == "synchronise" else 0.0
        found = dict.fromkeys(self.box.machines, 0.0)
        for mode, share in modes.items():
            motion = self.motions[mode]
            needed = motion.inertia * rises + motion.coupling * slope - torque
            for name, value in motion.torques(needed, wanted, self._ranges(motion, speeds), limits, speeds).items():
                found[name] += share * value
        return found

    def _ranges(self, motion: SplitMotion, speeds: tuple[float, float]) -> dict[str, tuple[float, float]]:
        return {name: self.machines[name].limits(motion.speed(name, speeds)) for name in self.box.machines}

    def _choose(self, time: float, target: float, now: Measured) -> None:
        """Another mode, where the ratio that the engine should have is beyond the gear between both."""
        if now.output_speed < SLOW or not target:
            # backward, and without the engine, its mode stays
            return
        place, ratio = self.modes.index(self.mode), target / now.output_speed
        for other in self.modes[place + 1 : place + 2] + self.modes[max(0, place - 1) : place]:
            between = self._gear_between(self.mode, other)
            higher = self.modes.index(other) > place
            if between and (ratio < (1.0 - HYSTERESIS) * between if higher else ratio > (1.0 + HYSTERESIS) * between):
                self.target, self.phase, self._since = other, "synchronise", time
                record = ShiftRecord(self.mode, other, time, power_on=now.throttle >= 0.0)
                record.phases.append((time, "synchronise"))
                self.records.append(record)
                return

    def _gear_between(self, mode: str, other: str) -> float:
        """Ratio with the elements of both modes closed, 0 where it is none."""
        return ratio_of(self.box, tuple(dict.fromkeys((*self.box.closed_in(mode), *self.box.closed_in(other)))))

    def _between(self) -> float:
        return self._gear_between(self.mode, self.target)

    def _shift(self, time: float, now: Measured) -> None:
        """The element that comes closes without slip, then the other one opens without torque."""
        if self.phase == "drive":
            return
        with_, old, new = self.settings.shift, self.box.closed_in(self.mode), self.box.closed_in(self.target)
        on, off = [name for name in new if name not in old], [name for name in old if name not in new]
        if self.phase == "synchronise":
            for name in on:
                self._do.carry(name, 0.0, with_)
            filled = time - self._since >= self._do.fill_time(on, with_)
            if filled and all(abs(now.slips[name]) < with_.sync_slip for name in on):
                self._do.close(on, with_)
                self._next("hand over", time)
        elif time - self._since >= with_.torque_time:
            self._do.open(*off)
            self._next("drive", time)
            self.records[-1].end, self.mode, self.target = time, self.target, ""

    def _next(self, phase: str, time: float) -> None:
        self.phase, self._since = phase, time
        self.records[-1].phases.append((time, phase))


explain(HybridSettings, "cw.shifts")
explain(HybridController, "cw.shifts")
