"""The units that values may have, as rows of a table."""

from __future__ import annotations

from typing import NamedTuple

from clutchwork.declare import units

# quantities by a unit of theirs in SI
QUANTITIES = {
    "1": "number", "kg": "mass", "m": "length", "s": "time", "rad": "angle", "rad/s": "speed of a shaft",
    "1/s": "frequency", "N": "force", "N m": "torque, energy", "W": "power", "Pa": "pressure", "K": "temperature",
}  # fmt: skip


class UnitRow(NamedTuple):
    """A unit, its quantity, and what it is in SI."""

    quantity: str
    unit: str
    meaning: str  # "100000 Pa"


def unit_rows() -> list[UnitRow]:
    """All units, those of a quantity together."""
    by_powers = {units.parse(unit).powers: (name, unit) for unit, name in QUANTITIES.items()}
    rows = []
    for unit in units.known():
        factor, powers = units.parse(unit)
        quantity, base = by_powers.get(powers, ("other", ""))
        rows.append(UnitRow(quantity, unit, f"{factor:.12g} {'' if base == '1' else base}".strip()))
    order = list(dict.fromkeys(row.quantity for row in rows))
    return sorted(rows, key=lambda row: order.index(row.quantity))
