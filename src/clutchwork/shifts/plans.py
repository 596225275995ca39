"""What a shift takes: all elements at once, or one exchange after the other. docs/theory/shifts.md (4), (15)."""

from __future__ import annotations

from typing import TYPE_CHECKING

from clutchwork.shifts.exchange import Exchange, exchange, exchanges, ratio_of
from clutchwork.shifts.handover import Handover, handover, is_straight

if TYPE_CHECKING:
    from collections.abc import Mapping

    from clutchwork.gearbox.gearbox import Gearbox
    from clutchwork.shifts.preselect import Halves

Plan = tuple[Exchange | Handover, ...]


def plan(
    box: Gearbox, before: tuple[str, ...], after: tuple[str, ...], inertias: Mapping[str, float], torque: float
) -> Plan:
    """The handovers and exchanges of a shift, one after the other.

    Elements that open and close do so together where they can carry the torque on the way; otherwise the way goes
    through gears. Exchanges are left for dog clutches, freewheels, neutral and what shares torques in more ways.

    Parameters: before and after, closed elements; inertias, of members [kg m2]; torque, at the input [N m].
    """
    off = tuple(name for name in before if name not in after)
    on = tuple(name for name in after if name not in before)
    if off and on and ratio_of(box, before) * ratio_of(box, after) > 0.0:
        together = handover(box, off, on, tuple(name for name in after if name in before), inertias)
        if together is not None and is_straight(box, together, torque):
            return (together,)
    way = exchanges(box, before, after, inertias)
    singles = [_alone(box, one, inertias) for one in way]
    known = tuple(one for one in singles if one is not None)
    return known if len(known) == len(way) else way


def _alone(box: Gearbox, one: Exchange, inertias: Mapping[str, float]) -> Handover | None:
    """An exchange of two elements that slip, as the handover that it is."""
    return handover(box, (one.off,), (one.on,), one.kept, inertias) if one.off and one.on else None


def between_halves(box: Gearbox, halves: Halves, before: str, after: str, inertias: Mapping[str, float]) -> Plan:
    """The exchanges of clutches from gear to gear of a dual-clutch gearbox, the gears of both shafts engaged."""
    made, gear = list[Exchange](), before
    for target in halves.route(before, after):
        sleeves = (halves.sleeve[gear], halves.sleeve[target])
        off, on = halves.clutch[gear], halves.clutch[target]
        made.append(exchange(box, off, on, (off, *sleeves), (on, *sleeves), inertias))
        gear = target
    return tuple(made)
