"""Tables and pictures of shifts."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from math import isnan
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from clutchwork.base import UseError, columns
from clutchwork.base.extras import need
from clutchwork.base.paths import fitting
from clutchwork.base.writing import replaced
from clutchwork.shifts.given import prefix_of

if TYPE_CHECKING:
    from clutchwork.gearbox.gearbox import Gearbox
    from clutchwork.run.trajectory import Trajectory
    from clutchwork.shifts.metrics import ShiftQuality

# columns up to those in units of the measures, and behind them
BEFORE = ("shift", "opens", "closes", "begin s", "torque phase s", "inertia phase s")
BEHIND = ("flare rad/s", "sag rad/s", "tie-up N m", "slip energy kJ", "hottest K")


def table(found: Sequence[ShiftQuality], *, names: Sequence[str] = ()) -> str:
    """All shifts, a line for each. Parameters: names, of the shifts in the first column, by default "1-2"."""
    lines = map(_line, found, names or map(_name, found))
    heads = [*BEFORE, *_measured(found), *BEHIND]
    return columns([heads, *lines], right=range(3, len(heads)))


def _measured(found: Sequence[ShiftQuality]) -> list[str]:
    """Heads of columns whose units follow from the signals that were given."""
    jerk = _unit((one.jerk_unit for one in found), "m/s3")
    dose = _unit((one.dose_unit for one in found), "m/s1.75")
    torque = _unit((one.torque_unit for one in found), "N m")
    return [f"peak jerk {jerk}", f"rms jerk {jerk}", f"dose {dose}", f"torque hole {torque}"]


def _unit(units: Iterable[str], usual: str) -> str:
    """A unit, or all that there are, in the order of the lines."""
    return " or ".join(dict.fromkeys(units)) or usual


def _name(one: ShiftQuality) -> str:
    return f"{one.shift.before}-{one.shift.after}"


def _line(one: ShiftQuality, name: str) -> list[str]:
    shift = one.shift
    energy = ", ".join(f"{name} {heat / 1e3:.2f}" for name, heat in one.slip_energy.items() if heat > 1.0)
    hottest = max(one.temperature.values(), default=float("nan"))
    values = [(shift.begin, 2), (shift.torque_time, 3), (shift.inertia_time, 3), (one.peak_jerk, 1), (one.rms_jerk, 2)]
    values += [(one.vibration_dose, 3), (one.torque_hole, 0), (one.flare, 1), (one.sag, 1), (one.tie_up, 0)]
    numbers = ["-" if isnan(value) else f"{value:.{digits}f}" for value, digits in values]
    return [
        name,
        "+".join(shift.opens),
        "+".join(shift.closes),
        *numbers,
        energy or "-",
        "-" if isnan(hottest) else f"{hottest:.0f}",
    ]


def picture(
    run: Trajectory,
    box: Gearbox,
    one: ShiftQuality,
    path: str | Path,
    prefix: str = "",
    *,
    more: Sequence[str | Sequence[str]] = (),
) -> Any:
    """One shift: speeds of input and output, slips, torques and pressures of the elements, and what else is named.

    Parameters: path, png, svg or pdf; prefix, name of the Transmission, which may be left out where it is the only one;
    more, further panels as of `run.plot`, such as the torque of a drive shaft.
    """
    prefix, shift = prefix_of(run, box, prefix), one.shift
    names = [*shift.opens, *shift.closes]
    panels: list[Any] = [[f"{prefix}.{box.input}.speed", f"{prefix}.{box.output}.speed"]]
    for last in ("slip", "torque", "pressure"):
        signals = [f"{prefix}.{name}.{last}" for name in names if f"{prefix}.{name}.{last}" in run]
        panels += [signals] if signals else []
    zoom = (max(float(run.time[0]), shift.begin - 0.2), min(float(run.time[-1]), shift.end + 0.4))
    return run.plot(*panels, *more, zoom=zoom, path=path)


def overview(found: Sequence[ShiftQuality], path: str | Path, *, names: Sequence[str] = ()) -> None:
    """All shifts of a box beside each other: phases, jerk, slip energy. Needs matplotlib.

    Parameters: path, png, svg or pdf; names, of the shifts, by default "1-2".
    """
    if not found:
        raise UseError("cw.shifts.overview", ["there is no shift to draw; give what cw.shifts.qualities returned"])
    where = fitting("cw.shifts.overview", path, "shifts.png", (".png", ".svg", ".pdf"))
    figures = need("matplotlib.figure", "draw", "cw.shifts.overview")
    figure = figures.Figure(figsize=(max(5.0, 0.55 * len(found) + 2.0), 7.0), layout="constrained")
    axes = figure.subplots(3, 1, sharex=True)
    places = np.arange(len(found))
    labels = list(names) or [_name(one) for one in found]
    torque = np.array([one.shift.torque_time for one in found])
    axes[0].bar(places, torque, label="torque phase", color="#8AA4C8")
    axes[0].bar(
        places, [one.shift.inertia_time for one in found], bottom=torque, label="inertia phase", color="#35557F"
    )
    axes[0].set_ylabel("time [s]")
    axes[0].legend(frameon=False, ncols=2, loc="lower right", bbox_to_anchor=(1.0, 1.0))
    axes[1].bar(places, [one.peak_jerk for one in found], color="#B5651D")
    axes[1].set_ylabel(f"peak jerk [{_unit((one.jerk_unit for one in found), 'm/s3')}]")
    bottom = np.zeros(len(found))
    for name in found[0].slip_energy:
        heat = np.array([one.slip_energy[name] / 1e3 for one in found])
        if np.max(heat) > 1e-3:
            axes[2].bar(places, heat, bottom=bottom, label=name)
            bottom += heat
    axes[2].set_ylabel("slip energy [kJ]")
    axes[2].set_ylim(0.0, 1.05 * float(np.max(bottom)) or 1.0)
    axes[2].legend(frameon=False, ncols=9, loc="lower right", bbox_to_anchor=(1.0, 1.0))
    for one in axes:
        one.margins(y=0.05)
    axes[2].set_xticks(places, labels, rotation=90 if len(found) > 12 else 0)
    with replaced(where.with_suffix(where.suffix or ".png")) as new:
        figure.savefig(new, dpi=120)
