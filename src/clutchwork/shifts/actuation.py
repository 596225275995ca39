"""Commands of shift elements: pressures of clutches and brakes, sleeves of teeth, none of freewheels."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from clutchwork.base import listed
from clutchwork.shifts.driver import ActuatorDriver
from clutchwork.shifts.exchange import FRICTION, SLEEVES

if TYPE_CHECKING:
    from clutchwork.gearbox.gearbox import Gearbox
    from clutchwork.shifts.plant import Plant
    from clutchwork.shifts.record import Measured
    from clutchwork.shifts.settings import ShiftSettings

# time between two calls, where none was seen yet [s]
PERIOD = 0.01
# lags for which an element that was filled is waited for
SETTLE = 2.0
# a sleeve that is further in is taken as engaged, one that is further out as free
ENGAGED, FREE = 0.9, 0.4


@dataclass
class Actuation:
    """The commands that hold at present, by element; freewheels have none and are passed over.

    Pressures of elements behind valves and pistons stand for torques, of which `outputs` makes commands.

    Parameters: rivals, of each synchroniser those of the same shaft, which must be out before it goes in; cone, share
    of its force with which it synchronises.
    """

    box: Gearbox
    plant: Plant
    prefix: str
    rivals: Mapping[str, tuple[str, ...]]
    cone: float
    commands: dict[str, float] = field(default_factory=dict)

    def __post_init__(self) -> None:
        self.kinds = {element.name: element.kind for element in self.box.elements}
        ends = {"clutch": "pressure", "brake": "pressure", "dog": "command", "synchroniser": "forward_dog.command"}
        self._signals = {
            name: f"{self.prefix}.{name}.{ends[kind]}" for name, kind in self.kinds.items() if kind in ends
        }
        self._signals |= {name: one.signal for name, one in self.plant.actuators.items()}
        self.drivers = {
            name: ActuatorDriver(one, one.fill_time, one.kiss) for name, one in self.plant.actuators.items()
        }
        self.sent: dict[str, float] = {}
        self.period = self._shortest = PERIOD

    def slides(self, name: str) -> bool:
        """Whether it is there and can be made to slip with a torque."""
        return self.kinds.get(name) in FRICTION

    def is_dog(self, name: str) -> bool:
        """Whether it is there and engages by teeth."""
        return self.kinds.get(name) in SLEEVES

    def carries(self, name: str, torque: float) -> bool:
        """Whether it is there and could carry a torque on its follower [N m]; a freewheel pushes one way only."""
        return bool(name) and (self.kinds[name] != "freewheel" or torque > 0.0)

    def closed_in(self, gear: str) -> tuple[str, ...]:
        """Elements of a gear, none in neutral."""
        return self.box.closed_in(gear) if gear in self.box.gears else ()

    def only(self, gear: str, with_: ShiftSettings) -> None:
        """The elements of a gear closed at once, all others open, except synchronisers, whose gears may be preselected.

        In neutral the dog clutches of first gear are in, for they cannot mesh while the input turns.
        """
        closed = self.closed_in(gear)
        if gear not in self.box.gears:
            first = max(self.box.ratios, key=lambda one: self.box.ratios[one])
            closed = tuple(name for name in self.closed_in(first) if self.kinds[name] == "dog")
        self.open(*(name for name in self.kinds if name not in (*closed, *self.rivals)))
        self.close(closed, with_)

    def engage(self, sleeve: str, now: Measured) -> bool:
        """Move a sleeve in, once its rivals are out; whether it is in."""
        rivals = self.rivals.get(sleeve, ())
        self.open(*rivals)
        if all(now.sleeves.get(name, 0.0) < FREE for name in rivals):
            self.commands[sleeve] = 1.0
        return now.sleeves.get(sleeve, 1.0) > ENGAGED

    def wrong(self, gear: str, with_: ShiftSettings, now: Measured) -> str:
        """Why a gear is not in: elements that slip, sleeves that are out; empty where it is."""
        closed = self.closed_in(gear)
        slips = [name for name in closed if self.slides(name) and abs(now.slips[name]) > with_.sync_slip]
        out = [name for name in closed if self.is_dog(name) and now.sleeves.get(name, 1.0) < ENGAGED]
        return "; ".join(f"{listed(names)} {fault}" for names, fault in ((slips, "slips"), (out, "is out")) if names)

    def holds(self, name: str, now: Measured, with_: ShiftSettings) -> bool:
        """Whether an element is closed and does not slip."""
        if self.is_dog(name):
            return now.sleeves.get(name, 0.0) > ENGAGED
        return self.commands.get(name, 0.0) > 0.0 and abs(now.slips[name]) < with_.sync_slip

    def open(self, *names: str) -> None:
        """Take all pressure away, or pull the sleeve out."""
        self.commands.update({name: 0.0 for name in names if name in self._signals})

    def close(self, names: Iterable[str], with_: ShiftSettings) -> None:
        """Full pressure, or the sleeve in."""
        wanted = {name: 1.0 if self.is_dog(name) else with_.full_pressure for name in names if name in self._signals}
        self.commands.update(wanted)

    def carry(self, name: str, torque: float, with_: ShiftSettings) -> None:
        """The pressure with which an element that slips carries a torque [N m]."""
        if self.slides(name):
            self.commands[name] = self.pressure(name, torque, with_)

    def pressure(self, name: str, torque: float, with_: ShiftSettings) -> float:
        """Pressure [Pa] at which an element that slips carries a torque [N m], up to the full one."""
        touch = max(with_.fill_pressure, self.plant.touch[name])
        return min(with_.full_pressure, touch + torque / self.plant.capacity[name])

    def fill_time(self, names: Iterable[str], with_: ShiftSettings) -> float:
        """For which elements are filled [s]: until the slowest of them touches, and its lag is over."""
        drivers = [self.drivers[name] for name in names if name in self.drivers]
        return max([with_.fill_time, *(SETTLE * one.of.lag + one.fill_time * (1.0 - one.level) for one in drivers)])

    def settling(self, names: Iterable[str]) -> float:
        """For which commands of elements are ahead of their torques [s]."""
        return max([0.0, *(SETTLE * self.drivers[name].of.lag for name in names if name in self.drivers)])

    def start(self) -> None:
        """As a run begins: what is closed is filled and has its torque."""
        for name, one in self.drivers.items():
            closed = self.commands.get(name, 0.0) > 0.0
            one.level, one.torque = float(closed), one.of.most if closed else 0.0
        self.outputs(0.0)

    def outputs(self, passed: float, *, shifting: bool = True) -> dict[str, float]:
        """Commands by signal, those that change alone; passed, time since the last call [s].

        While it shifts it is called most often, so the shortest time between calls is that to the next one; at rest it
        is the last one.
        """
        self._shortest = min(self._shortest, passed) if passed > 0.0 else self._shortest
        self.period = self._shortest if shifting or passed == 0.0 else passed
        now = {self._signals[name]: self._output(name, passed) for name in self.commands}
        cones = (name for name in self.commands if self.kinds[name] == "synchroniser")
        now |= {f"{self.prefix}.{name}.forward_cone.normal_force": self.cone * self.commands[name] for name in cones}
        changed = {signal: value for signal, value in now.items() if self.sent.get(signal) != value}
        self.sent = now
        return changed

    def _output(self, name: str, passed: float) -> float:
        pressure, driver = self.commands[name], self.drivers.get(name)
        if driver is None:
            return pressure
        torque = max(0.0, pressure - self.plant.touch[name]) * self.plant.capacity[name]
        return driver.command(torque, passed, self.period, open_=pressure == 0.0)
