"""A sweep gives the bits of single runs, whatever varies, on any number of threads."""

from __future__ import annotations

import warnings
from typing import Any

import numpy as np
import pytest

import clutchwork as cw
from clutchwork.assembly.wiring import row_columns
from clutchwork.declare.core import core
from clutchwork.declare.schema import Role
from clutchwork.model.changes import all_names, named, target
from clutchwork.sweeps import batch
from clutchwork.sweeps.axes import Plan
from clutchwork.sweeps.parts import PARTS
from clutchwork.sweeps.variants import given
from support import random_drivelines, samples, six_speed
from support.amount import amount
from support.sweep import sweep as over_seeds

OPTIONS: dict[str, Any] = {"rtol": 1e-5, "atol": 1e-7}


def dense(system: cw.System, t_end: float, options: dict[str, Any]) -> np.ndarray:
    """Instants at which a run is looked at for extremes."""
    numbers = list(cw.Options(**options).core_options().items())
    choice, nothing = np.zeros((1, 1), dtype=np.int64), np.zeros(0, dtype=np.int64)
    _, _, _, parts, _ = core().sweep(
        [system.to_bytes()], [], choice, numbers, t_end, np.zeros(0), PARTS, nothing, False, 1, None
    )
    return parts[0][2]


def same(one: Any, other: Any) -> bool:
    """Equal in every bit, NaN included."""
    return np.asarray(one).tobytes() == np.asarray(other).tobytes()


def compared(system: cw.System, found: cw.Sweep, t_end: float, options: dict[str, Any], numbers: Any) -> str:
    """What of a sweep differs from single runs; "" where nothing does."""
    wrong = []
    for number in numbers:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            changed = system.changed(found.variant(number))
            run = cw.simulate(changed, t_end, **options)
            at = dense(changed, t_end, options)
            fine = run.at(at) if len(at) else run
        if found.status.reshape(-1)[number] != run.status or found.message(number) != run.message:
            wrong.append(f"{number}: {found.status.reshape(-1)[number]} {run.status} {found.message(number)}")
        for name, one in found.swept.outputs.items():
            expected = one.of(fine if name.startswith(("maximum", "minimum", "peak")) else run)
            if not same(found.flat(name)[number], expected):
                wrong.append(f"{number}: {name} is {found.flat(name)[number]}, not {expected}")
    return "; ".join(wrong)


def outputs(system: cw.System, t_end: float) -> list[Any]:
    """Outputs of all kinds."""
    node, other = system.nodes[0].name, system.nodes[-1].name
    made: list[Any] = [
        f"{node}.speed",
        cw.at(f"{other}.speed", [0.0, 0.3 * t_end, t_end]),
        cw.integral(f"{node}.speed"),
    ]
    for contact in system.contacts:
        c = contact.name
        made += [f"{c}.heat", f"{c}.state", cw.integral(f"{c}.power"), cw.peak(f"{c}.torque"), cw.lock(c)]
        made += [cw.lock(c, -1), cw.lock(c, 2), cw.break_away(c), cw.maximum(f"{c}.slip"), cw.minimum(f"{c}.slip")]
    return made


def test_six_speed_gearbox():
    system = six_speed.gearbox(six_speed.SHIFT).assemble()
    tables = [cw.Table([(0.0, 0.0), (2.0, 0.0), (2.0 + d, 0.25e6), (3.0, 0.6e6), (3.2, 2e6)]) for d in (0.1, 0.2)]
    vary = {
        "F1.pressure": [*tables, 0.0, cw.Ramp(height=2e6, duration=0.5, start=2.0)],
        "F2.friction.fast": [0.05, 0.065],
        "w1.inertia": [15.0, 19.37],
        "shaft.stiffness": [1e6, six_speed.STIFFNESS],
        "row1.ratio": [1.8, 1.83],
    }
    asked = [*outputs(system, 4.0), "shaft.twist", "row1.torque_sun", cw.peak("shaft.torque"), "housing.torque"]
    asked += [cw.peak("housing.torque"), cw.at("divider.torque_ring", [1.0, 2.5])]
    found = cw.sweep(system, 4.0, vary=vary, outputs=asked, threads=2)
    assert found.shape == (4, 2, 2, 2, 2)
    assert found.finished.all()
    assert compared(system, found, 4.0, {}, range(0, 64, 5)) == ""


