"""Sets of numbers from which every friction law takes its parameters, so that laws are compared on equal terms."""

from __future__ import annotations

from functools import cached_property
from math import exp
from typing import Any

from clutchwork.base import dataclass, near
from clutchwork.declare.node import Domain, Law
from clutchwork.declare.schema import REGISTRY, Role, specs

# deflection over static/stiffness and share; the weak ones bring a body to rest that swings on its contact
ELEMENTS = (
    (0.02, 0.03), (0.05, 0.05), (0.1, 0.07), (0.2, 0.1), (0.4, 0.15), (0.8, 0.2), (1.3, 0.15), (2.0, 0.15), (3.0, 0.1),
)  # fmt: skip


@dataclass(frozen=True)
class Preset:
    """What a contact is like: one Stribeck curve, one stiffness, one damping, for all laws.

    Numbers of a contact between masses; with `domain` ROTATION read rad for m, N m for N and kg m2 for kg.
    """

    name: str
    title: str
    domain: Domain = Domain.TRANSLATION
    load: float = 1.0  # N per unit of coefficient
    mass: float = 1.0  # kg, the body of the experiments
    static: float = 1.0  # 1
    kinetic: float = 0.7  # 1
    speed: float = 0.01  # m/s, Stribeck speed
    viscous: float = 0.4  # s/m
    stiffness: float = 1e4  # 1/m
    damping: float = 200.0  # s/m
    elastic: float = 1e-4  # m, wind-up of the Mykhalevych law
    inner: float = 1.0  # 1, inner friction of the Mykhalevych law
    width: float = 1e-3  # m/s, within which regularised laws smooth the sign
    elements: tuple[tuple[float, float], ...] = ELEMENTS  # of Leuven and GMS
    order: float = 50.0  # 1, of the Leuven law: large, so that it does not creep
    attraction: float = 100.0  # 1/s
    mean: float = 0.3  # share of the static force, middle of the swinging load of the drift test
    swing: float = 0.2  # share of the static force, its amplitude
    frequency: float = 2.0  # Hz, its frequency
    end: float = 20.0  # s, when it ends

    @property
    def force(self) -> float:
        """Static friction force [N], the unit of the loads in the experiments."""
        return self.load * self.static

    @property
    def length(self) -> float:
        """Deflection at which the elastic force reaches the static one [m]."""
        return self.static / self.stiffness

    @property
    def unit_length(self) -> str:
        """Unit of a displacement."""
        return "rad" if self.domain is Domain.ROTATION else "m"

    @property
    def unit_speed(self) -> str:
        """Unit of a speed."""
        return f"{self.unit_length}/s"

    @property
    def unit_force(self) -> str:
        """Unit of a force."""
        return "N m" if self.domain is Domain.ROTATION else "N"

    @cached_property
    def fields(self) -> dict[str, dict[str, Any]]:
        """Parameters of the laws that have numbers here, by kind; `law` makes the others from their examples."""
        curve = {"static": self.static, "kinetic": self.kinetic, "speed": self.speed, "viscous": self.viscous}
        bristle = {**curve, "stiffness": self.stiffness, "damping": self.damping}
        stack = tuple((deflection * self.length, share) for deflection, share in self.elements)
        return {
            "coulomb": {"static": self.static, "kinetic": self.kinetic},
            "exponential": {"static": self.static, "slow": self.static, "fast": self.kinetic, "speed": self.speed},
            "coefficient_table": {"static": self.static, "kinetic": self._points()},
            "stribeck": curve,
            "karnopp": {**curve, "band": 0.1 * self.speed},
            "naive_sign": curve,
            "tanh": {"kinetic": self.kinetic, "speed": self.width},
            "regularised_stribeck": {**curve, "width": self.width},
            "dahl": {"kinetic": self.kinetic, "stiffness": self.stiffness},
            "lugre": bristle,
            "elastoplastic": {**bristle, "elastic": 0.7 * self.kinetic / self.stiffness},
            "leuven": {**curve, "elements": stack, "order": self.order},
            "gms": {**curve, "elements": stack, "attraction": self.attraction},
            "mykhalevych": {
                "static": self.static,
                "kinetic": self.kinetic,
                "elastic": self.elastic,
                "speed": self.speed,
                "viscous": self.inner,
            },
        }

    @property
    def laws(self) -> tuple[str, ...]:
        """Kinds of all laws over the slip alone: those with numbers here, then those at their own examples."""
        known = REGISTRY[Role.LAW]
        others = sorted(kind for kind in known if kind not in self.fields and not any(specs(known[kind], "signal")))
        return (*(kind for kind in self.fields if kind in known), *others)

    def law(self, kind: str) -> Law:
        """The law of a kind with the parameters of this set, or with the examples of its declaration."""
        cls = REGISTRY[Role.LAW][kind]
        made: Law = cls(**self.fields.get(kind) or _examples(cls))
        return made

    def curve(self, speed: float) -> float:
        """Steady friction force of the Stribeck curve at a speed [m/s] above zero [N]."""
        fall = exp(-((speed / self.speed) ** 2))
        return self.load * (self.kinetic + (self.static - self.kinetic) * fall + self.viscous * speed)

    def _points(self) -> tuple[tuple[float, float], ...]:
        """The Stribeck curve as a table."""
        steps = [0.25 * i for i in range(13)] + [100.0]
        return tuple((x * self.speed, self.curve(x * self.speed) / self.load) for x in steps)


def _examples(cls: type) -> dict[str, Any]:
    """Parameters of a law from its declaration."""
    return {item.name: spec.example for item, spec in specs(cls) if spec.example is not None}


FIRST = Preset("first", "first set of the drift test: 2 Hz, static 1 N, kinetic 0.7 N, Stribeck speed 10 mm/s")
SECOND = Preset(
    "second",
    "second set of the drift test: 1 Hz, static 1 N, kinetic 0.8 N, Stribeck speed 1 mm/s",
    kinetic=0.8,
    speed=1e-3,
    damping=100.0,
    mean=0.5,
    swing=0.1,
    frequency=1.0,
    end=21.0,
)
CLUTCH = Preset(
    "clutch",
    "dry clutch: 300 N m static, 240 N m kinetic, Stribeck speed 3 rad/s, 0.2 mrad of elastic wind-up",
    domain=Domain.ROTATION,
    load=1000.0,
    mass=0.2,
    static=0.3,
    kinetic=0.24,
    speed=3.0,
    viscous=0.0,
    stiffness=1500.0,
    damping=0.02,
    elastic=2e-4,
    inner=1.0,
    width=0.1,
    attraction=1000.0,
)
PRESETS = {preset.name: preset for preset in (FIRST, SECOND, CLUTCH)}


def preset_of(wanted: str | Preset) -> Preset:
    """The preset of a name; ValueError with a near match for an unknown one."""
    if isinstance(wanted, Preset):
        return wanted
    if wanted not in PRESETS:
        rest = f"known presets: {', '.join(PRESETS)}"
        raise ValueError(f"unknown preset {wanted!r}{near(wanted, PRESETS, rest)}")
    return PRESETS[wanted]
