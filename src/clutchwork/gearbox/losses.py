"""Losses of a whole gearbox over speed, torque and temperature. docs/theory/gearboxes.md (14) to (18)."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from math import isfinite, log10, pi
from typing import TYPE_CHECKING, NamedTuple, TypeAlias

from clutchwork.base import UseError, columns, dataclass, near, quote
from clutchwork.declare.calls import explain
from clutchwork.gearbox.balance import lossy_balance
from clutchwork.gearbox.motion import speeds as free_speeds

if TYPE_CHECKING:
    from fractions import Fraction

    from clutchwork.gearbox.definition import Definition
    from clutchwork.gearbox.state import GearState

# by temperature, speed, torque [W]
Table: TypeAlias = "tuple[tuple[tuple[float, ...], ...], ...]"
CALL = "box.loss_map"
# K, mm2/s of Walther's equation; N m/mm of seals, of nitrile and of fluoro rubber
ZERO, WALTHER = 273.15, 0.7
SEALS = {"nitrile": 2.429e-3, "fluoro": 3.737e-3}


@dataclass(frozen=True)
class Oil:
    """Oil whose viscosity follows its temperature, after Walther.

    Parameters: viscosity_40 and viscosity_100, kinematic, at 40 and 100 degC [m2/s]; density [kg/m3].
    """

    viscosity_40: float
    viscosity_100: float
    density: float = 850.0

    def __post_init__(self) -> None:
        """UseError for a viscosity in other units, such as mm2/s."""
        if not 1e-7 < self.viscosity_100 < self.viscosity_40 < 1e-2:
            given = f"viscosities are {self.viscosity_40:g} and {self.viscosity_100:g} m2/s"
            raise UseError(
                "cw.Oil", [f"{given} at 40 and 100 degC: give m2/s, 30 mm2/s is 30e-6, the colder one larger"]
            )

    def viscosity(self, temperature: float) -> float:
        """Kinematic viscosity at a temperature [K], in m2/s: equation (14)."""
        low, high = (_double_log(nu) for nu in (self.viscosity_40, self.viscosity_100))
        first, last = log10(ZERO + 40.0), log10(ZERO + 100.0)
        slope = (high - low) / (last - first)
        return float(1e-6 * (10.0 ** (10.0 ** (low + slope * (log10(temperature) - first))) - WALTHER))


def _double_log(viscosity: float) -> float:
    return log10(log10(1e6 * viscosity + WALTHER))


@dataclass(frozen=True)
class Bearing:
    """Rolling bearings of a member: their torque without load, after Palmgren, and with load.

    Parameters: member; mean_diameter [m]; factor, f0 by kind and lubrication, 2 for a deep groove ball bearing in oil
    mist; count, of such bearings; friction, share of the load torque, `friction force mean_diameter / 2`; force, on
    them for each N m at the input [N/(N m)].
    """

    member: str
    mean_diameter: float
    factor: float = 2.0
    count: int = 1
    friction: float = 0.0
    force: float = 0.0

    def torque(self, speed: float, torque: float, viscosity: float) -> float:
        """Resisting torque [N m] at a speed [rad/s]: equation (15)."""
        rate = 1e6 * viscosity * abs(speed) * 30.0 / pi
        without = self.factor * (1e3 * self.mean_diameter) ** 3 * (rate ** (2 / 3) if rate >= 2000.0 else 160.0)
        return self.count * (1e-10 * without + 0.5 * self.friction * self.force * abs(torque) * self.mean_diameter)


@dataclass(frozen=True)
class Seal:
    """A radial shaft seal of a member, after ISO/TR 14179-1.

    Parameters: member; diameter of the shaft [m]; rubber, "nitrile" or "fluoro".
    """

    member: str
    diameter: float
    rubber: str = "nitrile"

    def torque(self, speed: float, torque: float, viscosity: float) -> float:  # noqa: ARG002, as its fellows
        """Resisting torque [N m]."""
        return SEALS[self.rubber] * 1e3 * self.diameter


@dataclass(frozen=True)
class OpenPlates:
    """Drag of a wet clutch or brake while it is open: oil that is sheared in its gaps.

    Parameters: element; surfaces; inner and outer radius [m]; gap between two plates [m].
    """

    element: str
    surfaces: int
    inner: float
    outer: float
    gap: float

    def torque(self, speed: float, viscosity: float) -> float:
        """Drag torque [N m] at a slip [rad/s] and a dynamic viscosity [Pa s]: equation (16)."""
        return self.surfaces * viscosity * abs(speed) * 0.5 * pi * (self.outer**4 - self.inner**4) / self.gap


@dataclass(frozen=True)
class Churning:
    """Churning of oil by a wheel of a member: a torque that is known at one speed and grows with its square.

    Parameters: member; torque [N m] at speed [rad/s] and 40 degC; exponent of the viscosity over that at 40 degC.
    """

    member: str
    torque_at: float
    speed: float
    exponent: float = 0.2

    def torque(self, speed: float, ratio: float) -> float:
        """Resisting torque [N m]; ratio, of the viscosity to that at 40 degC."""
        return float(self.torque_at * (speed / self.speed) ** 2 * ratio**self.exponent)


@dataclass(frozen=True)
class OilPump:
    """An oil pump that a member drives.

    Parameters: member; displacement [m3/rev]; pressure [Pa]; efficiency.
    """

    member: str
    displacement: float
    pressure: float
    efficiency: float = 0.85

    def torque(self) -> float:
        """Torque that it takes [N m]."""
        return self.displacement * self.pressure / (2.0 * pi * self.efficiency)


LossPart: TypeAlias = "Bearing | Seal | OpenPlates | Churning | OilPump"
KINDS: Mapping[type, str] = {
    Bearing: "bearings", Seal: "seals", OpenPlates: "open elements", Churning: "churning", OilPump: "pump"
}  # fmt: skip


class LossAxis(NamedTuple):
    """What a table is over: the quantity, its unit, and the values of its rows."""

    name: str
    unit: str
    values: tuple[float, ...]


@dataclass(frozen=True, repr=False)
class LossMap:
    """Losses of a gear over temperature, speed and torque of the input.

    Parameters: gear; temperatures [K]; speeds [rad/s]; torques [N m]; shares, losses by cause, "meshes" and what was
    given [W], a table over temperature, speed and torque each.
    """

    gear: str
    temperatures: tuple[float, ...]
    speeds: tuple[float, ...]
    torques: tuple[float, ...]
    shares: Mapping[str, Table]

    @property
    def axes(self) -> tuple[LossAxis, LossAxis, LossAxis]:
        """Of its tables, the outer one first."""
        return (
            LossAxis("temperature", "K", self.temperatures),
            LossAxis("speed", "rad/s", self.speeds),
            LossAxis("torque", "N m", self.torques),
        )

    @property
    def power(self) -> Table:
        """All losses [W]."""
        return tuple(
            tuple(tuple(map(sum, zip(*rows, strict=True))) for rows in zip(*layers, strict=True))
            for layers in zip(*self.shares.values(), strict=True)
        )

    @property
    def efficiency(self) -> Table:
        """What leaves over what comes in; 0 where nothing leaves, also with the input at rest."""
        return tuple(
            tuple(
                tuple(_efficiency(speed * torque, lost) for torque, lost in zip(self.torques, row, strict=True))
                for speed, row in zip(self.speeds, layer, strict=True)
            )
            for layer in self.power
        )

    def __str__(self) -> str:
        heads = [f"{axis.name} {axis.unit}" for axis in self.axes]
        lines = [[*heads, *(f"{cause} W" for cause in (*self.shares, "all")), "efficiency"]]
        power, efficiency = self.power, self.efficiency
        for i, temperature in enumerate(self.temperatures):
            for j, speed in enumerate(self.speeds):
                for k, torque in enumerate(self.torques):
                    parts = [f"{table[i][j][k]:.1f}" for table in self.shares.values()]
                    head = [f"{temperature:g}", f"{speed:g}", f"{torque:g}"]
                    lines.append([*head, *parts, f"{power[i][j][k]:.1f}", f"{efficiency[i][j][k]:.4f}"])
        return columns(lines, right=range(len(lines[0])))

    def __repr__(self) -> str:
        sizes = f"{len(self.temperatures)} temperatures, {len(self.speeds)} speeds, {len(self.torques)} torques"
        return f"<LossMap of gear {quote(self.gear)}: {sizes}>"


def _efficiency(power: float, lost: float) -> float:
    """Of power that drives or, negative, is what is left of a load that drives the box backward."""
    if power < 0.0:
        return abs(power) / (abs(power) + lost)
    return max(0.0, 1.0 - lost / power) if power else 0.0


def loss_map(
    box: Definition,
    now: GearState,
    axes: tuple[Sequence[float], Sequence[float], Sequence[float]],
    oil: Oil,
    parts: Sequence[LossPart],
) -> LossMap:
    """Losses of a gear over temperatures, speeds and torques; UseError for parts that stand nowhere."""
    problems = list(_problems(box, parts))
    if problems:
        raise UseError(CALL, problems)
    temperatures, speeds, torques = (tuple(map(float, axis)) for axis in axes)
    if not all(map(isfinite, (*temperatures, *speeds, *torques))) or min(temperatures, default=ZERO) < 200.0:
        raise UseError(
            CALL, ["temperatures, speeds and torques must be finite, and temperatures in K, 80 degC is 353.15"]
        )
    share = _mesh_share(box, now)
    layer = tuple(tuple(share[speed * torque > 0] * abs(speed * torque) for torque in torques) for speed in speeds)
    meshes = (layer,) * len(temperatures)
    found: dict[str, Table] = {"meshes": meshes}
    for kind, name in KINDS.items():
        some = [part for part in parts if isinstance(part, kind)]
        if some:
            found[name] = tuple(
                tuple(tuple(_lost(now, oil, some, (t, speed, torque)) for torque in torques) for speed in speeds)
                for t in temperatures
            )
    return LossMap(now.gear, temperatures, speeds, torques, found)


def _problems(box: Definition, parts: Sequence[LossPart]) -> Iterator[str]:
    elements = [element.name for element in box.elements]
    for part in parts:
        if not isinstance(part, tuple(KINDS)):
            yield f"{quote(part)} is not a part with losses: give {', '.join(kind.__name__ for kind in KINDS)}"
        elif isinstance(part, OpenPlates):
            if part.element not in elements:
                yield f"{quote(part.element)} is not an element of {box.name}{near(part.element, elements)}"
        elif part.member not in box.members:
            yield f"{quote(part.member)} is not a member of {box.name}{near(part.member, box.members)}"


def _mesh_share(box: Definition, now: GearState) -> tuple[float, float]:
    """Share of the power at the input that meshes lose, where it comes back and where it drives: equation (17)."""
    rows = free_speeds(box, now.closed)
    column, scale = next(iter(rows[box.input].items()))
    turning = {member: row.get(column, scale * 0) / scale for member, row in rows.items()}
    back = {member: -speed for member, speed in turning.items()}
    return _lost_share(box, now, back), _lost_share(box, now, turning)


def _lost_share(box: Definition, now: GearState, turning: Mapping[str, Fraction]) -> float:
    """All of it where the box locks itself in that direction; more than that may be lost of what comes back."""
    found = lossy_balance(box, now.closed, turning)
    if found is None or found.load is None:
        return 1.0
    return max(0.0, float(turning[box.input] + found.load * turning[box.output]))


def _lost(now: GearState, oil: Oil, parts: Sequence[LossPart], at: tuple[float, float, float]) -> float:
    """Power of parts of one kind at a temperature, a speed and a torque of the input."""
    temperature, speed, torque = at
    viscosity = oil.viscosity(temperature)
    total = 0.0
    for part in parts:
        if isinstance(part, OpenPlates):
            slip = now.slips.get(part.element, 0.0) * speed
            total += abs(slip) * part.torque(slip, viscosity * oil.density)
            continue
        turning = now.speeds[part.member] * speed
        if isinstance(part, OilPump):
            total += abs(turning) * part.torque()
        elif isinstance(part, Churning):
            total += abs(turning) * part.torque(turning, viscosity / oil.viscosity_40)
        else:
            total += abs(turning) * part.torque(turning, torque, viscosity)
    return total


for _part in (Oil, *KINDS):
    explain(_part)
