"""What a diagram shows of a gearbox at work: a gear per speed 1 and torque 1 at the input, or an operating point."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from clutchwork.base import dataclass
from clutchwork.gearbox.operating import OperatingPoint

if TYPE_CHECKING:
    from clutchwork.gearbox.state import GearState

    Drawable = GearState | OperatingPoint | None

Floats = Mapping[str, float]
MINUS = "\N{MINUS SIGN}"


@dataclass(frozen=True)
class BoxAtWork:
    """Speeds, torques and powers to one scale.

    Parameters: name, of the row; caption, above the picture; closed, elements that carry, machines among them;
    speeds_of, what speeds are over; given and taken, powers at input and output, both positive as a gear drives.
    """

    name: str
    caption: str
    closed: tuple[str, ...]
    speeds: Floats
    torques: Floats
    set_powers: Mapping[str, Floats]
    given: float
    taken: float
    speeds_of: str = "that of the input"


def shown(now: Drawable) -> BoxAtWork | None:
    """A gear or an operating point to one scale; None where neither is shown."""
    if now is None:
        return None
    return _of_point(now) if isinstance(now, OperatingPoint) else of_gear(now)


def gear_text(now: GearState) -> str:
    """A gear in words."""
    name = f"gear {now.gear}" if now.gear else "closed: " + ", ".join(now.closed)
    return f"{name}, ratio {now.ratio:.3f}".replace("-", MINUS)


def of_gear(now: GearState) -> BoxAtWork:
    """A gear, per speed 1 and torque 1 at the input."""
    text = gear_text(now)
    caption = f"{text}: {', '.join(now.closed)} closed" if now.gear else text
    powers = (next(iter(now.speeds.values())), -now.load * list(now.speeds.values())[1])
    return BoxAtWork(now.gear, caption, now.closed, now.speeds, now.torques, now.set_powers, *powers)


def _of_point(now: OperatingPoint) -> BoxAtWork:
    """Over the power of the engine, or of the output where that drives alone."""
    ends = list(now.speeds.values())[:2]
    speed = ends[0] or ends[1] or 1.0
    power = max(abs(now.input_power), abs(now.output_power)) or 1.0
    torque = power / abs(speed)
    torques = {**now.torques, **now.machine_torques}
    # a machine that is given no torque turns idle
    closed = (*now.closed, *(name for name, value in now.machine_torques.items() if value))
    return BoxAtWork(
        now.mode,
        _words(now),
        closed,
        {name: value / abs(speed) for name, value in now.speeds.items()},
        {name: value / torque for name, value in torques.items()},
        {name: {port: value / power for port, value in ports.items()} for name, ports in now.set_powers.items()},
        now.input_power / power,
        now.output_power / power,
        "that of the input" if ends[0] else "that of the output",
    )


def _words(now: OperatingPoint) -> str:
    """Engine, output and electric way."""
    name = f"mode {now.mode}" if now.mode else "closed: " + ", ".join(now.closed)
    ratio = f", ratio {now.ratio:.3f}" if abs(now.ratio) < 1e6 else ""
    power = f"{now.input_power / 1e3:.1f} kW in, {now.output_power / 1e3:.1f} kW out"
    electric = f"{now.electric_power / 1e3:.1f} kW electrically, {now.battery_power / 1e3:.1f} kW from the battery"
    return f"{name}{ratio}: {power}, {electric}".replace("-", MINUS)
