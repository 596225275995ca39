"""Ravigneaux, compound planetary, bevel, rack and chain: ratios as fractions, torques, and what mistakes are."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest

import clutchwork as cw

SETS = {"small_sun": 28, "large_sun": 34, "ring": 76}


def _speeds(gear, wanted):
    """Speeds of all members, from the exact rows, where two are given."""
    members = list(gear.rows()[0].keys() | gear.rows()[-1].keys())
    rows = [[float(row.get(name, 0)) for name in members] for row in gear.rows()]
    right = [0.0] * len(rows)
    for name, speed in wanted.items():
        rows.append([float(name == member) for member in members])
        right.append(speed)
    return dict(zip(members, np.linalg.solve(np.array(rows), right), strict=True))


def _ravigneaux(**values):
    nodes = {name: cw.Node(name, inertia=1.0) for name in (*SETS, "carrier")}
    values = values or {f"teeth_{name}": teeth for name, teeth in SETS.items()}
    return cw.Ravigneaux("set", **nodes, **values)


@pytest.mark.parametrize(
    ("held", "driven", "ratio"),
    [
        # Willis: with the carrier at rest wheels turn by their teeth, internal and outer meshes with opposite signs
        ("carrier", "small_sun", Fraction(76, 28)),
        ("carrier", "large_sun", -Fraction(76, 34)),
        ("large_sun", "small_sun", (Fraction(34, 28) + 1) / (Fraction(34, 76) + 1)),
        ("small_sun", "large_sun", (Fraction(28, 34) + 1) / (1 - Fraction(28, 76))),
    ],
)
def test_ratios_of_a_ravigneaux_gear(held, driven, ratio):
    speeds = _speeds(_ravigneaux(), {held: 0.0, "ring": 1.0})
    assert speeds[driven] == pytest.approx(float(ratio))
    by_ratio = _ravigneaux(ratio_large=76 / 34, ratio_small=76 / 28)
    assert _speeds(by_ratio, {held: 0.0, "ring": 1.0})[driven] == pytest.approx(float(ratio))


def test_a_ravigneaux_gear_is_a_single_and_a_double_set():
    assert _ravigneaux().rows()[0]["ring"] == Fraction(76, 34)
    runs = []
    for parts in (False, True):
        d = cw.Driveline("set")
        nodes = {name: d.shaft(name, inertia=0.1 * (k + 1)) for k, name in enumerate((*SETS, "carrier"))}
        if parts:
            common = {"ring": nodes["ring"], "carrier": nodes["carrier"], "teeth_ring": 76}
            d.add(cw.Planetary("p1", sun=nodes["large_sun"], teeth_sun=34, **common))
            d.add(cw.DoublePlanetary("p2", sun=nodes["small_sun"], teeth_sun=28, **common))
        else:
            d.add(cw.Ravigneaux("p", **nodes, **{f"teeth_{name}": teeth for name, teeth in SETS.items()}))
        d.add(cw.Torque("t", shaft=nodes["small_sun"], torque=3.0))
        d.add(cw.Damper("load", base=d.housing, follower=nodes["ring"], damping=0.4))
        runs.append(d.simulate(1.0))
    for name in ("ring", "large_sun"):
        assert np.array_equal(runs[0][f"{name}.speed"], runs[1][f"{name}.speed"])
    # no torque is lost, and no power
    one = runs[0]
    torques = {name: one[f"p.torque_{name}"] for name in (*SETS, "carrier")}
    assert sum(torques.values()) == pytest.approx(0.0, abs=1e-9)
    power = sum(torques[name] * one[f"{name}.speed"] for name in torques)
    assert power == pytest.approx(0.0, abs=1e-9)


def test_a_stepped_set_is_a_pair_of_gears_on_its_carrier():
    teeth = {"teeth_sun": 17, "teeth_planet_sun": 58, "teeth_planet_ring": 23, "teeth_ring": 98}
    runs = []
    for parts in (False, True):
        d = cw.Driveline("hub")
        sun, ring, carrier = (d.shaft(name, inertia=k) for k, name in enumerate(("sun", "ring", "carrier"), 1))
        if parts:
            planets = d.shaft("planets")
            d.add(cw.Gear("g1", input=sun, output=planets, support=carrier, teeth_input=17, teeth_output=58))
            d.add(cw.Gear("g2", input=ring, output=planets, support=carrier, teeth_input=-98, teeth_output=23))
        else:
            d.add(cw.CompoundPlanetary("hub", sun=sun, ring=ring, carrier=carrier, **teeth))
        d.add(cw.Torque("t", shaft=sun, torque=3.0))
        d.add(cw.Damper("load", base=ring, follower=carrier, damping=0.4))
        runs.append(d.simulate(1.0))
    assert runs[0]["carrier.speed"] == pytest.approx(runs[1]["carrier.speed"], rel=1e-12)
    assert runs[0]["ring.speed"] == pytest.approx(runs[1]["ring.speed"], rel=1e-12)
    ratio = cw.CompoundPlanetary("x", sun=cw.Node("s"), ring=cw.Node("r"), carrier=cw.Node("c"), **teeth).exact_ratio()
    assert ratio == Fraction(58 * 98, 17 * 23)


def test_bevel_gears_make_a_differential():
    d = cw.Driveline("axle")
    cage, left, right = (d.shaft(name, inertia=1.0) for name in ("cage", "left", "right"))
    spider = d.shaft("spider")
    d.add(cw.BevelGear("l", input=left, output=spider, support=cage, teeth_input=16, teeth_output=10))
    d.add(cw.BevelGear("r", input=right, output=spider, support=cage, ratio=-10 / 16))
    d.add(cw.Torque("t", shaft=cage, torque=12.0))
    d.add(cw.Damper("b", base=d.housing, follower=left, damping=0.7))
    run = d.simulate(2.0)
    assert run["left.speed"] + run["right.speed"] == pytest.approx(2.0 * run["cage.speed"])
    assert run["l.torque_input"] == pytest.approx(run["r.torque_input"])
    assert run["l.torque_support"] == pytest.approx(-run["l.torque_input"])


def test_rack_and_chain():
    d = cw.Driveline("rack")
    shaft, rack, other = d.shaft("shaft", inertia=0.01), d.mass("rack", mass=2.0), d.shaft("other", inertia=0.02)
    pinion = d.add(cw.RackPinion("pinion", shaft=shaft, mass=rack, teeth=20, module=0.003))
    assert pinion.exact_radius() == Fraction(3, 100)
    d.add(cw.Chain("chain", input=shaft, output=other, teeth_input=15, teeth_output=40))
    d.add(cw.Torque("t", shaft=shaft, torque=1.0))
    run = d.simulate(1.0)
    inertia = 0.01 + 2.0 * 0.03**2 + 0.02 * (15 / 40) ** 2
    assert run["shaft.speed"][-1] == pytest.approx(1.0 / inertia)
    assert run["rack.speed"][-1] == pytest.approx(0.03 / inertia)
    assert run["other.speed"][-1] == pytest.approx(15 / 40 / inertia)


@pytest.mark.parametrize("torque", [8.0, -8.0])
def test_losses_of_rack_and_chain(torque):
    """Accelerated by the shaft, and by the members that they drive: closed form of both directions of power."""
    for member in ("rack", "chain"):
        d = cw.Driveline("losses")
        shaft = d.shaft("shaft", inertia=0.01, speed=30.0)
        losses = {"efficiency": 0.9, "backward_efficiency": 0.8}
        if member == "rack":
            other = d.mass("other", mass=2.0, speed=0.9)
            gear = d.add(cw.RackPinion("gear", shaft=shaft, mass=other, radius=0.03, **losses))
            inertia, ratio = 2.0 * 0.03**2, 0.03
        else:
            other = d.shaft("other", inertia=0.02, speed=30.0 * 15 / 40)
            gear = d.add(cw.Chain("gear", input=shaft, output=other, teeth_input=15, teeth_output=40, **losses))
            inertia, ratio = 0.02 * (15 / 40) ** 2, 15 / 40
        heat = d.thermal("oil", capacity=100.0, temperature=300.0)
        # a torque at the shaft drives forward; a braking one makes the other side drive
        d.add(cw.Torque("t", shaft=shaft, torque=torque))
        run = d.simulate(0.02, rtol=1e-9)
        # the other side has its inertia by the efficiency of the direction of power
        seen = inertia / 0.9 if torque > 0 else inertia * 0.8
        assert run["shaft.speed"][-1] - 30.0 == pytest.approx(torque / (0.01 + seen) * 0.02, rel=1e-8), member
        assert run["other.speed"][-1] == pytest.approx(ratio * run["shaft.speed"][-1], rel=1e-9)
        assert run.energy.heat["gear"] > 0.0
        warm = {"rack": cw.RackPinion, "chain": cw.Chain}[member]
        values = {
            name: getattr(gear, name) for name in ("radius", "teeth_input", "teeth_output") if hasattr(gear, name)
        }
        ends = {"shaft": shaft, "mass": other} if member == "rack" else {"input": shaft, "output": other}
        d.add(warm("cold", **ends, **values, heat=heat))
        assert "heat is given without losses" in str(d.check()[0])


@pytest.mark.parametrize(
    ("kind", "values", "words"),
    [
        ("Ravigneaux", {"ratio_large": 2.0}, "ratio_small is missing; give `ratio_small`, or `teeth_small_sun` and"),
        ("Ravigneaux", {"ratio_large": 3.0, "ratio_small": 2.0}, "makes the ratios 3 and 2"),
        ("CompoundPlanetary", {"teeth_sun": 20}, "ratio is missing"),
        ("CompoundPlanetary", {"ratio": 3.0, "teeth_sun": 20}, "ratio is given twice"),
        (
            "CompoundPlanetary",
            {"teeth_sun": 20, "teeth_planet_sun": 20, "teeth_planet_ring": 30, "teeth_ring": 30},
            "teeth_ring is 30, not above teeth_planet_ring = 30",
        ),
        ("BevelGear", {"ratio": 0.0}, "ratio is zero"),
        ("RackPinion", {"teeth": 20}, "radius is missing"),
        ("RackPinion", {"teeth": 20, "radius": 0.1}, "radius is given twice"),
    ],
)
def test_mistakes(kind, values, words):
    d = cw.Driveline("mistakes")
    shafts = {name: d.shaft(name, inertia=1.0) for name in ("a", "b", "c", "e")}
    members = {
        "Ravigneaux": ("small_sun", "large_sun", "ring", "carrier"),
        "CompoundPlanetary": ("sun", "ring", "carrier"),
        "BevelGear": ("input", "output"),
        "RackPinion": ("shaft",),
    }[kind]
    joined = dict(zip(members, shafts.values(), strict=False))
    if kind == "RackPinion":
        joined["mass"] = d.mass("m", mass=1.0)
    d.add(getattr(cw, kind)("x", **joined, **values))
    assert words in str(d.check()[0])
