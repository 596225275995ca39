"""The page of a gearbox: its reader chooses a gear and sees power flow, levers, speeds and torques."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from clutchwork.base.errors import ClutchworkError
from clutchwork.base.paths import fitting
from clutchwork.base.writing import put
from clutchwork.diagrams.draw import diagram
from clutchwork.gearbox.gearbox import Gearbox
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
        "gears": [_gear(box, box.state(gear)) for gear in box.gears],
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
        "pictures": {kind: picture for kind in PICTURES if (picture := _picture(box, kind, now.gear))},
    }


def _picture(box: Gearbox, kind: str, gear: str) -> str:
    try:
        return diagram(box, kind, gear=gear).svg
    except ClutchworkError:
        # a box whose sets are locked in themselves has no lever
        return ""
