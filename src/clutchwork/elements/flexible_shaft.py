"""Shaft that twists along its length."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from itertools import pairwise
from math import inf, pi, sin, sqrt
from typing import ClassVar

from clutchwork.declare import Found, Node, Role, StateSum, Way, component, param, port
from clutchwork.declare.node import Domain, Part
from clutchwork.elements.bases.heating import Heating
from clutchwork.elements.bases.modal import Modal, frequencies, twist_of
from clutchwork.elements.gear import Gear
from clutchwork.elements.spring_damper import SpringDamper


class Coordinate(SpringDamper):
    """Spring and damper on the amplitude of a mode, without a reaction on any member."""

    ways: ClassVar[tuple[Way, ...]] = (Way("amplitude", "rate of the amplitude"),)

    def directions(self) -> Mapping[str, Mapping[str, float]]:
        """Its own speed alone."""
        return {"amplitude": {"follower": 1}}


SEGMENTS = 8
GEOMETRY = ("length", "outer_diameter")


@component(Role.COMPOSITE)
class FlexibleShaft(Heating):
    """Shaft with distributed inertia: equal springs in series, with inertias between them and at both ends.

    Use it where torsional waves in a long shaft matter, and for its natural frequencies; a short shaft is a
    `SpringDamper`. Give stiffness and inertia, or the dimensions of a round bar or tube. Of `segments` springs each is
    `segments * stiffness` and has the damper `damping_time * segments * stiffness`; inertias between them are
    inertia/segments and those at the ends half of that, which the shafts at its ends carry too. The lowest frequency is
    low by 10 % with two segments and by 0.6 % with eight; free waves of frequency w are damped with the ratio
    damping_time w/2.

    With `modes` it has the lowest modes of the bar with free ends, whose frequencies are exact, and springs for all
    that is left of its compliance; the shafts at its ends then need inertia of their own.

    Its parts are shafts "node_1" at the base to the last one at the follower, which others may be attached to, and
    "segment_1" and so on.

    Equations: docs/theory/compliance.md. Source: W. Thomson, M. Dahleh, Theory of Vibration with Applications, 5th
    ed., Prentice Hall 1998, chapter 9.
    """

    base: Node = port("one end")
    follower: Node = port("other end, whose motion is positive")
    stiffness: float | None = param(
        "N m/rad", "torsional stiffness from end to end", default=None, above=0.0, units=("N/m",), example=2e4
    )
    inertia: float | None = param(
        "kg m2", "inertia of the whole shaft", default=None, above=0.0, units=("kg",), example=0.05
    )
    length: float | None = param("m", "length, in place of stiffness and inertia", default=None, above=0.0)
    outer_diameter: float | None = param("m", "outer diameter", default=None, above=0.0)
    inner_diameter: float = param("m", "diameter of the bore", default=0.0, at_least=0.0)
    shear_modulus: float = param("Pa", "shear modulus", default=8e10, above=0.0)
    density: float = param("kg/m3", "density", default=7850.0, above=0.0)
    segments: int | None = param(
        "1", "springs in a row, 8 by default", default=None, at_least=1, at_most=200, whole=True
    )
    modes: int | None = param(
        "1", "modes of the bar that it has, in place of segments", default=None, at_least=1, at_most=50, whole=True
    )
    damping_time: float = param("s", "damping over stiffness", default=0.0, at_least=0.0)

    def problems(self) -> Found:
        if self.modes is not None and self.segments is not None:
            return [("segments", f"is {self.segments:g} beside {self.modes:g} modes", "give one of the two")]
        whole, bar = (self.stiffness, self.inertia), (self.length, self.outer_diameter)
        both = "give `stiffness` and `inertia`, or `length` and `outer_diameter`"
        if whole != (None, None) and bar != (None, None):
            name = next(name for name in GEOMETRY if getattr(self, name) is not None)
            return [(name, "is given beside stiffness or inertia", both)]
        for name in ("stiffness", "inertia") if bar == (None, None) else GEOMETRY:
            if getattr(self, name) is None:
                return [(name, "is missing", both)]
        if self.outer_diameter is not None and self.inner_diameter >= self.outer_diameter:
            message = f"is {self.inner_diameter:g} m, not below outer_diameter = {self.outer_diameter:g} m"
            return [("inner_diameter", message, "give the bore of the tube, 0 for a bar")]
        return []

    @property
    def whole_stiffness(self) -> float:
        """Stiffness from end to end [N m/rad]."""
        return self.stiffness or self.shear_modulus * self._polar_moment / (self.length or 1.0)

    @property
    def whole_inertia(self) -> float:
        """Inertia of the whole shaft [kg m2]."""
        return self.inertia or self.density * self._polar_moment * (self.length or 1.0)

    @property
    def _count(self) -> int:
        """Springs in a row."""
        return SEGMENTS if self.segments is None else int(self.segments)

    @property
    def _polar_moment(self) -> float:
        """Polar second moment of the section [m4]."""
        return pi * ((self.outer_diameter or 0.0) ** 4 - self.inner_diameter**4) / 32.0

    def frequencies(self, *, fixed: bool = False) -> tuple[float, ...]:
        """Natural frequencies [rad/s] with free ends, or one `fixed`, lowest first: docs/theory/compliance.md (3)."""
        if self.modes is not None:
            return frequencies(self.whole_stiffness, self.whole_inertia, int(self.modes), fixed=fixed)
        step = 0.5 if fixed else 0.0
        count = self._count
        scale = 2.0 * count * sqrt(self.whole_stiffness / self.whole_inertia)
        return tuple(scale * sin((j - step) * pi / (2.0 * count)) for j in range(1, count + 1))

    def notes(self) -> list[str]:
        """Its lowest natural frequencies."""
        words = [
            f"{', '.join(f'{w / (2.0 * pi):.4g}' for w in self.frequencies(fixed=fixed)[:3])} Hz with {ends}"
            for fixed, ends in ((False, "free ends"), (True, "one end held"))
        ]
        return [f"natural frequencies {' and '.join(words)}"]

    def state_sums(self) -> tuple[StateSum, ...]:
        """The twist from end to end, the sum of those of its springs."""
        unit = "rad" if (self.follower if self.base.fixed else self.base).domain is Domain.ROTATION else "m"
        if self.modes is not None:
            weights = twist_of(self.whole_stiffness, int(self.modes))
        else:
            each = 1.0 / (self._count * self.whole_stiffness)
            weights = {f"segment_{number}.spring_torque": each for number in range(1, self._count + 1)}
        return (StateSum("twist", unit, weights),)

    def parts(self) -> Iterator[Part]:
        """Shafts from end to end, the springs between them, and what ties the ends to theirs; or its modes."""
        if not all(0.0 < value < inf for value in (self.whole_stiffness, self.whole_inertia)):
            raise OverflowError
        if self.modes is not None:
            domain = self.base.domain if self.follower.fixed else self.follower.domain
            made = Modal(self.name, domain, self.whole_stiffness, self.whole_inertia, self.damping_time, Coordinate)
            yield from made.parts((self.base, self.follower), int(self.modes), self.heat, self.heat_share)
            return
        count, nodes = self._count, list[Node]()
        for number in range(count + 1):
            end = {0: self.base, count: self.follower}.get(number)
            # an end that the housing holds needs no shaft
            nodes.append(end if end is not None and end.fixed else self._node(number))
            if nodes[-1] is not end:
                yield nodes[-1]
            if end is not None and nodes[-1] is not end:
                yield Gear(f"{self.name}.end_{number + 1}", input=end, output=nodes[-1], ratio=1.0)
        stiffness = count * self.whole_stiffness
        for number, (before, after) in enumerate(pairwise(nodes), 1):
            yield SpringDamper(
                f"{self.name}.segment_{number}",
                base=before,
                follower=after,
                stiffness=stiffness,
                damping=self.damping_time * stiffness,
                heat=self.heat,
                heat_share=self.heat_share,
            )

    def _node(self, number: int) -> Node:
        share = (0.5 if number in (0, self._count) else 1.0) / self._count
        domain = self.base.domain if self.follower.fixed else self.follower.domain
        return Node(f"{self.name}.node_{number + 1}", domain, share * self.whole_inertia)
