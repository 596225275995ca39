"""One valid instance of everything that is declared, made from the declaration alone."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import MISSING
from functools import cache
from typing import Any

import clutchwork as cw
from clutchwork.declare.schema import REGISTRY, Role, Spec, inputs, specs
from clutchwork.laws.bases.tables import Tabulated

ELEMENT_ROLES = tuple(role for role in Role if role not in (Role.LAW, Role.SIGNAL))


def declared(*roles: Role) -> list[Any]:
    """All declared classes of the given roles."""
    return [cls for role in roles for cls in REGISTRY[role].values()]


def acting(*roles: Role) -> list[Any]:
    """Those of them that are no transmissions, whose torque follows from the motion of all else."""
    return [cls for cls in declared(*roles) if "ratio" not in cls.hooks]


def pressed_contacts() -> list[str]:
    """Kinds of contacts that any friction law fits and whose load is a torque, or in proportion to a gain."""
    known = {kind: {item.name for item, _ in specs(cls)} for kind, cls in REGISTRY[Role.CONTACT].items()}
    return sorted(kind for kind, names in known.items() if {"friction", "gain"} <= names or kind == "bearing_friction")


def ends(kind: str, body: Any, other: Any) -> dict[str, Any]:
    """The ports of a contact whose slip is the speed of a body; some brake it against the housing alone."""
    names = {item.name for item, _ in specs(REGISTRY[Role.CONTACT][kind], "port")}
    moving = "follower" if "follower" in names else "shaft"
    return {moving: body, "base": other} if "base" in names else {moving: body}


@cache
def pressing(kind: str, load: float) -> dict[str, float]:
    """Values under which a pressed contact has a load [N m or N]: its torque, or its inputs and a gain for them."""
    cls = REGISTRY[Role.CONTACT][kind]
    needed = {item.name: spec for item, spec in specs(cls, "param") if item.default is MISSING}
    if "torque" in needed:
        return {"torque": load}
    pressed = [(names[0], spec) for names, spec in inputs(cls) if spec.presses or spec.otherwise is None]
    given = {name: 10.0 if spec.example is None else spec.example for name, spec in pressed}
    given |= {name: number(name, spec) for name, spec in needed.items() if name != "gain"}
    return {"gain": load / _load(kind, given), **given}


def _load(kind: str, given: Mapping[str, float]) -> float:
    """What a contact presses with at a gain of 1."""
    d = cw.Driveline(kind)
    a, b = d.shaft("a", inertia=1.0, speed=1.0), d.shaft("b", inertia=1.0)
    law = cw.Coulomb(static=1.0, kinetic=1.0)
    d.add(REGISTRY[Role.CONTACT][kind]("c", friction=law, gain=1.0, **ends(kind, a, b), **given))
    load = -float(d.simulate(1e-6)["c.torque"][0])
    assert load > 0.0, f"{kind} does not press under {given}: give its inputs examples under which it does"
    return load


def over_slip() -> dict[str, Any]:
    """Friction laws by kind, without those with tables over more than the slip, which have tests of their own."""
    return {kind: cls for kind, cls in REGISTRY[Role.LAW].items() if not issubclass(cls, Tabulated)}


def law(cls: Any) -> cw.Law:
    """A friction law."""
    made: cw.Law = cls(**fields(cls, {}))
    return made


def number(name: str, spec: Spec) -> Any:
    """The example of the declaration, else a number within the bounds; coefficients at rest are above all others."""
    if spec.example is not None:
        return spec.example
    if spec.choices:
        return spec.choices[0]
    if spec.flag:
        return True
    value = 0.2 if name == "static" else 0.1
    if spec.whole:
        return 30
    if spec.at_least is not None:
        value += spec.at_least
    if spec.above is not None:
        value += spec.above
    return value


def value(name: str, spec: Spec, nodes: Mapping[str, Any]) -> Any:
    """A value for one field."""
    if spec.what == "port":
        return nodes[spec.domain or "rotation"] if name not in ("base", "support", "input", "ring") else nodes["other"]
    if spec.what == "thermal":
        # first port: plates, second one: air
        return nodes["air" if name in ("cold", "inlet") else "plates"]
    if spec.what == "law":
        return cw.Coulomb(static=0.2, kinetic=0.1)
    if spec.what == "curve":
        return list(spec.example or [(0.0, 0.1), (10.0, 0.05)])
    if spec.what == "numbers":
        return spec.example or (0.1, 0.2)
    if spec.what == "signal" and spec.unit == "K":
        return 300.0
    if spec.what == "signal":
        return _signal(name, spec)
    if spec.what == "text":
        return name
    if spec.what == "function":
        return lambda time, readings: 0.0
    return number(name, spec)


def _signal(name: str, spec: Spec) -> Any:
    """A step up to the example; without one a step, or a number where there are bounds."""
    if spec.example is not None:
        half = 0.5 * spec.example
        return cw.Step(height=half, start=0.5, offset=half) if spec.allows(half) else spec.example
    return number(name, spec) if spec.bound else cw.Step(height=2.0, start=0.5)


# laws that are written down, with numbers that they name: the declaration has none
BENDING = "v - abs(v)*z/(kinetic + (static - kinetic)*exp(-(v/speed)**2))"
CURVE = {"static": 0.15, "kinetic": 0.1, "speed": 2.0}
WRITTEN: dict[str, dict[str, Any]] = {
    "formula": {"expression": "kinetic + (static - kinetic)*exp(-v/speed)", **CURVE},
    "dynamic_formula": {
        "expression": f"z + damping*({BENDING}) + viscous*v",
        "rates": {"z": f"stiffness*({BENDING})"},
        "at_rest": "static",
        **CURVE,
        "stiffness": 1e3,
        "damping": 1e-3,
        "viscous": 1e-3,
    },
}


def fields(cls: type, nodes: Mapping[str, Any]) -> dict[str, Any]:
    """Values for all fields that must be given or have an example, alternatives and teeth left out."""
    if getattr(cls, "takes_numbers", False):
        return dict(WRITTEN[cls.kind])  # type: ignore[attr-defined]
    needed = {names[0] for names, spec in inputs(cls) if spec.otherwise is None}
    made = {
        item.name: value(item.name, spec, nodes)
        for item, spec in specs(cls)
        if item.default is MISSING or item.name in needed | {"ratio", "radius"} or spec.example is not None
    }
    if "ratio" in made:
        made["ratio"] = 2.5
    return made


def driveline(cls: type) -> cw.Driveline:
    """A driveline with one element of a class, named "x"."""
    d = cw.Driveline(cls.__name__)
    nodes: dict[str, Any] = {"rotation": d.shaft("a", inertia=0.3), "other": d.shaft("b", inertia=0.7)}
    nodes |= {"plates": d.thermal("plates", capacity=800.0), "air": d.ambient("air", temperature=290.0)}
    third = d.shaft("c", inertia=0.2)
    fourth = d.shaft("d", inertia=0.4) if "large_sun" in {item.name for item, _ in specs(cls, "port")} else None
    nodes["translation"] = d.mass("m", mass=2.0)
    values = fields(cls, nodes)
    # three members of a planetary gear are three shafts
    if "carrier" in values:
        values["carrier"] = third
    if fourth is not None:
        values["large_sun"] = fourth
    # as are two wheels, and two sides
    values |= {
        name: nodes["other"]
        for name in ("wheel", "right", "turbine", "forward")
        if isinstance(values.get(name), cw.Node)
    }
    d.add(cls("x", **values))
    return d


def bodies(d: cw.Driveline, cls: type, at: str = "") -> Any:
    """What makes the bodies that a class joins, or one at a port: shafts, or masses where its ports say so."""
    known = [(item.name, spec) for item, spec in specs(cls, "port")]
    moves = any(spec.domain == "translation" for name, spec in known if at in ("", name))
    return (lambda name, inertia=0.0, **more: d.mass(name, mass=inertia, **more)) if moves else d.shaft


def nodes() -> dict[str, Any]:
    """Nodes without a driveline."""
    thermal = {name: cw.ThermalNode(name, 1.0) for name in ("plates", "air")}
    return {name: cw.Node(name, inertia=1.0) for name in ("rotation", "other", "translation")} | thermal
