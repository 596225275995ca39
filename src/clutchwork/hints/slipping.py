"""Contacts that slip although they are at their largest load."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from clutchwork.results.channels import SPEED, TORQUE
from clutchwork.results.ratios import ROUND_OFF

if TYPE_CHECKING:
    from clutchwork.assembly.wiring import Branch
    from clutchwork.hints.look import Look, RowSpan

# share of its largest load from which a contact is full: pressures from a lag approach theirs
FULL = 0.98
# share of a run below which a stretch says little
SHORT = 0.02


class FullSlip(NamedTuple):
    """A stretch in which a contact is full and slips in one direction."""

    contact: int
    branch: Branch
    span: RowSpan
    begin: float  # s
    end: float  # s
    load: float  # largest, in the unit of its signal
    before: float  # slip at the begin, absolute
    after: float  # slip at the end, absolute
    needed: float  # N m, mean torque that would keep the slip as it is
    kinetic: float  # N m, mean torque while it slips
    capacity: float  # N m, smallest torque at which it would break away
    heat: float  # J

    @property
    def torque_unit(self) -> str:
        """Unit of its torque."""
        return TORQUE[self.branch.domain]

    @property
    def speed_unit(self) -> str:
        """Unit of its slip."""
        return SPEED[self.branch.domain]


def pressed(look: Look) -> Iterator[tuple[int, Branch]]:
    """Contacts with a law that sticks, which something presses; no freewheels, and none that a controller regulates."""
    for contact, branch in enumerate(look.contacts):
        part = branch.component
        if (
            part.friction.sticks
            and not part.one_way
            and look.load(contact) is not None
            and not look.controlled(contact)
        ):
            yield contact, branch


def full_slips(look: Look, contact: int, branch: Branch) -> Iterator[FullSlip]:
    """Its stretches in order; those that are short beside the run are left out."""
    load = look.load(contact)
    if load is None or np.max(load, initial=0.0) <= 0.0:
        return
    top = float(np.max(load))
    full = (load >= FULL * top) & look.closed[:, contact] & ~look.locked[:, contact]
    slip, torque = look.slip[:, contact], look.part("contact_torque")[:, contact]
    for direction in (-1, 1):
        for span in look.spans(full & (look.mode[:, contact] == direction)):
            begin, end = float(look.time[span.first]), float(look.time[span.last])
            if end - begin < SHORT * look.duration:
                continue
            rows = slice(span.first, span.last + 1)
            yield FullSlip(
                contact,
                branch,
                span,
                begin,
                end,
                top,
                _tidy(slip[span.first], slip),
                _tidy(slip[span.last], slip),
                look.holding(contact, span),
                look.mean(span, np.abs(torque[rows])),
                float(np.min(look.part("contact_capacity")[rows, contact])),
                float(look.heat[span.last, contact] - look.heat[span.first, contact]),
            )


def _tidy(value: float, among: np.ndarray) -> float:
    """A value without sign; what is round-off beside others is zero."""
    return abs(float(value)) if abs(value) > ROUND_OFF * np.max(np.abs(among)) else 0.0
