"""A calibration in words: what was found, what each limit costs, what stands in the way."""

from __future__ import annotations

from collections.abc import Iterator
from math import floor, isfinite, log10
from typing import TYPE_CHECKING

from clutchwork.base import columns, counted

if TYPE_CHECKING:
    from clutchwork.calibration.held import Held
    from clutchwork.calibration.record import CalibrationRecord

# values of a table with more lines are shown without the middle
MOST_VALUES = 24
# of a limit, in shares of itself
ROUND_OFF = 1e-9


def text(found: CalibrationRecord) -> str:
    """All of it for the terminal."""
    head = (
        f"{found.problem.goal.name}: {_number(found.goal[0])} -> {_number(found.goal[1])} {found.problem.unit}".rstrip()
    )
    parts = [head, _values(found), _limits(found), "\n".join(costs(found)), _effort(found), "\n".join(faults(found))]
    return "\n\n".join(part for part in parts if part)


def _values(found: CalibrationRecord) -> str:
    lines = [["number", "before", "after", "unit", ""]]
    walls = {number: side for number, side, _ in found.certificate.at_bounds}
    for number, one in enumerate(found.problem.unknowns):
        at = {-1.0: "at its lower bound", 1.0: "at its upper bound"}.get(walls.get(number, 0.0), "")
        lines.append([one.name, _number(found.start[one.name]), _number(found.values[one.name]), one.unit, at])
    if len(lines) > MOST_VALUES:
        half = MOST_VALUES // 2
        lines = [*lines[:half], ["...", "", "", "", ""], *lines[-half:]]
    return columns(lines, right=(1, 2))


def _limits(found: CalibrationRecord) -> str:
    if not found.limits:
        return ""
    lines = [["limit", "from", "to", "before", "after", "unit", ""]]
    for one in found.limits:
        sides = [_number(side) if isfinite(side) else "" for side in (one.lower, one.upper)]
        lines.append([one.name, *sides, _range(one.before), _range(one.after), one.unit, _state(one)])
    return columns(lines, right=(1, 2, 3, 4))


def _state(one: Held) -> str:
    return "broken" if one.broken else "active" if one.active else ""


def _range(ends: tuple[float, float]) -> str:
    low, high = map(_number, ends)
    return low if low == high else f"{low} ... {high}"


def _number(value: float) -> str:
    return f"{value:.6g}"


def costs(found: CalibrationRecord) -> Iterator[str]:
    """What each active limit costs: "1000 J more of c1.heat allowed saves 0.3 m/s3 of rms_jerk(car)"."""
    # where no values hold all limits there is nothing to be saved
    for one in found.limits if not any(each.broken for each in found.limits) else ():
        if one.is_equal:
            yield from _cost(one, found, "more asked", one.upper, -one.by_upper)
            continue
        yield from _cost(one, found, "more allowed", one.upper, -one.by_upper)
        yield from _cost(one, found, "less asked", one.lower, one.by_lower)


def _cost(one: Held, found: CalibrationRecord, moved: str, bound: float, saved: float) -> Iterator[str]:
    if not one.active or saved == 0.0:
        return
    amount = _round(abs(bound) or max(map(abs, one.before)) or 1.0)
    verb, much = "saves" if saved > 0.0 else "costs", f"{abs(amount * saved):.3g} {found.problem.unit}".rstrip()
    yield f"{f'{amount:g} {one.unit}'.rstrip()} {moved} of {one.name} {verb} {much} of {found.problem.goal.name}"


def _round(size: float) -> float:
    """About a hundredth of it, one digit."""
    return float(10.0 ** floor(log10(size / 10.0)))


def _effort(found: CalibrationRecord) -> str:
    runs = sum(one.runs for one in found.outcomes)
    said = [f"{counted(len(found.outcomes), 'starts')}, {counted(runs, 'runs with gradient')}"]
    said.append(f"largest violation {max(found.certificate.violation, 0.0):.1g} of its scale")
    if len(found.spread) > 1:
        said.append(f"they reached {', '.join(map(_number, found.spread))} {found.problem.unit}".rstrip())
    said.append(f"residual {min(found.certificate.residual, found.around):.1g} of the goal")
    if found.around < found.certificate.residual:
        said[-1] += " in a corner, of its gradients to all sides"
    if found.samples and not found.whole:
        said.append(f"limits were looked at in {len(found.samples)} samples of production only")
    elif found.samples:
        hold = "hold in all samples" if found.feasible else "are broken in samples"
        said.append(f"limits {hold} of production, of which {len(found.samples)} decided")
    return "; ".join(said)


def faults(found: CalibrationRecord) -> Iterator[str]:
    """What stands in the way of using the values."""
    if not found.finished:
        yield "the search was interrupted: these are the best values so far"
    if not found.whole:
        yield "limits may be violated in samples of production that were not run with these values: verify() runs them"
    elif not found.feasible and not any(one.broken for one in found.limits):
        yield "limits have no value in some samples of production, or the model is refused there: narrow the scatter"
    if not found.feasible:
        for one in found.limits:
            low, high = one.after
            out = max(one.lower - low, high - one.upper)
            if out > ROUND_OFF * max(abs(low), abs(high)):
                by = f"{_number(out)} {one.unit}".rstrip()
                yield (
                    f"{one.name} is {_range(one.after)} {one.unit}".rstrip() + f" at best, by {by} outside of its "
                    f"bounds {_bounds(one)}: widen them or those of the free numbers, or give more starts"
                )
    elif found.finished and not found.solved:
        left = f"the remaining gradient is {found.certificate.residual:.2g} of the goal"
        yield (
            f"{left}, and a neighbour may be better: the search stopped before the optimum; give more "
            "iterations or starts, or search again from found.system"
        )
        if found.corner:
            yield f"the objective has a kink there: {found.corner}"
    for start in found.outcomes:
        if start.fault:
            yield f"start {start.number + 1} could not be used: {start.fault}"


def _bounds(one: Held) -> str:
    sides = [f"{side:.6g}" if isfinite(side) else "" for side in (one.lower, one.upper)]
    return " to ".join(side for side in sides if side)
