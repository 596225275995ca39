"""Diagrams of a gearbox."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from clutchwork.base import UseError, listed, near, quote
from clutchwork.base.paths import path_fault
from clutchwork.declare.calls import explained
from clutchwork.diagrams.axes import paint as parallel
from clutchwork.diagrams.axes.layout import axes, fits
from clutchwork.diagrams.kinds import KINDS
from clutchwork.diagrams.lever import paint as lever
from clutchwork.diagrams.lever.layout import layout as lever_layout
from clutchwork.diagrams.picture import Diagram
from clutchwork.diagrams.speed import chart, plan
from clutchwork.diagrams.stick import paint as stick
from clutchwork.diagrams.stick.layout import layout as stick_layout
from clutchwork.diagrams.stick.symbols import MACHINE
from clutchwork.gearbox.definition import ShiftElement
from clutchwork.gearbox.gear_set import HOUSING
from clutchwork.gearbox.gearbox import Gearbox
from clutchwork.gearbox.operating import OperatingPoint

# kinds that show each set as a lever
LEVERS = ("lever", "speeds")


if TYPE_CHECKING:
    from clutchwork.diagrams.marks import Mark
    from clutchwork.gearbox.gear_set import GearSet
    from clutchwork.gearbox.state import GearState


@explained("cw.diagram")
def diagram(
    box: Gearbox | str | Path,
    kind: str = "stick",
    *,
    gear: str | Sequence[str] | None = None,
    point: OperatingPoint | None = None,
    path: str | Path | None = None,
    merged: bool = False,
) -> Diagram:
    """A diagram of a gearbox as SVG, with automatic layout; notebooks show it. Needs no further package.

    Use it to see how a gearbox is built and where power goes in a gear.

    Parameters: box, a Gearbox, or what `cw.Gearbox.load` takes; kind, "stick", the half section of papers, "axes",
    shafts beside each other with their wheels, of gear pairs alone, "lever", levers with distances by the teeth,
    "speeds", the speed plan after Kutzbach, or "chart", the speed of every member; gear, its name or the elements that
    are closed: what turns with power, as wide as the power, what is held, what is idle, of the others the speeds;
    point, an operating point of a power split in place of a gear, for stick and lever diagrams; path, an SVG file,
    written when given; merged, whether gear sets that share two members are one lever. UseError for what does not fit.

    Sources: K. Kutzbach, Mehrgliedrige Radgetriebe und ihre Gesetze, Maschinenbau 22 (1927); H. Benford and M. Leising,
    The lever analogy: a new tool in transmission analysis, SAE 810102 (1981), doi:10.4271/810102.
    """
    if isinstance(box, str | Path):
        box = Gearbox.load(box)
    problems = list(_problems(box, kind, path, merged)) + list(_point_problems(kind, gear, point))
    if problems:
        raise UseError("cw.diagram", problems)
    now = None if gear is None else box.state(gear)
    title = f"{box.title or box.name}, {kind}" + (f", gear {now.gear or listed(now.closed)}" if now else "")
    title += f", {point.mode or listed(point.closed)}" if point else ""
    if kind == "axes" and not fits(box):
        raise UseError(
            "cw.diagram", [f"{box.name} has planetary sets, and axes shows gear pairs: choose stick or lever"]
        )
    if kind in LEVERS and not any(map(_has_lever, box.sets)):
        raise UseError(
            "cw.diagram", [f"{box.name} has no lever: its sets are locked in themselves; choose stick or chart"]
        )
    if kind == "chart" and now is None and not box.states():
        remedy = "give closed elements as gear, or choose speeds"
        raise UseError("cw.diagram", [f"{box.name} has no gears to chart; {remedy}"])
    made = Diagram(kind, title, _marks(box, kind, now or point, merged))
    if path is not None:
        made.save(path)
    return made


def _problems(box: Any, kind: Any, path: Any, merged: Any) -> Any:
    if not isinstance(box, Gearbox):
        yield f"{quote(box)} is not a gearbox: give cw.Gearbox.load(...), or a name of the catalogue"
    if kind not in KINDS:
        yield f"kind is {quote(kind)}{near(str(kind), KINDS, f'choose from {listed(KINDS)}')}"
    if path is not None and (fault := path_fault(path, "gearbox.svg")):
        yield fault
    if not isinstance(merged, bool):
        yield f"merged is {quote(merged)}: give True or False"


def _point_problems(kind: Any, gear: Any, point: Any) -> Any:
    if point is None:
        return
    if not isinstance(point, OperatingPoint):
        yield f"point is {quote(point)}: give what box.operating_point(...) returns"
    if gear is not None:
        yield "gear and point are both given: give one of them"
    if kind in ("speeds", "chart"):
        yield f"{kind} shows gears, not operating points: choose stick or lever"


def _has_lever(one: GearSet) -> bool:
    """Whether the ports of a set are different members; a set that is locked in itself has no lever."""
    members = list(one.members.values())
    return len(members) == len(set(members))


def _marks(box: Gearbox, kind: str, now: GearState | OperatingPoint | None, merged: bool) -> list[Mark]:
    drawn = with_machines(box)
    if kind == "axes":
        return parallel.painted(box, axes(box), now)
    if kind == "stick":
        return stick.painted(drawn, stick_layout(drawn), now)
    if kind in LEVERS:
        box, drawn = (replace(one, sets=tuple(filter(_has_lever, one.sets))) for one in (box, drawn))
    if kind == "lever":
        return lever.painted(drawn, lever_layout(drawn, merged=merged), now)
    gear, states = None if isinstance(now, OperatingPoint) else now, list(box.states().values())
    # closed elements that are no row of the table are shown beside its gears
    states += [gear] if gear is not None and all(gear.closed != one.closed for one in states) else []
    return plan.painted(box, states, gear) if kind == "speeds" else chart.painted(box, states, gear)


def with_machines(box: Gearbox) -> Gearbox:
    """A gearbox to draw: a machine stands between the housing, which holds its stator, and its member."""
    machines = (ShiftElement(name, MACHINE, HOUSING, member) for name, member in box.machines.items())
    return replace(box, elements=(*box.elements, *machines), machines={})
