"""Operating points of power splits: speeds and torques of all that turns, electric machines included."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from typing import TYPE_CHECKING, NamedTuple

from clutchwork.base import UseError, dataclass, listed, quote
from clutchwork.declare.rational import Row, eliminate, exact
from clutchwork.gearbox.balance import GIVEN, LOAD, BalanceRows, BalanceSolution, UnknownTorque, no_losses
from clutchwork.gearbox.gear_set import HOUSING
from clutchwork.gearbox.motion import speeds as free_speeds

if TYPE_CHECKING:
    from clutchwork.gearbox.definition import Definition

Floats = Mapping[str, float]
Exact = Mapping[str, Fraction]
ZERO, ONE = Fraction(0), Fraction(1)
CALL = "box.operating_point"


class Wanted(NamedTuple):
    """What is known of an operating point: speeds by member; torques at input, output and machines; electric power."""

    speeds: Exact
    torque: Fraction
    output_torque: Fraction | None
    machines: Exact
    battery_power: Fraction | None


@dataclass(frozen=True)
class OperatingPoint:
    """A gearbox with electric machines at work, without losses: all in rad/s, N m and W.

    Parameters:
        mode: row of the shift table, empty where the closed elements are none of it
        closed: elements that are closed
        speeds: of each member
        slips: speed of the follower of each open element over its base
        torques: on the follower of each closed element
        input_torque: from the engine on the input
        output_torque: from the output on what it drives
        machine_torques: of each machine on its member
        machine_powers: the same times its speed: what it drives with, negative where it generates
        set_torques: on the member at each port of each set
        set_powers: the same times the speed of the member
        input_power: of the engine
        output_power: what the output drives with
        battery_power: sum of the powers of the machines
        electric_power: what goes the electric way: the power of all machines that drive, or of all that generate and of
            the battery where it gives some
        circulating: largest power at a port of a set above those of input and output: what runs in a circle
    """

    mode: str
    closed: tuple[str, ...]
    speeds: Floats
    slips: Floats
    torques: Floats
    input_torque: float
    output_torque: float
    machine_torques: Floats
    machine_powers: Floats
    set_torques: Mapping[str, Floats]
    set_powers: Mapping[str, Floats]
    input_power: float
    output_power: float
    battery_power: float
    electric_power: float
    circulating: float

    @property
    def ratio(self) -> float:
        """Speed of the input over that of the output; infinite where the output stands."""
        return self._input / self._output if self._output else float("inf")

    @property
    def electric_share(self) -> float:
        """Share of the power of the engine that goes the electric way."""
        return self.electric_power / abs(self.input_power) if self.input_power else float("inf")

    @property
    def _input(self) -> float:
        return next(iter(self.speeds.values()))

    @property
    def _output(self) -> float:
        return list(self.speeds.values())[1]


class MechanicalPoint(NamedTuple):
    """A ratio at which a machine stands, so that nothing goes the electric way."""

    machine: str
    ratio: float


def operating_point(box: Definition, closed: tuple[str, ...], mode: str, wanted: Wanted) -> OperatingPoint:
    """The operating point of closed elements; UseError where what is known is too little, or too much."""
    turning = _speeds(box, closed, wanted.speeds)
    found = _torques(box, closed, turning, wanted)
    machines = {
        name: wanted.machines[name] if name in wanted.machines else found.value(UnknownTorque(name, "machine"))
        for name in box.machines
    }
    load = -wanted.output_torque if wanted.output_torque is not None else found.value(LOAD)
    _known_all({**{f"machine {name}": value for name, value in machines.items()}, "output": load})
    torques = {name: value or ZERO for name, value in machines.items()}
    powers = {name: torque * turning[box.machines[name]] for name, torque in torques.items()}
    given, taken = wanted.torque * turning[box.input], -(load or ZERO) * turning[box.output]
    sets = found.sets(box)
    ends = {one.name: one.members for one in box.sets}
    set_powers = {
        name: {port: _float(t if t is None else t * _of(turning, ends[name][port])) for port, t in ports.items()}
        for name, ports in sets.items()
    }
    most = max((abs(power) for of in set_powers.values() for power in of.values()), default=0.0)
    driving = sum((power for power in powers.values() if power > 0), ZERO)
    open_ = [element for element in box.elements if element.name not in closed]
    return OperatingPoint(
        mode=mode,
        closed=closed,
        speeds=_floats(turning),
        slips={e.name: float(_of(turning, e.follower) - _of(turning, e.base)) for e in open_},
        torques={name: _float(found.value(UnknownTorque(name, ""))) for name in closed},
        input_torque=float(wanted.torque),
        output_torque=-_float(load),
        machine_torques=_floats(torques),
        machine_powers=_floats(powers),
        set_torques={name: {port: _float(value) for port, value in ports.items()} for name, ports in sets.items()},
        set_powers=set_powers,
        input_power=float(given),
        output_power=float(taken),
        battery_power=float(sum(powers.values(), ZERO)),
        electric_power=float(max(driving, driving - sum(powers.values(), ZERO))),
        circulating=max(0.0, most - max(abs(float(given)), abs(float(taken)))),
    )


def _speeds(box: Definition, closed: tuple[str, ...], known: Exact) -> dict[str, Fraction]:
    """Speed of each member where some are known; members that turn freely beside stand."""
    rows = free_speeds(box, closed)
    free = list(dict.fromkeys(place for row in rows.values() for place in row))
    solving = eliminate(({**rows[member], GIVEN: -speed} for member, speed in known.items()), free, traced=False)
    spare = [rest for _, rest in solving.spare if rest.get(GIVEN)]
    if spare:
        raise UseError(CALL, [f"the speeds of {listed(list(known))} do not fit each other: give one of them less"])
    idle = {member for member in box.shafts if len(rows[member]) == 1}
    idle_places = {place for member in idle for place in rows[member]}
    for place in free:
        if place in idle_places and place not in solving.solved:
            solving.add({place: ONE})
    found = dict[str, Fraction]()
    for member, row in rows.items():
        rest = solving.rest(row)
        if rest.keys() - {GIVEN}:
            open_ = [box.members[place] for place in free if place not in solving.solved]
            asked = listed([_asked(box, one) for one in open_])
            raise UseError(CALL, [f"speeds are left free: give {asked} too"])
        found[member] = rest.get(GIVEN, ZERO)
    return found


def _asked(box: Definition, member: str) -> str:
    """How the speed of a member is given."""
    usual = {box.input: "speed", box.output: "output_speed"}
    return usual.get(member, f"speeds={{{quote(member)}: ...}}")


def _torques(box: Definition, closed: tuple[str, ...], turning: Exact, wanted: Wanted) -> BalanceSolution:
    """Torques from the balance of all members, and of the electric power: equations (4) to (6), and (12)."""
    rows = BalanceRows(box, closed, no_losses(box))
    rows.act(box.input, wanted.torque)
    rows.act(box.output, LOAD if wanted.output_torque is None else -wanted.output_torque)
    electric: Row = {GIVEN: -(wanted.battery_power or ZERO)}
    for name, member in box.machines.items():
        torque = wanted.machines.get(name)
        rows.act(member, UnknownTorque(name, "machine") if torque is None else torque)
        column = rows.column(UnknownTorque(name, "machine")) if torque is None else GIVEN
        electric[column] = electric.get(column, ZERO) + turning[member] * (ONE if torque is None else torque)
    if wanted.battery_power is not None:
        rows.rows.append({column: value for column, value in electric.items() if value})
    found = rows.solved()
    if any(rest.get(GIVEN) for _, rest in found.echelon.spare):
        reasons = "the torques that are given do not balance, or the power of the machines has nowhere to go"
        raise UseError(CALL, [f"{reasons}: give less of machines, output_torque and battery_power"])
    return found


def _known_all(values: Mapping[str, Fraction | None]) -> None:
    open_ = [name for name, value in values.items() if value is None]
    if open_:
        remedy = "give one more as `machines`, or `output_torque`"
        raise UseError(CALL, [f"torques are left free, of {listed(open_)}: {remedy}"])


def mechanical_points(box: Definition, closed: tuple[str, ...]) -> list[MechanicalPoint]:
    """The ratios at which a machine stands, where two speeds are free: equation (13)."""
    rows = free_speeds(box, closed)
    upper, lower = (next(iter(rows[member])) for member in (box.input, box.output))
    found = list[MechanicalPoint]()
    for name, member in box.machines.items():
        by_input, by_output = rows[member].get(upper, ZERO), rows[member].get(lower, ZERO)
        if by_input or by_output:
            found.append(MechanicalPoint(name, float(-by_output / by_input) if by_input else float("inf")))
    return sorted(found, key=lambda point: -point.ratio)


def exactly(values: Mapping[str, float], known: Mapping[str, object], what: str) -> dict[str, Fraction]:
    """Numbers by name as fractions; UseError for names that are not known."""
    wrong = [name for name in values if name not in known]
    if wrong:
        raise UseError(CALL, [f"{quote(name)} is not a {what}; choose from {listed(list(known))}" for name in wrong])
    return {name: exact(value) for name, value in values.items()}


def _of(turning: Exact, member: str) -> Fraction:
    return ZERO if member == HOUSING else turning[member]


def _float(value: Fraction | None) -> float:
    return float("nan") if value is None else float(value)


def _floats(values: Exact) -> dict[str, float]:
    return {name: float(value) for name, value in values.items()}
