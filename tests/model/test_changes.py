"""System.changed: what assembling the driveline with other numbers gives, bit for bit."""

from __future__ import annotations

import copy
import dataclasses
import pickle
import warnings
from collections.abc import Mapping
from typing import Any

import numpy as np
import pytest

import clutchwork as cw
from clutchwork.assembly import changes as quick_changes
from clutchwork.assembly.wiring import wiring
from clutchwork.declare.node import Law, Signal
from clutchwork.declare.schema import REGISTRY, Role, Spec, specs
from clutchwork.elements.bases.shift_elements import LINING
from clutchwork.model.changes import FIXED, PLACES, Renewed, all_names, field_of, named, target
from clutchwork.results.channels import Channels
from support import random_drivelines, samples, six_speed
from support.amount import amount
from support.sweep import sweep

NODE_WORDS = {"rotation": PLACES, "translation": ("mass", "speed", "position")}


def built(model: Mapping[str, Any]) -> cw.System:
    """The System of the content of a model file."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", cw.ModelWarning)
        return cw.Driveline.from_dict(model).assemble()


def edited(model: Mapping[str, Any], changes: dict[str, Any]) -> dict[str, Any]:
    """The content of a model file with other values, found by name."""
    made = copy.deepcopy(dict(model))
    things = {thing["name"]: thing for sort in made.values() if isinstance(sort, list) for thing in sort}
    for name, value in changes.items():
        owner = max((known for known in things if name.startswith(f"{known}.")), key=len)
        *between, last = name.removeprefix(f"{owner}.").split(".")
        place, between, last = _held(things[owner], between, last)
        for word in between:
            if word not in place:
                place[word] = _default(place["type"], word) if "type" in place else _law(LINING)
            place = place[word]
        place[last] = value
    return made


def _held(place: dict[str, Any], between: list[str], last: str) -> tuple[dict[str, Any], list[str], str]:
    """The table in which a value stands: of a part that an element holds it is one inside of that."""
    if place.get("type") != "transmission" or not between:
        return place, between, last
    part, *rest = between
    if part in place["gearbox"]["elements"]:
        return place.setdefault("shift", {}).setdefault(part, {}), rest, last
    return place.setdefault({"inertia": "inertias", "speed": "speeds"}[last], {}), [], part


def _default(kind: str, word: str) -> dict[str, Any]:
    """A law that a model file leaves out, which is that of the declaration."""
    cls = next(known[kind] for role, known in REGISTRY.items() if role is not Role.LAW and kind in known)
    return _law(next(item.default for item, _ in specs(cls, "law") if item.name == word))


def _law(law: Any) -> dict[str, Any]:
    return {"type": law.kind} | {item.name: getattr(law, item.name) for item, _ in specs(type(law), "param")}


def differences(one: cw.System, other: cw.System) -> str:
    """What of two Systems differs, their models included; "" where nothing does."""
    found = [name for name, array in one.arrays.items() if array.tobytes() != other.arrays[name].tobytes()]
    plain = ("name", "counts", "places", "notes", "warnings", "independent", "sums", "links", "nodes", "model")
    found += [name for name in plain if getattr(one, name) != getattr(other, name)]
    found += ["bytes"] if one.to_bytes() != other.to_bytes() else []
    found += ["inputs"] if [*map(said, one.inputs)] != [*map(said, other.inputs)] else []
    # lists here may be tuples there
    groups = ("elements", "contacts", "motions", "thermal", "flows", "processes")
    found += [
        group for group in groups if [*map(plainly, getattr(one, group))] != [*map(plainly, getattr(other, group))]
    ]
    gears = [[(row.gear.name, row.ports) for row in made.gears] for made in (one, other)]
    found += ["gears"] if gears[0] != gears[1] else []
    return ", ".join([*found, *signals_apart(one, other)])


def signals_apart(one: cw.System, other: cw.System) -> list[str]:
    """Signals that two Systems read from one and the same rows differently."""
    made, expected = Channels(wiring(one)), Channels(wiring(other))
    if list(made) != list(expected):
        return ["names of signals"]
    rows = np.random.default_rng(5).integers(0, 2, (7, wiring(one).row_size)) * 1.5
    return [n for n in made if made[n].evaluate(rows).tobytes() != expected[n].evaluate(rows).tobytes()]


def said(item: Any) -> tuple[Any, ...]:
    """An input in plain values."""
    return item.name, item.unit, item.signal.segments(), item.signal.repeats()


def plainly(value: Any) -> Any:
    """A declared object as its values, all of them in tuples."""
    if dataclasses.is_dataclass(value):
        return type(value), *(plainly(getattr(value, item.name)) for item in dataclasses.fields(value))
    return tuple(map(plainly, value)) if isinstance(value, list | tuple) else value


def other_value(value: Any, spec: Any, rng: np.random.Generator) -> Any:
    """Another value of a field that is likely to be allowed, None where there is none."""
    factor = float(rng.uniform(1.01, 1.4))
    if isinstance(value, bool) or getattr(spec, "flag", False):
        return not value
    if getattr(spec, "choices", ()):
        return str(rng.choice(spec.choices))
    if isinstance(value, int) and getattr(spec, "whole", False):
        return value + 1
    if isinstance(value, int | float):
        return factor * value or factor * 0.1
    if isinstance(value, Signal):
        return cw.Ramp(height=factor, duration=0.5)
    if spec is not None and spec.what == "curve":
        return [[x, factor * y] for x, y in value] if isinstance(value, list | tuple) else None
    return None


def random_changes(driveline: cw.Driveline, rng: np.random.Generator, most: int) -> dict[str, Any]:
    """Some values of a driveline, by name."""
    model, made = driveline._model, dict[str, Any]()
    names = list(all_names(model))
    for name in rng.permutation(names)[:most]:
        aim = target(named(model), str(name))
        assert aim is not None
        thing = aim.owner
        for item in aim.path[:-1]:
            thing = getattr(thing, item)
        value = getattr(thing, aim.path[-1])
        spec = next((s for item, s in specs(type(thing)) if item.name == aim.path[-1]), None)
        new = other_value(value, spec, rng)
        outer = any(str(name).startswith(f"{other}.") or other.startswith(f"{name}.") for other in made)
        if new is not None and not outer:
            made[str(name)] = new
    return made


def in_file(value: Any) -> Any:
    """A value as a model file has it."""
    if isinstance(value, cw.Ramp):
        return {"type": "ramp", "height": value.height, "duration": value.duration}
    return value


def compared(driveline: cw.Driveline, changes: dict[str, Any]) -> str:
    """What differs between changed numbers and a driveline with them; mistakes must be mistakes of both."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", cw.ModelWarning)
        # from the content of a file too, so that both hold their tables in lists
        system = built(driveline.assemble().model)
        before = system.to_bytes()
        expected = wrong = None
        try:
            expected = built(edited(system.model, {name: in_file(value) for name, value in changes.items()}))
        except cw.ModelError as error:
            wrong = error
        try:
            made = system.changed(changes)
        except cw.ModelError as error:
            return "" if wrong or "speeds independent" in str(error) else f"{changes}: refused: {error}"
        if wrong:
            return f"{changes}: taken, but {wrong}"
        assert expected is not None
        rest = differences(made, expected)
        touched = system.to_bytes() != before
    return f"{changes}: {rest}{' and the old one changed' if touched else ''}" if rest or touched else ""


