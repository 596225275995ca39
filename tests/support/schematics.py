"""Models to draw, and what is measured of a schematic: overlaps, crossings, lines that do not join."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import combinations

import numpy as np

import clutchwork as cw
from clutchwork.schematic.pen import Rect, Stroke, Text, around
from clutchwork.schematic.sheet import Sheet

LINING = cw.Coulomb(static=0.12, kinetic=0.1)


def car() -> cw.Driveline:
    """A car with a dual-mass flywheel, two ways through the gearbox and a differential: 30 elements."""
    d = cw.Driveline("rear-wheel drive car")
    inertia = {
        "crankshaft": 0.18, "flywheel": 0.12, "secondary mass": 0.05, "input shaft": 0.01, "layshaft": 0.008,
        "output shaft": 0.012, "propeller shaft": 0.02, "pinion": 0.004, "differential case": 0.04,
        "left half shaft": 0.01, "right half shaft": 0.01, "left wheel": 1.2, "right wheel": 1.2,
        "front wheels": 2.4, "alternator": 0.004,
    }  # fmt: skip
    n = {name: d.shaft(name, inertia=value) for name, value in inertia.items()}
    body = d.mass("body", mass=1500.0)
    housing, air = d.thermal("clutch housing", capacity=9000.0), d.ambient("ambient air", temperature=293.0)
    points = [(0.0, 0.0), (100.0, 150.0), (400.0, 180.0), (650.0, 120.0)]
    d.add(cw.SpeedTorque("combustion", shaft=n["crankshaft"], torque=points))
    d.add(cw.BearingFriction("bearings", shaft=n["crankshaft"], friction=LINING, torque=40.0))
    d.add(cw.Spring("crank torsion", base=n["crankshaft"], follower=n["flywheel"], stiffness=2e5))
    ends = {"base": n["flywheel"], "follower": n["secondary mass"]}
    d.add(cw.SpringDamper("dual mass", **ends, stiffness=1200.0, damping=5.0))
    d.add(cw.Gear("belt", input=n["crankshaft"], output=n["alternator"], ratio=0.4))
    d.add(cw.LinearTorque("generator", shaft=n["alternator"], nominal_torque=-4.0, nominal_speed=500.0))
    force = [(0.0, 5000.0), (4e-3, 2500.0), (8e-3, 0.0)]
    pedal = d.add(cw.DiaphragmSpring("diaphragm", force=force, travel=0.0))
    clutch = cw.DiskClutch(
        "main clutch", base=n["secondary mass"], follower=n["input shaft"], outer_diameter=0.24,
        inner_diameter=0.16, surfaces=2, normal_force=pedal, thermal_mass=2000.0,
    )  # fmt: skip
    d.add(clutch)
    d.add(cw.Gear("first gear", input=n["input shaft"], output=n["layshaft"], ratio=-1.8))
    d.add(cw.Gear("second pair", input=n["layshaft"], output=n["output shaft"], ratio=-1.9))
    ends = {"base": n["input shaft"], "follower": n["output shaft"]}
    d.add(cw.DogClutch("direct dog", **ends, teeth=24, gap=0.02, stiffness=1e5, command=0.0))
    ends = {"base": n["output shaft"], "follower": n["propeller shaft"]}
    d.add(cw.SpringDamper("joint disc", **ends, stiffness=8000.0, damping=8.0))
    d.add(cw.Spring("shaft torsion", base=n["propeller shaft"], follower=n["pinion"], stiffness=3e4))
    teeth = {"teeth_input": 11, "teeth_output": 41}
    d.add(cw.Gear("final drive", input=n["pinion"], output=n["differential case"], **teeth))
    halves = {"sun": n["left half shaft"], "ring": n["right half shaft"], "carrier": n["differential case"]}
    d.add(cw.Planetary("differential", **halves, ratio=1.0))
    ends = {"base": n["left half shaft"], "follower": n["right half shaft"]}
    d.add(cw.Clutch("limited slip", **ends, friction=LINING, gain=0.1, normal_force=500.0))
    for side in ("left", "right"):
        ends = {"base": n[f"{side} half shaft"], "follower": n[f"{side} wheel"]}
        d.add(cw.SpringDamper(f"{side} shaft", **ends, stiffness=9e3, damping=40.0))
    for name, wheel in (("left", "left wheel"), ("right", "right wheel"), ("front", "front wheels")):
        d.add(cw.RollingWheel(f"{name} tyre", shaft=n[wheel], mass=body, radius=0.31))
        d.add(cw.DiskBrake(f"{name} brake", shaft=n[wheel], friction=LINING, radius=0.12, bore=0.05, pressure=0.0))
    d.add(cw.ResistingTorque("rolling", shaft=body, torque=200.0, speed=0.05))
    d.add(cw.QuadraticTorque("air drag", shaft=body, nominal_torque=-400.0, nominal_speed=30.0))
    d.add(cw.Torque("slope", shaft=body, torque=-700.0))
    d.add(cw.Torque("towing", shaft=body, torque=-100.0))
    d.add(cw.Conduction("to housing", hot=clutch.part("plates"), cold=housing, conductance=30.0))
    over = [(0.0, 5.0), (500.0, 20.0)]
    d.add(cw.Convection("cooling", hot=housing, cold=air, conductance=over, speed=n["propeller shaft"]))
    return d


def manual() -> cw.Driveline:
    """A gearbox with four gears, two synchronisers and an actuator."""
    d = cw.Driveline("manual gearbox")
    engine, shaft = d.shaft("engine", inertia=0.2, speed=90.0), d.shaft("input", inertia=0.02)
    lay, out = d.shaft("layshaft", inertia=0.01), d.shaft("output", inertia=0.03)
    gears = [d.shaft(f"gear {k}", inertia=0.004) for k in (1, 2, 3, 4)]
    d.add(cw.Torque("combustion", shaft=engine, torque=120.0))
    valve = d.add(cw.PressureActuator("valve", command=4e5, lag=0.05))
    d.add(cw.Clutch("clutch", base=engine, follower=shaft, friction=LINING, gain=2e-3, pressure=valve))
    d.add(cw.Gear("constant mesh", input=shaft, output=lay, ratio=-1.4))
    for k, (gear, ratio) in enumerate(zip(gears, (-2.6, -1.5, -1.0, -0.8), strict=True), 1):
        d.add(cw.Gear(f"pair {k}", input=lay, output=gear, ratio=ratio))
    for k, command in ((0, 1.0), (2, 0.0)):
        values = {"friction": LINING, "force": 800.0, "radius": 0.05, "half_angle": 0.12, "command": command}
        ends = {"hub": out, "forward": gears[k], "backward": gears[k + 1]}
        d.add(cw.Synchroniser(f"sleeve {k + 1}/{k + 2}", **ends, **values))
    d.add(cw.ResistingTorque("road", shaft=out, torque=40.0, speed=1.0))
    return d


def eight_speed() -> cw.Driveline:
    """An automatic gearbox with four planetary sets and five clutches and brakes."""
    d = cw.Driveline("eight-speed gearbox")
    names = ("input", "S1 S2", "R1", "C1 R4", "R2 S3", "R3 S4", "C3", "output")
    w = {name: d.shaft(name, inertia=0.02) for name in names}
    sets = (
        ("P1", "S1 S2", "R1", "C1 R4", 48, 96), ("P2", "S1 S2", "R2 S3", "input", 48, 96),
        ("P3", "R2 S3", "R3 S4", "C3", 69, 111), ("P4", "R3 S4", "C1 R4", "output", 23, 85),
    )  # fmt: skip
    for name, sun, ring, carrier, small, large in sets:
        teeth = {"teeth_sun": small, "teeth_ring": large}
        d.add(cw.Planetary(name, sun=w[sun], ring=w[ring], carrier=w[carrier], **teeth))
    pressed = {"friction": LINING, "gain": 1e-3, "pressure": 1e6}
    for name, shaft in (("A", "S1 S2"), ("B", "R1")):
        d.add(cw.Brake(name, shaft=w[shaft], **pressed))
    for name, base, follower in (("C", "input", "R3 S4"), ("D", "C3", "output"), ("E", "R2 S3", "R3 S4")):
        d.add(cw.Clutch(name, base=w[base], follower=w[follower], **pressed))
    d.add(cw.Torque("turbine", shaft=w["input"], torque=200.0))
    d.add(cw.ResistingTorque("road", shaft=w["output"], torque=100.0, speed=1.0))
    return d


def tangle(seed: int) -> cw.Driveline:
    """Shafts that clutches and planetary sets join at random, in one part or several."""
    rng = np.random.default_rng(seed)
    d = cw.Driveline(f"tangle {seed}")
    n = [d.shaft(f"s{k}", inertia=0.1) for k in range(int(rng.integers(4, 13)))]
    d.add(cw.Torque("drive", shaft=n[0], torque=1.0))
    d.add(cw.ResistingTorque("load", shaft=n[-1], torque=1.0, speed=1.0))
    for k in range(int(rng.integers(6, 22))):
        a, b, c = (n[int(place)] for place in rng.choice(len(n), 3, replace=False))
        if rng.random() < 0.4:
            d.add(cw.Planetary(f"p{k}", sun=a, ring=b, carrier=c, ratio=2.0))
        else:
            d.add(cw.Clutch(f"c{k}", base=a, follower=b, friction=LINING, gain=1.0, pressure=1.0))
    return d


def overlaps(sheet: Sheet, rim: float = 0.3) -> list[str]:
    """What lies on something else: text and symbols of different things, text and lines, lines and symbols."""
    found = []
    symbols = [(piece.name, around(piece.marks)) for piece in sheet.pieces]
    texts = [(piece.name, text.text, text.box) for piece in sheet.pieces for text in piece.text]
    for (one, a), (two, b) in combinations(symbols, 2):
        if a.overlaps(b, rim):
            found.append(f"symbols of {one} and {two}")
    for (one, word, a), (two, other, b) in combinations(texts, 2):
        if a.overlaps(b, rim):
            found.append(f"{word!r} of {one} and {other!r} of {two}")
    for one, word, a in texts:
        found += [f"{word!r} of {one} and the symbol of {two}" for two, b in symbols if a.overlaps(b, rim)]
        found += [f"{word!r} of {one} and a line of {node}" for node, b in _lines(sheet) if a.overlaps(b, 0.0)]
        found += [f"{word!r} of {one} and a link" for mark in sheet.links if a.overlaps(_thick(mark.box), 0.0)]
    for node, line in _lines(sheet):
        # ends of lines touch the symbols that they belong to
        found += [f"a line of {node} and the symbol of {two}" for two, b in symbols if line.overlaps(b, 1.0)]
    return found


def _lines(sheet: Sheet) -> Iterator[tuple[str, Rect]]:
    for wire in sheet.wires:
        for piece in wire.pieces:
            yield wire.node, _thick(Stroke(piece, False, wire.look).box)


def _thick(box: Rect) -> Rect:
    return Rect(box.left - 0.6, box.low - 0.6, box.right + 0.6, box.high + 0.6)


def crossings(sheet: Sheet) -> int:
    """How often a line of one node crosses one of another."""
    pieces = [(number, piece) for number, wire in enumerate(sheet.wires) for piece in wire.pieces]
    found = 0
    for (one, a), (two, b) in combinations(pieces, 2):
        if sheet.wires[one].node == sheet.wires[two].node:
            continue
        for flat, upright in ((a, b), (b, a)):
            (x1, y1), (x2, y2) = flat
            (x3, y3), (x4, y4) = upright
            is_cross = y1 == y2 and x3 == x4
            found += is_cross and min(x1, x2) < x3 < max(x1, x2) and min(y3, y4) < y1 < max(y3, y4)
    return found


def on_each_other(sheet: Sheet) -> list[str]:
    """Lines of two nodes that run along each other."""
    pieces = [(wire.node, _thick(Stroke(p, False, wire.look).box), p) for wire in sheet.wires for p in wire.pieces]
    return [
        f"{one} and {two}"
        for (one, a, p), (two, b, q) in combinations(pieces, 2)
        if one != two and (p[0][1] == p[1][1]) == (q[0][1] == q[1][1]) and a.overlaps(b, 0.0) and _long(a, b)
    ]


def _long(a: Rect, b: Rect) -> bool:
    wide = min(a.right, b.right) - max(a.left, b.left)
    tall = min(a.high, b.high) - max(a.low, b.low)
    return max(wide, tall) > 2.0


def texts(sheet: Sheet) -> list[str]:
    """All that is written."""
    return [mark.text for mark in sheet.marks if isinstance(mark, Text)]


def circuit(*, suction: bool = True) -> cw.Driveline:
    """Two lines of a pump, a valve with three volumes, an accumulator, a clutch with its piston."""
    d = cw.Driveline("circuit")
    motor, load = d.shaft("motor", inertia=0.3, speed=180.0), d.shaft("load", inertia=0.25)
    d.add(cw.Torque("drive", shaft=motor, torque=60.0))
    tank, line, port, back = (d.add(cw.OilVolume(name, volume=1e-4)) for name in ("tank", "line", "port", "back"))
    oil = d.add(cw.HydraulicOil("oil", temperature=353.15, viscosity_40=32e-6, viscosity_100=6.2e-6))
    store = d.add(cw.Accumulator("store", precharge=6e5, capacity=3e-4))
    d.add(cw.Orifice("filter", inlet=0.0, outlet=tank, area=2e-4, viscosity=(oil, "viscosity")))
    d.add(cw.Orifice("pipe", inlet=line, outlet=store, area=1e-5))
    d.add(cw.Orifice("return", inlet=back, area=1e-4))
    d.add(cw.Pump("pump", shaft=motor, inlet=tank if suction else 0.0, outlet=line, displacement=1.6e-5))
    d.add(cw.ReliefValve("regulator", inlet=line, outlet=tank, command=1.2e6, area=4e-5))
    areas = {"supply_area": 2e-5, "exhaust_area": 2e-5}
    d.add(cw.SpoolValve("valve", supply=line, clutch=port, exhaust=back, command=3e5, **areas))
    spring = {"preload": 400.0, "spring_rate": 1.5e5, "kiss_stroke": 2e-3, "contact_rate": 2e7}
    piston = d.add(cw.ClutchActuator("piston", supply_pressure=port, orifice_area=4e-6, piston_area=6e-3, **spring))
    d.add(cw.Clutch("clutch", base=motor, follower=load, friction=LINING, gain=0.5, normal_force=piston))
    return d