@pytest.mark.random
def test_random_drivelines_random_names():
    def check(seed: int) -> str:
        rng = np.random.default_rng(seed)
        system = random_drivelines.describe(seed).driveline().assemble()
        names = [name for name in all_names(system.source) if not name.endswith(("locked", "points", "pressure"))]
        vary = {str(name): _values(system, str(name), rng) for name in rng.permutation(names)[:3]}
        vary = {name: values for name, values in vary.items() if values}
        t_end = random_drivelines.T_END
        asked = outputs(system, t_end)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            try:
                found = cw.sweep(system, t_end, vary=vary, outputs=asked, threads=2, **OPTIONS)
            except cw.ModelError as error:
                # static coefficients below kinetic ones
                return "" if any(word in str(error) for word in ("kinetic", "inside of", "heat_share")) else str(error)
        return compared(system, found, t_end, OPTIONS, {0, len(found) - 1, int(rng.integers(len(found)))})

    over_seeds(check, amount(40))


@pytest.mark.random
def test_what_no_output_reads_has_no_say():
    """Work and angles that nobody reads are left out: each output alone has the bits that it has beside all others."""

    def check(seed: int) -> str:
        system = random_drivelines.describe(seed).driveline().assemble()
        t_end, node = random_drivelines.T_END, system.nodes[0]
        asked = [
            *outputs(system, t_end),
            cw.peak(f"{node.name}.acceleration"),
            cw.squared_jerk(node.name),
        ]
        vary = {f"{node.name}.inertia": np.linspace(0.9, 1.1, 3) * (node.inertia or 1.0)}
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            whole = cw.sweep(system, t_end, vary=vary, outputs=asked, **OPTIONS)
            alone = [cw.sweep(system, t_end, vary=vary, outputs=[one], **OPTIONS) for one in asked]
        return ", ".join(name for one in alone for name in one.names if not same(one[name], whole[name]))

    over_seeds(check, amount(20))


def _values(system: cw.System, name: str, rng: np.random.Generator) -> list[float]:
    owner: Any = {t.name: t for t in (*system.nodes, *system.source.elements)}[name.split(".")[0]]
    for word in name.split(".")[1:]:
        owner = getattr(owner, word)
    if isinstance(owner, bool) or not isinstance(owner, int | float):
        return []
    return [float(owner or 0.1) * factor for factor in rng.uniform(0.95, 1.05, 2)]


@pytest.mark.parametrize("threads", [1, 2, 3, 8])
def test_any_number_of_threads(threads):
    system = six_speed.gearbox(six_speed.SHIFT).assemble()
    vary = {"F1.gain": np.linspace(0.2, 0.3, 9), "w8.inertia": [5.0, 6.0], "F4.gain": [0.17, 0.18]}
    asked = [*outputs(system, 4.0), cw.peak("shaft.torque")]
    one = cw.sweep(system, 4.0, vary=vary, outputs=asked, threads=1)
    some = cw.sweep(system, 4.0, vary=vary, outputs=asked, threads=threads)
    assert all(same(one[name], some[name]) for name in one.names)
    assert same(one.codes, some.codes)


def test_any_size_of_blocks(monkeypatch):
    system = six_speed.gearbox(six_speed.SHIFT).assemble()
    vary = {"F1.gain": np.linspace(0.2, 0.3, 5), "w8.inertia": [5.0, 6.0, 7.0]}
    asked = [*outputs(system, 4.0), cw.peak("shaft.torque")]
    one = cw.sweep(system, 4.0, vary=vary, outputs=asked)
    monkeypatch.setattr(batch, "MOST_VARIANTS", 4)
    some = cw.sweep(system, 4.0, vary=vary, outputs=asked)
    assert all(same(one[name], some[name]) for name in one.names)