@pytest.mark.parametrize(("kind", "changes"), [
    ("mesh", {"x.ratio": 3.1}), ("rack_mesh", {"x.radius": 0.4}), ("limited_slip", {"x.preload": 3.0}),
])  # fmt: skip
def test_the_row_of_a_contact_in_a_mesh(kind, changes):
    assert compared(samples.driveline(REGISTRY[Role.CONTACT][kind]), changes) == ""


@pytest.mark.parametrize("cls", samples.declared(*samples.ELEMENT_ROLES), ids=lambda cls: cls.kind)
def test_every_value_of_every_element(cls):
    driveline = samples.driveline(cls)
    rng = np.random.default_rng(1)
    found = list[str]()
    for name in all_names(driveline._model):
        for _ in range(20):
            changes = random_changes(driveline, rng, 1)
            if changes.keys() == {name}:
                break
        found += [text for text in [compared(driveline, changes)] if text]
    for _ in range(5):
        found += [text for text in [compared(driveline, random_changes(driveline, rng, 4))] if text]
    assert not found, "\n".join(found)


def out_of_bounds(spec: Spec) -> list[Any]:
    """Values that a declaration of a number forbids."""
    if spec.choices or spec.flag:
        return ["no such choice"]
    fractions = [2.5] if spec.whole else []
    beyond = [bound for bound in (spec.above, spec.below) if bound is not None]
    below = [bound - 1 for bound in (spec.at_least,) if bound is not None]
    return [*fractions, *beyond, *below, *(bound + 1 for bound in (spec.at_most,) if bound is not None), np.nan, "much"]


