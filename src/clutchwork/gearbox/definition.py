"""What a gearbox is: gear sets, members that are joined by their names, shift elements and a shift table."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import field
from fractions import Fraction

from clutchwork.base import dataclass
from clutchwork.base.frozen import frozen
from clutchwork.gearbox.gear_set import HOUSING, GearSet

# kind of a shift element -> what it is
ELEMENTS = {
    "clutch": "friction clutch between two members",
    "brake": "friction brake between a member and the housing",
    "freewheel": "lets the second member run ahead of the first one, and holds it otherwise",
    "dog": "teeth that mesh, between two members or a member and the housing",
    "synchroniser": "a cone that brings the second member to the speed of the first one, then teeth that mesh",
}


@dataclass(frozen=True)
class ShiftElement:
    """A clutch, brake, freewheel, dog clutch or synchroniser of a gearbox, between two members or one and the housing.

    The slip of a brake is the speed of its member, that of the others the speed of the second member over the first.
    Of a freewheel the second member may run ahead of the first.
    """

    name: str
    kind: str
    first: str
    second: str

    @property
    def members(self) -> tuple[str, str]:
        """The two that it joins."""
        return self.first, self.second

    @property
    def base(self) -> str:
        """The side that the slip is measured from."""
        return self.second if self.kind == "brake" else self.first

    @property
    def follower(self) -> str:
        """The side whose motion is positive."""
        return self.first if self.kind == "brake" else self.second

    def row(self) -> dict[str, Fraction]:
        """Its slip over the speeds of the members."""
        return {
            member: sign
            for member, sign in ((self.follower, Fraction(1)), (self.base, Fraction(-1)))
            if member != HOUSING
        }


@dataclass(frozen=True)
class Definition:
    """What makes up a gearbox, as its users write it down.

    Parameters: sets, gear sets; shafts, members that may turn freely in a gear, or that one element alone names;
    elements, shift elements; machines, the member that each electric machine turns with; gears, which elements are
    closed in each gear; always_closed, elements that a shift table leaves out; published, ratio by gear as its maker
    says it, of the `ratio_form` "in/out" or "out/in", met within `tolerance`, or within `tolerance_relative` of its
    value where that is more.
    """

    name: str
    sets: tuple[GearSet, ...]
    input: str
    output: str
    elements: tuple[ShiftElement, ...]
    gears: Mapping[str, tuple[str, ...]]
    machines: Mapping[str, str] = field(default_factory=dict)
    title: str = ""
    shafts: tuple[str, ...] = ()
    always_closed: tuple[str, ...] = ()
    published: Mapping[str, float] = field(default_factory=dict)
    ratio_form: str = "in/out"
    tolerance: float = 0.001
    tolerance_relative: float = 0.0
    source: str = ""
    notes: str = ""

    def __post_init__(self) -> None:
        """Tables that never change, so that a gearbox has a hash."""
        tables = ("gears", "published", "machines")
        vars(self).update({name: frozen(getattr(self, name)) for name in tables})

    @property
    def members(self) -> tuple[str, ...]:
        """All that can turn: input, output, then the others in the order in which they are named."""
        named = [self.input, self.output]
        named += [member for one in self.sets for member in one.members.values()]
        named += [member for element in self.elements for member in element.members]
        named += self.machines.values()
        return tuple(member for member in dict.fromkeys([*named, *self.shafts]) if member != HOUSING)

    def element(self, name: str) -> ShiftElement:
        """A shift element by its name."""
        return next(element for element in self.elements if element.name == name)

    def closed_in(self, gear: str) -> tuple[str, ...]:
        """Elements that are closed in a gear, those that always are among them."""
        return tuple(dict.fromkeys([*self.gears[gear], *self.always_closed]))
