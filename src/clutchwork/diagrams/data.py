"""What follows for a gearbox as plain data, for other programs."""

from __future__ import annotations

from dataclasses import fields
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from clutchwork.gearbox.gearbox import Gearbox
    from clutchwork.gearbox.state import GearState


def everything(box: Gearbox) -> dict[str, Any]:
    """Definition, gears, capacities, shifts and all combinations."""
    return {
        "gearbox": box.to_dict(),
        "ratios": box.ratios,
        "gears": {gear: of_gear(state) for gear, state in box.states().items()},
        "capacities": {name: _plain(one) for name, one in box.capacities().items()},
        "shifts": [{**_plain(swap), "kind": swap.kind} for swap in box.swaps()],
        "combinations": [
            {**_plain(one), "ratio": None if one.ratio is None else float(one.ratio)} for one in box.combinations()
        ],
    }


def of_gear(state: GearState) -> dict[str, Any]:
    """One gear."""
    return _plain(state)


def _plain(thing: Any) -> dict[str, Any]:
    return {field.name: getattr(thing, field.name) for field in fields(thing)}