def refusal(make: Any, *args: Any) -> list[tuple[str, str]]:
    """What is said of values that are wrong."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", cw.ModelWarning)
            make(*args)
    except cw.ModelError as error:
        return [(problem.message, problem.remedy) for problem in error.problems]
    return []


@pytest.mark.parametrize("cls", samples.declared(*samples.ELEMENT_ROLES), ids=lambda cls: cls.kind)
def test_values_out_of_their_bounds_are_refused_as_by_the_driveline(cls):
    system = built(samples.driveline(cls).assemble().model)
    found = list[str]()
    for name in all_names(system.source):
        value, spec = field_of(target(named(system.source), name))
        for wrong in out_of_bounds(spec) if spec.what in ("param", "option") else ():
            expected = refusal(built, edited(system.model, {name: wrong}))
            said_of = refusal(system.changed, {name: wrong})
            # a file that is read says of strings that they are no unit before it looks at the value
            if not said_of or not set(said_of) <= set(expected):
                found.append(f"{name} = {wrong!r} in place of {value!r}: {said_of}, not {expected}")
    assert not found, "\n".join(found)


@pytest.mark.parametrize("cls", samples.declared(Role.LAW), ids=lambda cls: cls.kind)
def test_every_value_of_every_law(cls):
    def driveline():
        d = cw.Driveline("law")
        plates = d.thermal("plates", capacity=500.0)
        kinds = {item.name for item, spec in specs(cls, "signal") if spec.unit == "K"}
        law = cls(**samples.fields(cls, {}))
        d.add(cw.Brake("x", shaft=d.shaft("a", inertia=1.0), friction=law, gain=1.0, normal_force=2.0, heat=plates))
        assert not kinds or d.check() == []
        return d

    rng = np.random.default_rng(2)
    found = [compared(driveline(), random_changes(driveline(), rng, count)) for count in (1, 1, 1, 2, 2, 3, 4, 5)]
    assert not any(found), "\n".join(found)


@pytest.mark.parametrize("kind", [kind for kind in REGISTRY[Role.SIGNAL] if kind not in ("sampled", "column")])
def test_every_value_of_every_signal(kind):
    cls = REGISTRY[Role.SIGNAL][kind]
    d = cw.Driveline("signal")
    values = samples.fields(cls, {}) | ({"period": 1.0} if kind == "pulse" else {})
    d.add(cw.Torque("t", shaft=d.shaft("a", inertia=1.0), torque=cls(**values)))
    rng = np.random.default_rng(3)
    found = [compared(d, random_changes(d, rng, count)) for count in (1, 1, 1, 1, 2, 3)]
    assert not any(found), "\n".join(found)


@pytest.mark.random
def test_random_drivelines():
    def check(seed: int) -> str:
        d = random_drivelines.describe(seed).driveline()
        rng = np.random.default_rng(seed)
        return compared(d, random_changes(d, rng, int(rng.integers(1, 6))))

    sweep(check, amount(60))


@pytest.mark.parametrize(
    "stop",
    [
        lambda a, b: cw.Backlash("x", base=a, follower=b, gap=0.01),
        lambda a, b: cw.EndStop("x", base=a, follower=b, lower=-0.1, upper=0.1),
    ],
)
def test_where_a_stop_is_at_the_start(stop):
    d = cw.Driveline("play")
    made = d.add(stop(d.shaft("a", inertia=1.0), d.shaft("b", inertia=1.0)))
    name = next(item.name for item, _ in specs(type(made), "option") if item.name.startswith("initial"))
    assert compared(d, {f"x.{name}": 0.002}) == ""
    assert d.assemble().changed({f"x.{name}": 0.002}).initial_state.tolist() == [0.002]


@pytest.mark.random
def test_speeds_at_the_start_that_were_not_given():
    """They are refused where assembling refuses them, and answer on straight lines in all Systems of the same model."""

    def check(seed: int) -> str:
        d = random_drivelines.describe(seed).driveline()
        rng = np.random.default_rng(seed)
        names = [f"{node.name}.speed" for node in d.nodes]
        some = rng.choice(names, min(len(names), int(rng.integers(1, 3))), replace=False).tolist()
        return compared(d, {name: float(rng.uniform(-50.0, 50.0)) for name in some})

    sweep(check, amount(40))


def test_a_speed_at_the_start_is_not_assembled_anew(monkeypatch: pytest.MonkeyPatch) -> None:
    """Shafts follow a gear; one of which an element makes more, such as a force of weights, is looked at as a whole."""
    d = cw.Driveline("pair")
    a, b, drum = d.shaft("a", inertia=1.0), d.shaft("b", inertia=2.0), d.shaft("drum", inertia=1.0)
    d.add(cw.Gear("g", input=a, output=b, ratio=-3.0))
    system = d.assemble()
    system.changed({"b.speed": 1.0})
    with monkeypatch.context() as patch:
        patch.setattr(quick_changes, "anew", None)
        made = system.changed({"b.speed": 2.0})
    assert system.basis @ made.initial_speed == pytest.approx([-6.0, 2.0, 0.0])
    assert next(node.speed for node in made.nodes if node.name == "b") == 2.0
    law = cw.Coulomb(static=0.3, kinetic=0.3)
    size = {"mass": 0.1, "radius": 0.05, "drum_radius": 0.06, "onset": 100.0}
    d.add(cw.CentrifugalClutch("weights", base=b, follower=drum, friction=law, **size))
    assert compared(d, {"b.speed": 200.0}) == ""
    with pytest.raises(cw.ModelError, match="contradicts"):
        system.changed({"b.speed": 1.0, "a.speed": 1.0})


@pytest.mark.random
def test_six_speed_gearbox():
    def check(seed: int) -> str:
        d = six_speed.gearbox(six_speed.SHIFT)
        rng = np.random.default_rng(seed)
        return compared(d, random_changes(d, rng, int(rng.integers(1, 6))))

    sweep(check, amount(40))


def test_new_elements_are_on_the_shafts_of_their_system():
    """Where a model holds lists, its source is a copy with shafts of its own."""
    system = six_speed.gearbox(six_speed.SHIFT).assemble()
    for changes in ({"F1.gain": 0.3}, {"F1.friction.fast": 0.06}, {"F1.gain": 0.3, "w1.speed": 1.0}):
        made = system.changed(changes)
        assert signals_apart(made, system) == []
        assert all(any(contact.follower is node for node in made.nodes) for contact in made.contacts)


def test_what_refers_to_what_is_changed():
    d = cw.Driveline("clutch with its heat and wear")
    engine, load = d.shaft("engine", inertia=0.2, speed=100.0), d.shaft("load", inertia=0.8)
    air = d.ambient("air", temperature=295.0)
    c = d.add(
        cw.DiskClutch(
            "c", base=engine, follower=load, radius=0.1, area=1e-3, pressure=1e5, thermal_mass=500.0, wear_rate=1e-12
        )
    )
    d.add(cw.Convection("cooling", hot=c.plates, cold=air, conductance=20.0))
    piston = d.add(cw.PressureActuator("piston", command=2e5, lag=0.1))
    d.add(cw.Brake("b", shaft=load, friction=cw.Coulomb(static=0.2, kinetic=0.1), gain=1e-4, pressure=piston))
    for changes in (
        {"c.thermal_mass": 700.0},
        {"c.initial_temperature": 310.0, "cooling.conductance": 30.0},
        {"engine.inertia": 0.3, "air.temperature": 280.0},
        {"piston.lag": 0.2, "c.radius": 0.12, "load.speed": 5.0},
        {"c.drag": 0.1},
    ):
        assert compared(d, changes) == ""


def test_changes_add_up_and_settings_stay():
    d = six_speed.gearbox(six_speed.SHIFT)
    d.simulation["t_end"] = 3.0
    system = d.assemble()
    once = system.changed({"F1.gain": 0.3, "w1.inertia": 20.0})
    twice = system.changed({"F1.gain": 0.3}).changed({"w1.inertia": 20.0})
    assert differences(once, twice) == ""
    assert once.settings == system.settings
    assert system.params[system.places["F1.gain"]] == six_speed.GAIN["F1"]
    assert differences(pickle.loads(pickle.dumps(once)), once) == ""
    assert once.changed({}).to_bytes() == once.to_bytes()


def test_independent_speeds_that_were_asked_for_stay():
    d = cw.Driveline("x")
    a, b = d.shaft("a", inertia=1.0), d.shaft("b", inertia=9.0)
    d.add(cw.Gear("g", input=a, output=b, ratio=2.0))
    assert d.assemble().changed({"a.inertia": 20.0}).independent == ("a",)
    assert d.assemble(independent=("b",)).changed({"a.inertia": 20.0}).independent == ("b",)
    assert d.assemble(independent=("a",)).changed({"g.ratio": 3.0}).independent == ("a",)


def test_all_mistakes_at_once():
    system = six_speed.gearbox(six_speed.SHIFT).assemble()
    with pytest.raises(cw.ModelError) as caught:
        system.changed({"F1.gian": 1.0, "F2.gain": -1.0, "row1.sun": 3, "F1.friction.static": 0.01, 7: 1.0})
    text = str(caught.value)
    assert "did you mean 'F1.gain'?" in text
    assert 'cw.Clutch("F2"): gain = -1.0 m3: must be > 0 m3' in text
    assert "row1.sun: is not a number; build another driveline for it" in text
    assert "friction.static = 0.01: is below the kinetic coefficient at vanishing slip" in text
    assert len(caught.value.problems) == 5


def test_a_value_and_what_is_inside_of_it():
    system = six_speed.gearbox(six_speed.SHIFT).assemble()
    with pytest.raises(cw.ModelError, match=r"F1\.friction\.fast: is inside of 'F1\.friction', which is changed too"):
        system.changed({"F1.friction.fast": 0.1, "F1.friction": cw.Coulomb(static=0.2, kinetic=0.1)})


def test_a_ratio_that_makes_rows_dependent():
    d = cw.Driveline("two ways round")
    a, b, c, e = (d.shaft(name, inertia=1.0) for name in "abce")
    d.add(cw.Planetary("p", sun=a, ring=b, carrier=c, ratio=2.0))
    d.add(cw.Planetary("q", sun=a, ring=b, carrier=e, ratio=3.0))
    d.add(cw.Gear("g", input=c, output=e, ratio=1.0))
    with pytest.raises(
        cw.ModelError, match=r"q\.ratio: makes \d speeds independent, where \d were; build a new driveline"
    ):
        d.assemble().changed({"q.ratio": 2.0})


def test_a_ratio_that_holds_shafts_or_frees_them():
    d = cw.Driveline("two gears")
    a, b = d.shaft("a", inertia=1.0), d.shaft("b", inertia=1.0)
    d.add(cw.Gear("g1", input=a, output=b, ratio=2.0))
    d.add(cw.Gear("g2", input=a, output=b, ratio=2.0))
    with pytest.raises(cw.ModelError, match="contradict each other"):
        d.assemble().changed({"g2.ratio": 3.0})
    with pytest.raises(cw.ModelError, match="contradict each other"):
        d.assemble().changed({"a.inertia": 2.0, "g1.ratio": 3.0})


def test_bytes_have_no_names():
    system = cw.System.from_bytes(six_speed.gearbox(six_speed.SHIFT).assemble().to_bytes())
    with pytest.raises(cw.ModelError, match="no names for its numbers, because it was made from bytes"):
        system.changed({"F1.gain": 1.0})


def test_new_warnings_are_given_once():
    d = cw.Driveline("x")
    d.add(cw.Torque("t", shaft=d.shaft("a", inertia=1.0), torque=1.0))
    d.thermal("plates", capacity=100.0, temperature=300.0)
    system = d.assemble()
    with pytest.warns(cw.ModelWarning, match="did you mean 293"):
        cold = system.changed({"plates.temperature": 20.0})
    assert len(cold.warnings) == 1
    assert cold.changed({"t.torque": 2.0}).warnings == cold.warnings


def test_signals_of_the_model_itself_may_change_later():
    points = [(0.0, 1.0), (1.0, 2.0)]
    d = cw.Driveline("x")
    d.add(cw.Torque("t", shaft=d.shaft("a", inertia=1.0), torque=0.0))
    system = d.assemble().changed({"t.torque": cw.Table(points)})
    before = system.to_bytes()
    points[1] = (1.0, 5.0)
    assert system.changed({"a.speed": 1.0}).changed({"a.speed": None}).to_bytes() == before


def test_a_signal_that_nothing_follows_from_is_looked_at_alone(monkeypatch: pytest.MonkeyPatch) -> None:
    """Neither the element nor the driveline is checked again; what is given may change later."""
    system, points = six_speed.gearbox(six_speed.SHIFT).assemble(), [[t, 0.5 * p] for t, p in six_speed.SHIFT["F1"]]
    wanted = six_speed.gearbox({**six_speed.SHIFT, "F1": [tuple(point) for point in points]}).assemble().to_bytes()
    with monkeypatch.context() as patch:
        for name in ("component_problems", "component_advice", "assembled"):
            patch.setattr(quick_changes, name, None)
        made = system.changed({"F1.pressure": cw.Table(points), "load.torque": -0.0})
        points[1][1] = 7.0
    assert made.changed({"load.torque": 4000.0}).to_bytes() == wanted
    assert made.source is not None
    assert (
        made.to_bytes()
        == system.changed({"F1.pressure": made.inputs[_input(made)].signal, "load.torque": -0.0}).to_bytes()
    )
    with pytest.raises(cw.ModelError, match="pressure"):
        system.changed({"F1.pressure": cw.Table([(0.0, 0.0), (1.0, float("nan"))])})


def _input(system: cw.System) -> int:
    return [item.name for item in system.inputs].index("F1.pressure")


def test_only_fields_with_values_have_names():
    d = six_speed.gearbox(six_speed.SHIFT)
    names = set(all_names(d._model))
    assert {"w1.inertia", "w1.speed", "w1.angle", "F1.gain", "F1.friction.fast", "F1.pressure.points"} <= names
    assert not any(name.rpartition(".")[2] in FIXED for name in names)
    assert not isinstance(d.elements[0], Law)


def test_a_new_object_is_not_what_stood_in_its_memory() -> None:
    """What is made on the way is let go of, and the next one may be made in its place."""
    d = cw.Driveline("two shafts")
    a, b = d.shaft("a", inertia=1.0), d.shaft("b", inertia=1.0)
    new = Renewed({id(a): dataclasses.replace(a, inertia=2.0)})
    for number in range(100):
        # its owner lets go of it
        made = new.of(cw.Damper("damper", base=a, follower=b, damping=1.0 + number))
        assert made.base.inertia == 2.0
        assert made.damping == 1.0 + number


def test_a_point_below_all_numbers_is_refused_alone_too() -> None:
    d = cw.Driveline("d")
    d.add(cw.SpeedTorque("t", shaft=d.shaft("a", inertia=1.0), torque=[[0.0, float("-inf")]]))
    with pytest.raises(cw.ModelError, match="torque"):
        d.assemble()
