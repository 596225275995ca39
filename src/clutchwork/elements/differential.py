"""Differential: open, with limited slip, or torque-sensing."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from clutchwork.declare import Component, Found, Node, Role, component, option, param, port
from clutchwork.elements.bases.contacts import Sticking
from clutchwork.elements.limited_slip import LimitedSlip
from clutchwork.elements.open_differential import OpenDifferential


@component(Role.COMPOSITE)
class Differential(Sticking):
    """Differential of an axle or between axles: 2 carrier = left + right.

    Without friction both sides have half of the torque. With a `preload`, a share of the torque or a `bias` it limits
    the slip: the torque of the faster side is smaller, of the slower side larger by up to
    `preload + share |torque of the carrier|`, exactly at rest too. A bias is the largest ratio of both torques, as of
    torque-sensing differentials: share = (bias - 1)/(2 (bias + 1)). The final drive is a `Gear`; to lock it, put a
    `DogClutch` or a `Clutch` between left and right.
    """

    carrier: Node = port("carrier of the pinions, the driven side")
    left: Node = port("one side")
    right: Node = port("other side")
    preload: float = param("N m", "capacity without torque", default=0.0, at_least=0.0)
    share: float | None = param("1", "capacity per torque of the carrier", default=None, at_least=0.0, below=0.5)
    coast_share: float | None = param(
        "1", "the same for negative torque, `share` by default", default=None, at_least=0.0, below=0.5
    )
    bias: float | None = param("1", "largest ratio of the torques of both sides", default=None, at_least=1.0)
    coast_bias: float | None = param("1", "the same for negative torque, `bias` by default", default=None, at_least=1.0)
    tolerance: float = option("rad/s", "slip below which both sides may lock", default=0.0, at_least=0.0, last=1)
    locked: bool = option("1", "both sides together at the start", default=False, flag=True, last=1)

    def problems(self) -> Found:
        found = []
        for one, other in (("share", "bias"), ("coast_share", "coast_bias")):
            if getattr(self, one) is not None and getattr(self, other) is not None:
                found.append((one, f"is given twice, as a share and as {other}", "give only one of the two"))
        return found

    def shares(self) -> tuple[float, float]:
        """Capacity per torque of the carrier, for positive and for negative torque."""
        drive = _share(self.share, self.bias, 0.0)
        return drive, _share(self.coast_share, self.coast_bias, drive)

    def parts(self) -> Iterable[Component]:
        """The gear alone, or with its friction."""
        ends: dict[str, Any] = {"carrier": self.carrier, "left": self.left, "right": self.right}
        drive, coast = self.shares()
        if self.preload == drive == coast == 0.0:
            return (OpenDifferential(self.name, **ends),)
        return (LimitedSlip(self.name, preload=self.preload, drive=drive, coast=coast, **ends, **self.sticking()),)


def _share(share: float | None, bias: float | None, otherwise: float) -> float:
    if bias is not None:
        return (bias - 1.0) / (2.0 * (bias + 1.0))
    return otherwise if share is None else share
