"""Tables of a gearbox in plain characters: gears with ratios, speeds, torques, shifts, combinations."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from math import isfinite, isnan
from typing import TYPE_CHECKING

from clutchwork.base import columns
from clutchwork.gearbox.analysis import capacities, states, swaps
from clutchwork.gearbox.motion import SPLIT, all_combinations, combination
from clutchwork.gearbox.operating import mechanical_points

if TYPE_CHECKING:
    from clutchwork.gearbox.definition import Definition
    from clutchwork.gearbox.state import GearState


def summary(box: Definition) -> str:
    """All tables that follow from the teeth and the shift table, as one string."""
    parts = [
        ("", f"{box.name}: {box.title or 'gearbox'}\n{sets(box)}"),
        ("gears: x closed; ratio input over output; step to the next gear; efficiency with mesh losses", gears(box)),
        ("splits: two speeds are free; ratios at which one machine stands still: all power is mechanical", splits(box)),
        ("speed of members and slip of open elements at speed 1 of the input", speeds(box)),
        ("torque on closed elements at torque 1 of the input, and on the housing", torques(box)),
        ("what elements must hold, at torque 1 of the input", needed(box)),
        ("shifts: elements that open > elements that close", shifts(box)),
        ("all combinations of closed elements", combinations(box)),
    ]
    return "\n\n".join(f"{head}\n{text}" if head else text for head, text in parts if text)


def sets(box: Definition) -> str:
    """Gear sets with their members and teeth."""
    lines = []
    for one in box.sets:
        sizes = one.teeth or one.ratios
        members = ", ".join(f"{port} {member}" for port, member in one.members.items())
        lines.append([one.name, one.kind, members, ", ".join(f"{name} {size:g}" for name, size in sizes.items())])
    return columns([["set", "kind", "members", "teeth"], *lines])


def gears(box: Definition) -> str:
    """The shift table with ratios, steps, efficiency and circulating power."""
    found = states(box)
    order = list(found)
    lines = [["gear", *(e.name for e in box.elements), "ratio", "published", "step", "efficiency", "circulating"]]
    for number, (gear, one) in enumerate(found.items()):
        after = order[number + 1] if number + 1 < len(order) else ""
        same = after and (found[after].ratio > 0) == (one.ratio > 0)
        step = f"{one.ratio / found[after].ratio:.3f}" if same else ""
        marks = ["x" if e.name in one.closed else "." for e in box.elements]
        value = 1.0 / one.ratio if box.ratio_form == "out/in" else one.ratio
        said = f"{box.published[gear]:.3f}" if gear in box.published else ""
        tail = [said, step, f"{one.efficiency:.4f}", f"{one.circulating:.3f}"]
        lines.append([gear, *marks, f"{value:.4f}", *tail])
    return columns(lines, right=range(1 + len(box.elements), len(lines[0])))


def splits(box: Definition) -> str:
    """Rows in which two speeds are free, with their mechanical points."""
    lines = []
    for row in box.gears:
        closed = box.closed_in(row)
        if combination(box, closed).kind == SPLIT:
            points = mechanical_points(box, closed)
            told = [f"{one.machine} at {one.ratio:.4f}" for one in points if isfinite(one.ratio)]
            lines.append([row, " ".join(closed) or "nothing", ", ".join(told)])
    return columns([["mode", "closed", "stands"], *lines]) if lines else ""


def speeds(box: Definition) -> str:
    """Speed of each member and slip of each open element, a column for each gear."""
    found = states(box)
    rows = [[member, *(f"{one.speeds[member]:.3f}" for one in found.values())] for member in box.members]
    for element in box.elements:
        slips = [one.slips.get(element.name) for one in found.values()]
        rows.append([f"slip {element.name}", *("" if slip is None else f"{slip:.3f}" for slip in slips)])
    return columns([["", *found], *rows], right=range(1, len(found) + 1))


def torques(box: Definition) -> str:
    """Torque on the follower of each closed element, on the housing and at the output, a column for each gear."""
    found = states(box)
    rows = [[e.name, *(_cell(one.torques.get(e.name)) for one in found.values())] for e in box.elements]
    rows.append(["housing", *(_cell(one.housing) for one in found.values())])
    rows.append(["output", *(_cell(-one.load) for one in found.values())])
    return columns([["", *found], *rows], right=range(1, len(found) + 1))


def _cell(value: float | None) -> str:
    return "" if value is None else "shared" if isnan(value) else f"{value:.3f}"


def needed(box: Definition) -> str:
    """Required capacity of each element and its fastest slip while it is open."""
    lines = [["element", "kind", "joins", "torque", "in gear", "slip", "in gear", "closed in"]]
    found = capacities(box)
    for element in box.elements:
        one = found[element.name]
        ends = f"{element.first}, {element.second}"
        values = [f"{one.torque:.3f}", one.gear, f"{one.slip:.3f}", one.slip_gear]
        lines.append([element.name, element.kind, ends, *values, " ".join(one.gears)])
    return columns(lines, right=(3, 5))


def shifts(box: Definition) -> str:
    """What each shift takes, a row for each gear before it, a column for each gear after it."""
    order = list(states(box))
    found = {(one.before, one.after): f"{_joined(one.opens)}>{_joined(one.closes)}" for one in swaps(box)}
    rows = [[before, *(found.get((before, after), "") for after in order)] for before in order]
    return columns([["", *order], *rows])


def _joined(names: Iterable[str]) -> str:
    return "+".join(names) or "-"


def combinations(box: Definition) -> str:
    """How many combinations of closed elements make what, and the gears that the shift table does not use."""
    found = list(all_combinations(box))
    kinds = Counter((len(one.closed), "gear, idle members" if one.idle else one.kind) for one in found)
    names = sorted({kind for _, kind in kinds})
    sizes = sorted({size for size, _ in kinds})
    rows = [[f"{size} closed", *(str(kinds.get((size, kind), "") or "") for kind in names)] for size in sizes]
    text = columns([["", *names], *rows], right=range(1, len(names) + 1))
    spare = [one for one in found if one.ratio is not None and not one.gear and not one.idle and not one.redundant]
    if spare:
        lines = [f"  {' '.join(one.closed)}: {float(one.ratio or 0):.4f}" for one in spare]
        text += "\ngears that the shift table does not use:\n" + "\n".join(lines)
    return text


def of_gear(one: GearState) -> str:
    """One gear: torques and powers at every port of every set."""
    head = (
        f"gear {one.gear or '-'}: {' '.join(one.closed)} closed, ratio {one.ratio:.4f}, efficiency {one.efficiency:.4f}"
    )
    rows = [
        [name, port, f"{torque:.4f}", f"{one.set_powers[name][port]:.4f}"]
        for name, ports in one.set_torques.items()
        for port, torque in ports.items()
    ]
    lines = [head, columns([["set", "port", "torque", "power"], *rows], right=(2, 3))]
    lines.append(columns([["member", "speed"], *([name, f"{v:.4f}"] for name, v in one.speeds.items())], right=(1,)))
    pairs = [[name, f"{value:.4f}", f"{one.lossy_torques[name]:.4f}"] for name, value in one.torques.items()]
    lines.append(columns([["element", "torque", "with losses"], *pairs], right=(1, 2)))
    lines.append(
        columns([["open", "slip"], *([name, f"{value:.4f}"] for name, value in one.slips.items())], right=(1,))
    )
    return "\n\n".join(lines)
