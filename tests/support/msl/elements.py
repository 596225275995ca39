"""One entry per element type: how it is written in clutchwork.

An entry gets the name, the element, a function `at(port)` that gives the clutchwork node of a flange, and the model.
MSL counts tau on the element at flange_b; clutchwork counts the torque on the follower: the opposite sign. Both
count slip and twist as flange_b - flange_a = follower - base. Types that only join flanges or state initial values
have an empty entry.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any

import clutchwork as cw

from .signals import UnsupportedError

if TYPE_CHECKING:
    from .model import Builder

At = Callable[[str], cw.Node]
Entry = Callable[["Builder", str, Mapping[str, Any], At], list[Any]]


def _nothing(b: Builder, name: str, e: Mapping[str, Any], at: At) -> list[Any]:
    return []


def _spring(b: Builder, name: str, e: Mapping[str, Any], at: At) -> list[Any]:
    twist = b.start_distance(name) - float(e.get("rel0", 0.0))
    ends = {"base": at("flange_a"), "follower": at("flange_b"), "initial_twist": twist}
    if e["type"] == "spring":
        return [cw.Spring(name, stiffness=float(e["c"]), **ends)]
    return [cw.SpringDamper(name, stiffness=float(e["c"]), damping=float(e["d"]), **ends)]


def _damper(b: Builder, name: str, e: Mapping[str, Any], at: At) -> list[Any]:
    return [cw.Damper(name, base=at("flange_a"), follower=at("flange_b"), damping=float(e["d"]))]


def _torque(b: Builder, name: str, e: Mapping[str, Any], at: At) -> list[Any]:
    return [cw.Torque(name, shaft=at("flange"), base=at("support"), torque=b.signal(e["tau"]))]


def _torque2(b: Builder, name: str, e: Mapping[str, Any], at: At) -> list[Any]:
    return [cw.Torque(name, shaft=at("flange_b"), base=at("flange_a"), torque=b.signal(e["tau"]))]


def _constant_torque(b: Builder, name: str, e: Mapping[str, Any], at: At) -> list[Any]:
    return [cw.Torque(name, shaft=at("flange"), base=at("support"), torque=float(e["tau_constant"]))]


def _speed_dependent(b: Builder, name: str, e: Mapping[str, Any], at: At) -> list[Any]:
    cls = cw.LinearTorque if e["type"].startswith("linear") else cw.QuadraticTorque
    return [
        cls(
            name,
            shaft=at("flange"),
            base=at("support"),
            nominal_torque=float(e["tau_nominal"]),
            nominal_speed=float(e["w_nominal"]),
            same_direction=bool(e.get("same_direction", True)),
        )
    ]


def _speed(b: Builder, name: str, e: Mapping[str, Any], at: At) -> list[Any]:
    cutoff = {} if e.get("exact", False) else {"cutoff": float(e["f_crit"])}
    return [cw.PrescribedSpeed(name, shaft=at("flange"), base=at("support"), speed=b.signal(e["w_ref"]), **cutoff)]


def _constant_speed(b: Builder, name: str, e: Mapping[str, Any], at: At) -> list[Any]:
    value = e.get("w_fixed", e.get("v_fixed", e.get("w")))
    return [cw.PrescribedSpeed(name, shaft=at("flange"), base=at("support"), speed=float(value))]


def _friction(e: Mapping[str, Any], table: str, least_peak: float = 0.0) -> tuple[Any, float]:
    """(law, scale): the table divided by its value at rest, with the peak above it."""
    points = [(float(x), float(y)) for x, y in e[table]]
    scale = points[0][1]
    static = max(float(e.get("peak", 1.0)), least_peak)
    if len(points) == 1:
        return cw.Coulomb(static=static, kinetic=1.0), scale
    return cw.CoefficientTable(static=static, kinetic=[(x, y / scale) for x, y in points]), scale


def _contact(b: Builder, name: str, e: Mapping[str, Any], at: At) -> list[Any]:
    one_way = e["type"] == "one_way_clutch"
    friction, scale = _friction(e, "mu_pos", 1.0 + float(e["eps0"]) if one_way else 0.0)
    cls = cw.OneWayClutch if one_way else cw.Clutch
    force = b.signal(e["f_normalized"], float(e["fn_max"]))
    return [
        cls(
            name,
            base=at("flange_a"),
            follower=at("flange_b"),
            friction=friction,
            gain=scale * float(e["cgeo"]),
            normal_force=force,
        )
    ]


def _brake(b: Builder, name: str, e: Mapping[str, Any], at: At) -> list[Any]:
    friction, scale = _friction(e, "mu_pos")
    ends = {"friction": friction, "gain": scale * float(e["cgeo"])}
    force = b.signal(e["f_normalized"], float(e["fn_max"]))
    if at("support") is b.driveline.housing:
        return [cw.Brake(name, shaft=at("flange_a"), normal_force=force, **ends)]
    return [cw.Clutch(name, base=at("support"), follower=at("flange_a"), normal_force=force, **ends)]


def _bearing(b: Builder, name: str, e: Mapping[str, Any], at: At) -> list[Any]:
    friction, scale = _friction(e, "tau_pos")
    return [cw.BearingFriction(name, shaft=at("flange_a"), base=at("support"), friction=friction, torque=scale)]


def _gear(b: Builder, name: str, e: Mapping[str, Any], at: At) -> list[Any]:
    ends = {"input": at("flange_a"), "output": at("flange_b"), "support": at("support")}
    return [cw.Gear(name, ratio=float(e["ratio"]), **ends)]


def _planetary(b: Builder, name: str, e: Mapping[str, Any], at: At) -> list[Any]:
    return [cw.Planetary(name, sun=at("sun"), ring=at("ring"), carrier=at("carrier"), ratio=float(e["ratio"]))]


def _wheel(b: Builder, name: str, e: Mapping[str, Any], at: At) -> list[Any]:
    radius = float(e["radius"]) if e["type"] == "ideal_rolling_wheel" else 1.0 / float(e["ratio"])
    if at("supportR") is not b.driveline.housing or at("supportT") is not b.driveline.housing:
        raise UnsupportedError("rolling wheel with a moving support")
    return [cw.RollingWheel(name, shaft=at("flangeR"), mass=at("flangeT"), radius=radius)]


ENTRIES: dict[str, Entry] = {
    "inertia": _nothing,
    "mass": _nothing,
    "rod": _nothing,
    "fixed": _nothing,
    "relative_states": _nothing,
    "spring": _spring,
    "spring_damper": _spring,
    "damper": _damper,
    "torque": _torque,
    "torque2": _torque2,
    "constant_torque": _constant_torque,
    "linear_speed_dependent_torque": _speed_dependent,
    "quadratic_speed_dependent_torque": _speed_dependent,
    "speed": _speed,
    "constant_speed": _constant_speed,
    "clutch": _contact,
    "one_way_clutch": _contact,
    "brake": _brake,
    "bearing_friction": _bearing,
    "ideal_gear": _gear,
    "ideal_planetary": _planetary,
    "ideal_rolling_wheel": _wheel,
    "ideal_gear_r2t": _wheel,
}


def missing(case: Mapping[str, Any]) -> list[str]:
    """Element types of the case that have no entry."""
    return sorted({e["type"] for e in case["elements"].values()} - set(ENTRIES))
