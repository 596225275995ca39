"""The page of a gearbox: its reader chooses a gear and sees power flow, levers, speeds and torques."""

from __future__ import annotations

from collections.abc import Iterator
from math import isfinite
from pathlib import Path
from typing import Any

from clutchwork.base import ClutchworkError
from clutchwork.base.paths import fitting
from clutchwork.base.writing import put
from clutchwork.diagrams.draw import diagram
from clutchwork.gearbox.gearbox import Gearbox
from clutchwork.gearbox.motion import SPLIT
from clutchwork.gearbox.operating import MechanicalPoint
from clutchwork.gearbox.state import GearState
from clutchwork.page.html import html
from clutchwork.page.static import GEARBOX

ENDINGS = (".html", ".htm")
# diagrams of a gear, as far as its box has them
PICTURES = ("stick", "lever")


def page_of_gearbox(box: Gearbox, path: Any) -> Path:
    """What `box.page` does: write the page; its path."""
    target = fitting("box.page", path, "gearbox.html", ENDINGS)
    return put(target, gearbox_page(box))


def gearbox_page(box: Gearbox) -> str:
    """The page as HTML."""
    return html(gearbox_data(box), box.title or box.name, script=GEARBOX, core=False)


def gearbox_data(box: Gearbox) -> dict[str, Any]:
    """All that the page shows, per speed 1 and torque 1 at the input."""
    return {
        "name": box.name,
        "title": box.title or box.name,
        "source": box.source,
        "input": box.input,
        "output": box.output,
        "members": list(box.members),
        "elements": [{"name": one.name, "kind": one.kind} for one in box.elements],
        "gears": [entry for row in box.gears for entry in _row(box, row)],
    }


def _row(box: Gearbox, row: str) -> Iterator[dict[str, Any]]:
    """A gear; of a split, each point at which a machine stands while the output turns."""
    if row in box.states():
        yield _gear(box, box.state(row))
    elif box.combination(box.closed_in(row)).kind == SPLIT:
        yield from (_point(box, row, one) for one in box.mechanical_points(row) if isfinite(one.ratio) and one.ratio)


def _point(box: Gearbox, row: str, at: MechanicalPoint) -> dict[str, Any]:
    """A point of a split, as a gear has it."""
    now = box.operating_point(row, torque=1.0, speed=1.0, output_speed=1.0 / at.ratio)
    return {
        "name": f"{row}, {at.machine} at rest",
        "closed": list(now.closed),
        "ratio": at.ratio,
        "published": None,
        "efficiency": 1.0,
        "circulating": now.circulating,
        "housing": 1.0 - now.output_torque + sum(now.machine_torques.values()),
        "speeds": dict(now.speeds),
        "slips": dict(now.slips),
        "torques": {name: torque if torque == torque else None for name, torque in now.torques.items()},
        "pictures": {kind: picture for kind in PICTURES if (picture := _picture(box, kind, point=now))},
    }


def _gear(box: Gearbox, now: GearState) -> dict[str, Any]:
    return {
        "name": now.gear,
        "closed": list(now.closed),
        "ratio": now.ratio,
        "published": box.published.get(now.gear),
        "efficiency": now.efficiency,
        "circulating": now.circulating,
        "housing": now.housing,
        "speeds": dict(now.speeds),
        "slips": dict(now.slips),
        # a torque that several elements share in more than one way has no value
        "torques": {name: torque if torque == torque else None for name, torque in now.torques.items()},
        "pictures": {kind: picture for kind in PICTURES if (picture := _picture(box, kind, gear=now.gear))},
    }


def _picture(box: Gearbox, kind: str, **shown: Any) -> str:
    try:
        return diagram(box, kind, **shown).svg
    except ClutchworkError:
        # a box whose sets are locked in themselves has no lever
        return ""