def test_values_that_act_together():
    """Two fields of one thing, a tolerance and a band, both sides of a spring: each has the System of both."""
    d = cw.Driveline("x")
    a, b = d.shaft("a", inertia=1.0, speed=50.0), d.shaft("b", inertia=2.0)
    plates = d.thermal("plates", capacity=500.0)
    karnopp = cw.Karnopp(static=0.2, kinetic=0.1, speed=5.0, band=0.05)
    # without height the duration alone changes no slope
    force = cw.Ramp(height=0.0, duration=0.5)
    d.add(
        cw.Clutch("c", base=a, follower=b, friction=karnopp, gain=1.0, normal_force=force, heat=plates, heat_share=0.5)
    )
    d.add(cw.SpringDamper("k", base=d.housing, follower=b, stiffness=100.0, damping=0.1, initial_twist=0.0))
    system = d.assemble()
    vary = {
        "c.tolerance": [0.0, 0.05],
        "c.friction.band": [0.05, 0.2],
        "k.stiffness": [100.0, 200.0],
        "k.initial_twist": [0.0, 0.1],
        "c.normal_force.height": [100.0, 150.0],
        "c.normal_force.duration": [0.5, 0.7],
        "plates.capacity": [500.0, 400.0],
        "plates.temperature": [300.0, 350.0],
    }
    asked = [*outputs(system, 2.0), "plates.temperature", "c.temperature", "k.twist", cw.maximum("plates.temperature")]
    found = cw.sweep(system, 2.0, vary=vary, outputs=asked)
    plan = Plan.of(system, given(vary))
    bound = {one.name for one in plan.bound}
    together = ("c.normal_force.height", "c.normal_force.duration")
    assert bound == set(vary) - {"plates.capacity", "plates.temperature", *together}
    # numbers of one signal share an axis
    assert together in [axis.names for axis in plan.axes]
    assert compared(system, found, 2.0, {}, range(0, 256, 17)) == ""


def test_names_that_stand_alone_need_no_system_of_their_own():
    system = six_speed.gearbox(six_speed.SHIFT).assemble()
    table = cw.Table(six_speed.SHIFT["F1"])
    vary = {
        "F1.gain": [0.2, 0.3],
        "F1.friction.fast": [0.05, 0.06],
        "F1.friction.static": [0.15, 0.16],
        "F1.pressure": [table, cw.Table([(t, 0.9 * p) for t, p in six_speed.SHIFT["F1"]])],
        "F2.friction": [cw.Exponential(**six_speed.LAW), cw.Exponential(**{**six_speed.LAW, "fast": 0.07})],
        "F2.tolerance": [0.0, 0.1],
        "shaft.damping": [1000.0, 1500.0],
        "load.torque": [3000.0, 4000.0],
    }
    assert [one.name for one in Plan.of(system, given(vary)).bound] == ["F2.friction", "F2.tolerance"]
    found = cw.sweep(system, 4.0, vary=vary, outputs=outputs(system, 4.0))
    assert compared(system, found, 4.0, {}, range(0, 256, 37)) == ""


def test_composites():
    d = cw.Driveline("launch")
    engine, load = d.shaft("engine", inertia=0.2, speed=200.0), d.shaft("load", inertia=3.0)
    air = d.ambient("air", temperature=295.0)
    ramp = cw.Ramp(height=3e5, duration=1.0)
    c = d.add(
        cw.DiskClutch(
            "c", base=engine, follower=load, radius=0.1, area=1e-3, pressure=ramp, thermal_mass=500.0, drag=0.01
        )
    )
    d.add(cw.Convection("cooling", hot=c.plates, cold=air, conductance=20.0))
    system = d.assemble()
    vary = {"c.radius": [0.1, 0.12], "c.thermal_mass": [500.0, 800.0], "cooling.conductance": [10.0, 20.0]}
    asked = ["c.heat", "c.temperature", cw.maximum("c.temperature"), cw.lock("c"), cw.at("c.torque", [0.5, 1.0])]
    found = cw.sweep(system, 3.0, vary=vary, outputs=asked)
    assert compared(system, found, 3.0, {}, range(8)) == ""


