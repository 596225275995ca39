"""Gear sets: wheels around a carrier that mesh with its planets, and the rows between their speeds."""

from __future__ import annotations

from collections.abc import Mapping
from fractions import Fraction
from typing import NamedTuple

from clutchwork.base import dataclass
from clutchwork.base.frozen import frozen
from clutchwork.declare.rational import exact

HOUSING = "housing"


class Wheel(NamedTuple):
    """A wheel of a kind of set: its port, the sign with which its planets turn, the planet wheel that it meshes.

    A ring turns the planet that it meshes the same way, a sun the other way; a second planet in between turns the sign.
    """

    port: str
    sign: int
    planet: str = ""


@dataclass(frozen=True)
class Kind:
    """A kind of gear set: its wheels, whether a carrier turns with the planets, what a ratio stands for."""

    wheels: tuple[Wheel, ...]
    doc: str
    ratios: Mapping[str, tuple[str, str]]  # name of a ratio -> ports whose wheels are divided
    extra: tuple[str, ...] = ()  # teeth that may be given and that no ratio depends on

    @property
    def carried(self) -> bool:
        """Whether the planets turn with a carrier; those of a pair of gears stand."""
        return "first" not in {wheel.port for wheel in self.wheels}

    @property
    def ports(self) -> tuple[str, ...]:
        """Its wheels, then its carrier."""
        return (*(wheel.port for wheel in self.wheels), *(["carrier"] if self.carried else []))

    @property
    def teeth(self) -> tuple[str, ...]:
        """Names of its numbers of teeth: of wheels, and of planets where they are stepped."""
        names = dict.fromkeys((wheel.port, wheel.planet)[place] for place in (0, 1) for wheel in self.wheels)
        return tuple(f"teeth_{name}" for name in names if name)


KINDS: dict[str, Kind] = {
    "single": Kind(
        (Wheel("sun", -1), Wheel("ring", 1)),
        "sun and ring mesh the same planets: zs ws + zr wr = (zs + zr) wc",
        {"ratio": ("ring", "sun")},
        ("teeth_planet",),
    ),
    "double": Kind(
        (Wheel("sun", 1), Wheel("ring", 1)),
        "pairs of planets between sun and ring: zr wr - zs ws = (zr - zs) wc",
        {"ratio": ("ring", "sun")},
    ),
    "stepped": Kind(
        (Wheel("sun", -1, "planet_sun"), Wheel("ring", 1, "planet_ring")),
        "planets with two wheels, one at the sun, one at the ring",
        {"ratio": ("ring", "sun")},
    ),
    "two_suns": Kind(
        (Wheel("sun", -1, "planet_sun"), Wheel("second_sun", -1, "planet_second_sun")),
        "planets with two wheels, each at a sun; no ring",
        {"ratio": ("second_sun", "sun")},
    ),
    "two_rings": Kind(
        (Wheel("ring", 1, "planet_ring"), Wheel("second_ring", 1, "planet_second_ring")),
        "planets with two wheels, each at a ring; no sun",
        {"ratio": ("second_ring", "ring")},
    ),
    "ravigneaux": Kind(
        (Wheel("large_sun", -1), Wheel("small_sun", 1), Wheel("ring", 1)),
        "long planets at the large sun and the ring, short ones between them and the small sun",
        {"ratio_large": ("ring", "large_sun"), "ratio_small": ("ring", "small_sun")},
    ),
    "gear": Kind(
        (Wheel("first", 1), Wheel("second", -1)),
        "two wheels on shafts that stand beside each other: z1 w1 + z2 w2 = 0",
        {"ratio": ("second", "first")},
    ),
}


@dataclass(frozen=True)
class GearSet:
    """A gear set of a gearbox: which members its wheels and its carrier are, and its teeth.

    Parameters: members, the member at each port of its kind, `housing` for one that never turns; wheels whose members
    have one name are joined. teeth, numbers of teeth by wheel, `{"sun": 45, "ring": 95}`; ratios in their place where
    they are not known. planets, how many there are, and whether they stand `equally_spaced`: both for the check that
    the set can be built. efficiency, of the way from wheel to wheel with the carrier at rest.
    """

    name: str
    kind: str
    members: Mapping[str, str]
    teeth: Mapping[str, int]
    ratios: Mapping[str, float]
    planets: int | None = None
    equally_spaced: bool = True
    efficiency: float = 1.0

    def __post_init__(self) -> None:
        """Tables that never change, so that a set has a hash."""
        tables = ("members", "teeth", "ratios")
        vars(self).update({name: frozen(getattr(self, name)) for name in tables})

    @property
    def shape(self) -> Kind:
        """What its kind says."""
        return KINDS[self.kind]

    @property
    def wheels(self) -> tuple[str, ...]:
        """The members at its wheels, in the order of its kind."""
        return tuple(self.members[wheel.port] for wheel in self.shape.wheels)

    @property
    def carrier(self) -> str:
        """The member that its planets turn with."""
        return self.members["carrier"] if self.shape.carried else HOUSING

    def speeds_of_planets(self) -> tuple[Fraction, ...]:
        """What each wheel, at speed 1 against the carrier, turns the planets with, up to one factor for all."""
        if self.ratios:
            return self._by_ratios()
        return tuple(
            Fraction(wheel.sign * self.teeth[wheel.port], self.teeth.get(wheel.planet, 1))
            for wheel in self.shape.wheels
        )

    def _by_ratios(self) -> tuple[Fraction, ...]:
        sizes = dict.fromkeys((wheel.port for wheel in self.shape.wheels), Fraction(1))
        for name, (over, under) in self.shape.ratios.items():
            # the wheel that all ratios have in common keeps its size
            common = over if len(self.shape.ratios) > 1 else under
            ratio = exact(self.ratios[name])
            sizes[under if common == over else over] = 1 / ratio if common == over else ratio
        return tuple(wheel.sign * sizes[wheel.port] for wheel in self.shape.wheels)

    def meshes(self) -> tuple[tuple[str, str, Fraction], ...]:
        """Pairs of wheels with the ratio k between their speeds against the carrier: first = k second."""
        first, *others = self.speeds_of_planets()
        names = self.wheels
        return tuple((names[0], names[n], size / first) for n, size in enumerate(others, 1))

    def rows(self) -> tuple[dict[str, Fraction], ...]:
        """Coefficients of the speeds of members whose sum is zero, one row for each pair of wheels."""
        return tuple(
            summed(((first, Fraction(1)), (second, -k), (self.carrier, k - 1))) for first, second, k in self.meshes()
        )


def summed(terms: tuple[tuple[str, Fraction], ...]) -> dict[str, Fraction]:
    """A row from its terms; members that stand at two ports are added up, and the housing stays out."""
    made: dict[str, Fraction] = {}
    for member, value in terms:
        made[member] = made.get(member, Fraction(0)) + value
    made.pop(HOUSING, None)
    return made
