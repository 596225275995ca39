"""Battery that supplies electric motors."""

from __future__ import annotations

from collections.abc import Sequence
from math import inf
from typing import NamedTuple

from clutchwork.declare import Component, Found, Role, SignalLike, State, component, numbers, option, param, signal
from clutchwork.declare.node import SupplyPower
from clutchwork.elements.bases.grids import at_each

# a current that nothing limits
NO_LIMIT = 1e15


class BatteryAnswer(NamedTuple):
    """State of a battery under a power demand: current [A], voltage [V], loss [W], power delivered [W]."""

    current: float
    voltage: float
    loss: float
    given: float


@component(
    Role.PROCESS,
    states=(
        State("charge", "1", "what is in it, over its capacity"),
        State("energy", "J", "taken out of its cells since the start, at their open-circuit voltage"),
        State("loss", "J", "heat of its resistance since the start"),
        State("unserved", "J", "demanded and not given since the start, beyond its limits"),
        State("refused", "J", "offered and not taken since the start, beyond its limits"),
    ),
    hooks=("margin", "cross"),
)
class Battery(Component):
    """Battery on a DC link: open-circuit voltage and resistance over its charge, limits, energies that close.

    The DC link sums the demand of up to four loads: `cw.SupplyPower(motor)` of an electric motor, work and losses,
    negative where it charges; a signal or a number for other consumers. The current follows from `voltage current -
    resistance current^2 = power`. Use it in hybrids and electric vehicles. Controllers read its charge as a signal of
    the run and ask `limits`; energy that motors demand beyond these, or from an empty battery, is counted as
    `unserved`, what they return beyond them, or into a full one, as `refused`, so that
    `sum of loads = energy - loss + unserved - refused` always holds.

    Source: L. Guzzella, A. Sciarretta, Vehicle Propulsion Systems, 3rd ed., Springer 2013, section 4.5.
    """

    charges: Sequence[float] = numbers(
        "1", "charges of the tables; empty at the first one, full at the last one", rising="strictly", at_least=0.0,
        example=(0.0, 1.0),
    )  # fmt: skip
    voltages: Sequence[float] = numbers("V", "open-circuit voltage at each", at_least=0.0, example=(180.0, 220.0))
    resistances: Sequence[float] = numbers("ohm", "resistance at each", at_least=0.0, example=(0.3, 0.3))
    capacity: float = param("A s", "charge that it holds when it is full", above=0.0, example=23400.0)
    max_current: float = param("A", "largest current out of it, no limit by default", default=NO_LIMIT, above=0.0)
    max_charging_current: float = param(
        "A", "largest current into it, no limit by default", default=NO_LIMIT, above=0.0
    )
    initial_charge: float = option("1", "charge at the start", default=0.5, at_least=0.0, at_most=1.0)
    load: SignalLike = signal("W", "power that is asked for, as `SupplyPower(motor)`")
    second_load: SignalLike = signal("W", "that of a second consumer", default=0.0)
    third_load: SignalLike = signal("W", "that of a third one", default=0.0)
    fourth_load: SignalLike = signal("W", "that of a fourth one", default=0.0)

    def problems(self) -> Found:
        count = len(self.charges)
        found: Found = []
        for name in ("voltages", "resistances"):
            given = len(getattr(self, name))
            if given != count:
                found.append((name, f"has {given} values for {count} charges", "give one for each charge"))
        if any(voltage <= 0.0 for voltage in self.voltages):
            found.append(("voltages", "has a voltage of 0", "give voltages above 0"))
        motors = [one.of for one in self._loads() if isinstance(one, SupplyPower)]
        if len({id(motor) for motor in motors}) < len(motors):
            found.append(("second_load", "has a motor that another load has", "give each motor once"))
        if count < 2:
            found.append(("charges", "has one charge", "give at least that of an empty and that of a full battery"))
        elif self.charges[-1] > 1.0:
            found.append(("charges", f"ends at {self.charges[-1]:g}", "give shares of the capacity, up to 1"))
        elif not self.charges[0] <= self.initial_charge <= self.charges[-1]:
            ends = f"{self.charges[0]:g} to {self.charges[-1]:g}"
            found.append(("initial_charge", f"is outside of {ends}", "start within the charges of the tables"))
        return found

    def initial_states(self) -> tuple[float, ...]:
        """Charge at the start; nothing was taken yet."""
        return (self.initial_charge, 0.0, 0.0, 0.0, 0.0)

    def state_scales(self) -> tuple[float, ...]:
        """The solver follows the charge in ampere seconds."""
        return (1.0 / self.capacity, 1.0, 1.0, 1.0, 1.0)

    def voltage(self, charge: float) -> float:
        """Open-circuit voltage [V] at a charge."""
        return self._at(self.voltages, charge)

    def _loads(self) -> tuple[object, ...]:
        return self.load, self.second_load, self.third_load, self.fourth_load

    def resistance(self, charge: float) -> float:
        """Resistance [ohm] at a charge."""
        return self._at(self.resistances, charge)

    def limits(self, charge: float) -> tuple[float, float]:
        """Powers [W] that it takes and gives at most at a charge, the first one negative: motors are held within."""
        ends = self._currents(charge)
        low, high = (self._power(charge, current) for current in ends)
        return low, high

    def answer(self, charge: float, power: float) -> BatteryAnswer:
        """Its response at a charge to a power demand [W]: equation (10) of docs/theory/sources.md."""
        voltage, resistance = self.voltage(charge), self.resistance(charge)
        asked = min(power, voltage**2 / (4.0 * resistance)) if resistance else power
        root = max(voltage**2 - 4.0 * resistance * asked, 0.0) ** 0.5
        low, high = self._currents(charge)
        current = min(max(2.0 * asked / (voltage + root), low), high)
        loss = resistance * current**2
        return BatteryAnswer(current, voltage - resistance * current, loss, voltage * current - loss)

    def _currents(self, charge: float) -> tuple[float, float]:
        """Least and largest current: none out of an empty battery, none into a full one, the one of the most power."""
        resistance = self.resistance(charge)
        most = self.voltage(charge) / (2.0 * resistance) if resistance else inf
        least = inf if self.max_charging_current >= NO_LIMIT else self.max_charging_current
        low = 0.0 if charge >= self.charges[-1] else -least
        high = 0.0 if charge <= self.charges[0] else min(self.max_current, most)
        return low, high

    def _at(self, values: Sequence[float], charge: float) -> float:
        return at_each(tuple(zip(self.charges, values, strict=True)), (charge,))[0]

    def _power(self, charge: float, current: float) -> float:
        return -inf if current == -inf else (self.voltage(charge) - self.resistance(charge) * current) * current