def test_options_are_those_of_single_runs():
    system = six_speed.gearbox(six_speed.SHIFT).assemble()
    for options in ({"angles": False, "work": False}, {"method": "dopri5", "rtol": 1e-4}, {"max_step": 0.01}):
        found = cw.sweep(system, 3.0, vary={"F1.gain": [0.2, 0.3]}, outputs=["w8.speed", cw.lock("F1")], **options)
        assert compared(system, found, 3.0, options, range(2)) == ""


def test_settings_of_the_model():
    d = six_speed.gearbox(six_speed.SHIFT)
    d.simulation.update(t_end=2.5, rtol=1e-4, dt=0.1)
    found = cw.sweep(d, vary={"F1.gain": [0.2, 0.3]}, outputs="w8.speed")
    expected = [d.assemble().changed({"F1.gain": gain}) for gain in (0.2, 0.3)]
    assert found["w8.speed"].tolist() == [cw.simulate(system)["w8.speed"][-1] for system in expected]


@pytest.mark.parametrize("cls", samples.declared(*samples.ELEMENT_ROLES, Role.LAW), ids=lambda cls: cls.__name__)
@pytest.mark.filterwarnings("ignore::clutchwork.ModelWarning")
def test_words_of_every_number_are_those_of_the_changed_system(cls: type):
    """What follows from a number goes with it: initial states, tolerances, processes."""
    system = _with_law(samples.law(cls)) if issubclass(cls, cw.Law) else samples.driveline(cls).assemble()
    for name, value in _numbers(system):
        try:
            expected = system.changed({name: value}).to_bytes()
        except cw.ModelError:
            continue
        plan = Plan.of(system, given({name: [value]}))
        words = np.frombuffer(plan.systems(0, 1)[0][0].to_bytes(), np.uint64).copy()
        for axis in plan.axes:
            words[axis.place] = axis.words[0]
        assert words.tobytes() == expected, name


def _with_law(law: cw.Law) -> cw.System:
    d = cw.Driveline("law")
    a, b = d.shaft("a", inertia=1.0, speed=5.0), d.shaft("b", inertia=2.0)
    d.add(cw.Clutch("c", base=a, follower=b, friction=law, gain=1.0, normal_force=100.0))
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", cw.ModelWarning)
        return d.assemble()


def _numbers(system: cw.System) -> list[tuple[str, float]]:
    """Every name of a number, with a value near its own."""
    found = []
    for name in all_names(system.source):
        aim = target(named(system.source), name)
        value = aim.owner
        for word in aim.path:
            value = getattr(value, word)
        if isinstance(value, float):
            found.append((name, 1.01 * value if value else 0.1))
    return found


def test_what_follows_from_a_number():
    """A spring that starts twisted, and the band of Karnopp's law."""
    d = cw.Driveline("twisted")
    a, b = d.shaft("a", inertia=1.0, speed=50.0), d.shaft("b", inertia=1.0)
    d.add(cw.SpringDamper("k", base=a, follower=b, stiffness=10.0, initial_twist=0.3))
    karnopp = _with_law(cw.Karnopp(static=0.2, kinetic=0.1, speed=1.0, band=0.01))
    for system, vary in (
        (d.assemble(), {"k.stiffness": [10.0, 20.0, 40.0]}),
        (d.assemble(), {"k.initial_twist": [0.0, 0.3]}),
        (karnopp, {"c.friction.band": [0.01, 0.5, 3.0]}),
    ):
        found = cw.sweep(system, 1.0, vary=vary, outputs=["b.speed"])
        assert compared(system, found, 1.0, {}, range(len(found))) == ""


@pytest.mark.parametrize("other", ["k2.damping", "k2.stiffness"])
def test_a_shaft_that_loses_its_inertia(other: str):
    """Its springs are then in series, so that what was a number of its own is none any more."""
    d = cw.Driveline("series")
    a, g, e = (d.shaft(n, inertia=j, speed=w) for n, j, w in (("a", 1.0, 50.0), ("g", 0.5, 0.0), ("e", 3.0, 0.0)))
    d.add(cw.SpringDamper("k1", base=a, follower=g, stiffness=50.0, damping=0.5))
    d.add(cw.SpringDamper("k2", base=g, follower=e, stiffness=100.0, damping=0.1))
    system = d.assemble()
    vary = {"g.inertia": [0.5, 0.0], other: [0.1, 0.3]}
    found = cw.sweep(system, 1.0, vary=vary, outputs=["a.speed", "e.speed"])
    assert compared(system, found, 1.0, {}, range(len(found))) == ""


