"""One entry per element type: how it is written in clutchwork.

An entry gets the name, the element, a function `at(port)` that gives the clutchwork node of a flange, and the model.
MSL counts tau on the element at flange_b; clutchwork counts the torque on the follower: the opposite sign. Both
count slip and twist as flange_b - flange_a = follower - base. Types that only join flanges or state initial values
have an empty entry.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

import clutchwork as cw

from .pieces import UnsupportedError, product, scaled
from .signals import as_signal, levels

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


def _backlash(b: Builder, name: str, e: Mapping[str, Any], at: At) -> list[Any]:
    if abs(float(e["b"])) <= 1e-10:
        return _spring(b, name, {**e, "type": "spring_damper"}, at)
    return [
        cw.ElasticBacklash(
            name,
            base=at("flange_a"),
            follower=at("flange_b"),
            stiffness=float(e["c"]),
            damping=float(e["d"]),
            gap=abs(float(e["b"])),
            limited=e["type"] == "elasto_backlash",
            initial_twist=b.start_distance(name) - float(e.get("rel0", 0.0)),
        )
    ]


def _elastic_gap(b: Builder, name: str, e: Mapping[str, Any], at: At) -> list[Any]:
    if float(e.get("n", 1.0)) != 1.0:
        raise UnsupportedError(f"elasto_gap with n = {e['n']}")
    gap = b.start_distance(name) - float(e["rel0"])
    values = {"stiffness": float(e["c"]), "damping": float(e["d"]), "initial_gap": gap}
    return [cw.ElasticGap(name, base=at("flange_a"), follower=at("flange_b"), **values)]


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
    if e.get("exact", False):
        return _motion(name, at, b.signal(e["w_ref"]))
    # the filter takes no train of pulses
    speed = as_signal(b.pieces(e["w_ref"]), b.t_end) if b.kind(e["w_ref"]) == "pulse" else b.signal(e["w_ref"])
    return _motion(name, at, speed, cutoff=float(e["f_crit"]))


def _motion(name: str, at: At, speed: Any, **other: float) -> list[Any]:
    return [cw.PrescribedSpeed(name, shaft=at("flange"), base=at("support"), speed=speed, **other)]


def constant_speed(e: Mapping[str, Any]) -> float:
    """The value of a constant speed, by any of its names."""
    return float(next(e[key] for key in ("w_fixed", "v_fixed", "w", "v") if key in e))


def _constant_speed(b: Builder, name: str, e: Mapping[str, Any], at: At) -> list[Any]:
    return _motion(name, at, constant_speed(e))


def _accelerate(b: Builder, name: str, e: Mapping[str, Any], at: At) -> list[Any]:
    wanted = as_signal(b.pieces(e["a_ref"]), b.t_end)
    return [cw.PrescribedAcceleration(name, shaft=at("flange"), base=at("support"), acceleration=wanted)]


def position_signal(e: Mapping[str, Any]) -> Any:
    """The signal that a flange follows."""
    return e["phi_ref"] if "phi_ref" in e else e["s_ref"]


def _position(b: Builder, name: str, e: Mapping[str, Any], at: At) -> list[Any]:
    wanted = as_signal(b.pieces(position_signal(e)), b.t_end)
    cutoff = None if e.get("exact", False) else float(e["f_crit"])
    return [cw.PrescribedPosition(name, shaft=at("flange"), base=at("support"), position=wanted, cutoff=cutoff)]


def _eddy_current(b: Builder, name: str, e: Mapping[str, Any], at: At) -> list[Any]:
    """With its heat capacity, whose temperature is an output of the case."""
    brake = cw.EddyCurrentBrake(
        name,
        shaft=at("flange"),
        base=at("support"),
        nominal_torque=float(e["tau_nominal"]),
        nominal_speed=float(e["w_nominal"]),
        temperature_coefficient=float(e["alpha20"]),
        reference_temperature=float(e["TRef"]),
        heat=b.driveline.thermal(f"{name}_heat", capacity=float(e["heat_capacity"]), temperature=float(e["T0"])),
    )
    return [brake]


def _sign_torque(b: Builder, name: str, e: Mapping[str, Any], at: At) -> list[Any]:
    """2/(1 + exp(-w/(0.01 w0))) - 1 = tanh(w/(0.02 w0))."""
    if e.get("reg", "exp") != "exp":
        raise UnsupportedError(f"sign_torque with {e['reg']}")
    ends = {"shaft": at("flange"), "base": at("support")}
    return [cw.ResistingTorque(name, torque=-float(e["tau_nominal"]), speed=0.02 * float(e["w0"]), **ends)]


def _rolling_resistance(b: Builder, name: str, e: Mapping[str, Any], at: At) -> list[Any]:
    """A brake whose coefficient rises from 0 to 1 at v0 and stays there."""
    if e.get("reg", "linear") != "linear":
        raise UnsupportedError(f"rolling_resistance with {e['reg']}")
    slope = levels(b.pieces(e.get("inclination", 0.0)), lambda y: math.cos(math.atan(y)))
    force = scaled(product(b.pieces(e["cr"]), slope), float(e["fWeight"]))
    law = cw.CoefficientTable(static=0.0, kinetic=[(0.0, 0.0), (float(e["v0"]), 1.0)])
    ends = {"friction": law, "gain": 1.0, "normal_force": as_signal(force, b.t_end)}
    return [cw.Clutch(name, base=at("support"), follower=at("flange"), **ends)]


def _friction(e: Mapping[str, Any], table: str, least_peak: float = 0.0) -> tuple[Any, float]:
    """(law, scale): the table divided by its largest value, with the peak above its value at rest."""
    points = [(float(x), float(y)) for x, y in e[table]]
    scale = max(y for _, y in points) or 1.0
    peak = max(float(e.get("peak", 1.0)), least_peak)
    if len(points) == 1:
        return cw.Coulomb(static=peak, kinetic=1.0), scale
    law = cw.CoefficientTable(static=0.0, kinetic=[(x, y / scale) for x, y in points], extrapolation="linear")
    return replace(law, static=peak * law.sliding()), scale


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


def _lossy_gear(b: Builder, name: str, e: Mapping[str, Any], at: At) -> list[Any]:
    """Without losses a gear."""
    rows = [tuple(float(x) for x in row) for row in e["loss_table"]]
    if all(row[1:] == (1.0, 1.0, 0.0, 0.0) for row in rows):
        return _gear(b, name, e, at)
    ends = {"input": at("flange_a"), "output": at("flange_b"), "support": at("support")}
    return [cw.LossyGear(name, ratio=float(e["ratio"]), loss_table=rows, **ends)]


def _planetary(b: Builder, name: str, e: Mapping[str, Any], at: At) -> list[Any]:
    return [cw.Planetary(name, sun=at("sun"), ring=at("ring"), carrier=at("carrier"), ratio=float(e["ratio"]))]


def _wheel(b: Builder, name: str, e: Mapping[str, Any], at: At) -> list[Any]:
    radius = float(e["radius"]) if e["type"] == "ideal_rolling_wheel" else 1.0 / float(e["ratio"])
    if at("supportR") is not b.driveline.housing or at("supportT") is not b.driveline.housing:
        raise UnsupportedError("rolling wheel with a moving support")
    return [cw.RollingWheel(name, shaft=at("flangeR"), mass=at("flangeT"), radius=radius)]


def _stopped_mass(b: Builder, name: str, e: Mapping[str, Any], at: At) -> list[Any]:
    """Friction, drag and inelastic stops beside a mass; the position is that of its centre."""
    coulomb, stribeck = float(e["F_Coulomb"]), float(e["F_Stribeck"])
    length, body = float(e.get("L", 0.0)), at("flange_a")
    scale, speed = coulomb + stribeck, 1.0 / float(e["fexp"])
    law = cw.Exponential(static=1.001, slow=1.0, fast=coulomb / scale, speed=speed)
    housing = b.driveline.housing
    return [
        cw.BearingFriction(name, shaft=body, base=housing, friction=law, torque=scale),
        cw.Damper(f"{name}_drag", base=housing, follower=body, damping=float(e["F_prop"])),
        cw.EndStop(
            f"{name}_stop",
            follower=body,
            lower=float(e["smin"]) + length / 2,
            upper=float(e["smax"]) - length / 2,
            initial_position=b.start_place(f"{name}.flange_a") + length / 2,
        ),
    ]


ENTRIES: dict[str, Entry] = {
    "inertia": _nothing,
    "mass": _nothing,
    "rod": _nothing,
    "fixed": _nothing,
    "relative_states": _nothing,
    "spring": _spring,
    "spring_damper": _spring,
    "elasto_backlash": _backlash,
    "elasto_backlash2": _backlash,
    "elasto_gap": _elastic_gap,
    "mass_with_stop_and_friction": _stopped_mass,
    "damper": _damper,
    "torque": _torque,
    "torque2": _torque2,
    "constant_torque": _constant_torque,
    "linear_speed_dependent_torque": _speed_dependent,
    "quadratic_speed_dependent_torque": _speed_dependent,
    "eddy_current_torque": _eddy_current,
    "speed": _speed,
    "constant_speed": _constant_speed,
    "accelerate": _accelerate,
    "position": _position,
    "sign_torque": _sign_torque,
    "rolling_resistance": _rolling_resistance,
    "clutch": _contact,
    "one_way_clutch": _contact,
    "brake": _brake,
    "bearing_friction": _bearing,
    "ideal_gear": _gear,
    "lossy_gear": _lossy_gear,
    "ideal_planetary": _planetary,
    "ideal_rolling_wheel": _wheel,
    "ideal_gear_r2t": _wheel,
}


def missing(case: Mapping[str, Any]) -> list[str]:
    """What the elements of the case are that has no entry."""
    return sorted({e["type"] for e in case["elements"].values()} - set(ENTRIES))
