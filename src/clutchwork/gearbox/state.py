"""All that a gear does: speeds, torques, powers, reaction, efficiency. docs/theory/gearboxes.md."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from typing import TYPE_CHECKING

from clutchwork.base import dataclass
from clutchwork.gearbox.balance import Balance, ideal_balance, lossy_balance
from clutchwork.gearbox.gear_set import HOUSING
from clutchwork.gearbox.motion import GEAR, combination, speeds

if TYPE_CHECKING:
    from clutchwork.gearbox.definition import Definition

Floats = Mapping[str, float]


@dataclass(frozen=True)
class GearState:
    """A gearbox in one gear, per unit speed and torque at its input, without losses except for `efficiency`.

    Parameters:
        gear: its name, empty where the closed elements are none of the shift table
        closed: elements that are closed
        ratio: speed of the input over that of the output, negative in reverse
        speeds: of each member; 1 is that of the input
        slips: speed of the follower of each open element over its base
        torques: on the follower of each closed element, as `run["gearbox.A.torque"]` shows it; NaN where several closed
            elements share one in more than one way
        set_torques: on the member at each port of each set
        set_powers: the same times the speed of the member: power leaving the set there
        load: torque on the output from outside
        housing: torque that the box puts on its housing
        circulating: largest power at a port of a set, over that of the input, above 1: power that runs in a circle
        efficiency: power at the output over that at the input with the efficiencies of the meshes
        lossy_torques: as `torques`, with these losses
    """

    gear: str
    closed: tuple[str, ...]
    ratio: float
    speeds: Floats
    slips: Floats
    torques: Floats
    set_torques: Mapping[str, Floats]
    set_powers: Mapping[str, Floats]
    load: float
    housing: float
    circulating: float
    efficiency: float
    lossy_torques: Floats

    @property
    def torque_ratio(self) -> float:
        """Torque of the output over that of the input, losses counted."""
        return self.ratio * self.efficiency


def state(box: Definition, closed: tuple[str, ...], gear: str = "") -> GearState | None:
    """What the box does with some elements closed; None where that gives no ratio."""
    found = combination(box, closed)
    if found.kind != GEAR or found.ratio is None:
        return None
    turning = _speeds(box, found.closed)
    ideal = ideal_balance(box, found.closed)
    lossy = lossy_balance(box, found.closed, turning)
    powers = {name: _powers(box, name, ports, turning) for name, ports in ideal.sets.items()}
    open_ = [element for element in box.elements if element.name not in found.closed]
    return GearState(
        gear=gear or found.gear,
        closed=found.closed,
        ratio=float(found.ratio),
        speeds=_floats(turning),
        slips={e.name: float(_of(turning, e.follower) - _of(turning, e.base)) for e in open_},
        torques=_floats(ideal.elements),
        set_torques={name: _floats(ports) for name, ports in ideal.sets.items()},
        set_powers=powers,
        load=_float(ideal.load),
        housing=1.0 + _float(ideal.load),
        circulating=max(0.0, max((abs(p) for of in powers.values() for p in of.values()), default=0.0) - 1.0),
        efficiency=_efficiency(lossy, turning, box.output),
        lossy_torques=_floats(lossy.elements) if lossy else dict.fromkeys(found.closed, float("nan")),
    )


def _speeds(box: Definition, closed: tuple[str, ...]) -> dict[str, Fraction]:
    """Speed of each member at speed 1 of the input; what turns freely beside stands."""
    rows = speeds(box, closed)
    column, scale = next(iter(rows[box.input].items()))
    return {member: row.get(column, Fraction(0)) / scale for member, row in rows.items()}


def _powers(box: Definition, name: str, ports: Mapping[str, Fraction | None], turning: dict[str, Fraction]) -> Floats:
    members = next(one for one in box.sets if one.name == name).members
    return {port: _float(t if t is None else t * _of(turning, members[port])) for port, t in ports.items()}


def _of(turning: Mapping[str, Fraction], member: str) -> Fraction:
    return Fraction(0) if member == HOUSING else turning[member]


def _efficiency(lossy: Balance | None, turning: dict[str, Fraction], output: str) -> float:
    """Zero where the losses take all, so that nothing is driven."""
    if lossy is None or lossy.load is None:
        return float("nan") if lossy is not None else 0.0
    return max(0.0, float(-lossy.load * turning[output]))


def _float(value: Fraction | None) -> float:
    return float("nan") if value is None else float(value)


def _floats(values: Mapping[str, Fraction | None]) -> dict[str, float]:
    return {name: _float(value) for name, value in values.items()}