def rows_of(systems: list[cw.System], t_end: float, read: list[int], inside: list[int] | None) -> list[tuple[Any, ...]]:
    """Status, times and what is read of rows in steps of runs that go on together."""
    choice = np.arange(len(systems), dtype=np.int64).reshape(-1, 1)
    numbers = list(cw.Options(**OPTIONS).core_options().items())
    given = (np.zeros(0), PARTS, np.array(read, dtype=np.int64), False, 1, None)
    lean = None if inside is None else np.array(inside, dtype=np.int64)
    bytes_of = [system.to_bytes() for system in systems]
    status, _, _, ((which, counts, times, rows, _, ends),), _ = core().sweep(
        bytes_of, [], choice, numbers, t_end, *given, lean
    )
    cuts = np.cumsum(counts)[:-1]
    parts = zip(which.tolist(), np.split(times, cuts), np.split(rows, cuts), ends, strict=True)
    return sorted(((status[n].item(), n, *own) for n, *own in parts), key=lambda one: one[1])


READ_IN_LANES = ("speed", "acceleration", "state", "element_torque", "contact_torque", "input")


@pytest.mark.random
def test_rows_that_lanes_write_are_those_of_each_run():
    """Whatever is read of them, and whatever other numbers of rows are left out."""

    def check(seed: int) -> str:
        rng = np.random.default_rng(seed)
        system = random_drivelines.describe(seed).driveline().assemble()
        node, t_end = system.nodes[0], random_drivelines.T_END
        shares = [1.0, 1.0, *rng.uniform(0.98, 1.02, 6)]
        try:
            near = [system.changed({f"{node.name}.inertia": share * (node.inertia or 1.0)}) for share in shares]
        except cw.ModelError:
            return ""
        columns = row_columns(system.counts)
        known, work = (
            [at for name in names for at in range(columns[name].start, columns[name].stop)]
            for names in (READ_IN_LANES, ("element_work", "contact_work"))
        )
        inside = sorted(rng.permutation(known)[: rng.integers(1, len(known) + 1)].tolist())
        whole = rows_of(near, t_end, [*inside, *work], None)
        lean = rows_of(near, t_end, [*inside, *work], inside)
        for (status, number, times, rows, edges), (ended, _, at, found, both) in zip(whole, lean, strict=True):
            if status != ended or not same(times, at) or not same(rows[:, : len(inside)], found):
                return f"run {number} of {inside}"
            if not same(edges, both):
                return f"work of run {number}"
        return ""

    over_seeds(check, amount(60))


def test_a_lane_that_ends_leaves_the_others():
    """One grows beyond all numbers, one takes too many steps; the others have what they have alone."""
    d = cw.Driveline("eight")
    a, b = d.shaft("a", inertia=1e-3, speed=80.0), d.shaft("b", inertia=2.0)
    d.add(cw.Torque("motor", shaft=a, torque=1.0))
    coulomb = cw.Coulomb(static=0.2, kinetic=0.15)
    d.add(cw.Clutch("c", base=a, follower=b, friction=coulomb, gain=0.1, normal_force=40.0))
    system = d.assemble()
    torques = [0.1, 0.2, 1e307, 0.3, 0.4, 0.5, 0.6, 0.7]
    asked = [cw.peak("a.speed"), cw.peak("c.torque"), "c.heat", cw.lock("c"), cw.maximum("motor.torque"), "b.speed"]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        found = cw.sweep(system, 100.0, vary={"motor.torque": torques}, outputs=asked)
    assert found.finished.tolist() == [torque < 1.0 for torque in torques]
    assert compared(system, found, 100.0, {}, range(8)) == ""
