"""The table of what may be changed: its words and derivatives are those of assembling a driveline with other values."""

from __future__ import annotations

import copy
import pickle
import warnings
from numbers import Real
from typing import Any, ClassVar

import numpy as np
import pytest

import clutchwork as cw
from clutchwork.assembly.during_runs import INERTIA
from clutchwork.assembly.provenance import SystemParameter, differing
from clutchwork.base.errors import ModelError
from clutchwork.declare.schema import Role
from clutchwork.elements.mesh import Mesh
from clutchwork.elements.rack_mesh import RackMesh
from clutchwork.model.changes import changed_model
from support import random_drivelines, random_parts, samples, six_speed

# so far numbers are moved, of their size: farther than the table itself looks, on both sides
SHARES = (4e-3, -6e-3)


def anew(system: cw.System, changes: dict[str, Any]) -> cw.System | None:
    """The System with other values, assembled as a whole; None where they are refused."""
    try:
        return cw.System.of(changed_model(system.source, changes), system.wanted)
    except ModelError:
        return None


def wrong(system: cw.System, one: SystemParameter, share: float) -> str:
    """What of an entry is not so where a number is another one."""
    value = float(one.value) + share * (abs(float(one.value)) or 1.0)
    made = anew(system, {one.name: value})
    differs = made and differing(system, made)
    if made is None or differs is None:
        return ""
    old, new = (np.frombuffer(some.to_bytes(), dtype=np.float64) for some in (system, made))
    found = ""
    if one.reach and differs.keys() - one.reach.keys():
        found = f"reaches {[*differs]}, not {[*one.reach]}"
    elif one.is_word and not np.all(new[one.words] == value):
        found = "is not its words"
    elif one.derivative is not None:
        # sums are rounded once: an error of 1e-16 of the words, over a share of 4e-3 of these
        expected, size = old[one.words] + one.derivative * (value - float(one.value)), np.abs(new[one.words])
        apart = np.abs(new[one.words] - expected) > 4e-15 * (size + np.abs(old[one.words]))
        found = f"has words {new[one.words]}, not {expected}" if apart.any() else ""
    return f"{one.name} at {value:g} {found}" if found else ""


def numbers(system: cw.System) -> list[SystemParameter]:
    """All entries that are a number which may have any value between two others."""
    known = [one for one in system.parameters.values() if isinstance(one.value, Real)]
    return [one for one in known if not (isinstance(one.value, bool) or one._spec.whole or one._spec.fixed)]


def compared(system: cw.System) -> int:
    """How many entries say how their words follow; none of them may be wrong."""
    found = numbers(system)
    faults = [fault for one in found for share in SHARES if (fault := wrong(system, one, share))]
    assert not faults, "\n".join(faults)
    return sum(one.derivative is not None for one in found)


@pytest.mark.parametrize("cls", samples.declared(*samples.ELEMENT_ROLES), ids=lambda cls: cls.kind)
@pytest.mark.filterwarnings("ignore::clutchwork.ModelWarning")
def test_words_of_every_number_of_every_element(cls: Any) -> None:
    compared(samples.driveline(cls).assemble())


@pytest.mark.parametrize("seed", range(6))
def test_words_of_random_drivelines(seed: int) -> None:
    for driveline in (random_parts.driveline(seed), random_drivelines.describe(seed).driveline()):
        assert compared(driveline.assemble()) > 0


def test_what_a_gearbox_may_be_given() -> None:
    system = six_speed.gearbox(six_speed.SHIFT).assemble()
    known = system.parameters
    assert compared(system) > 30
    gain, inertia, pressure = known["F1.gain"], known["w3.inertia"], known["F1.pressure"]
    assert (gain.value, gain.unit, gain.bounds) == (six_speed.GAIN["F1"], "m3", (np.nextafter(0.0, 1.0), np.inf))
    assert system.params[gain.reach["params"]].tolist() == [gain.value]
    assert gain.is_word
    assert gain.when == "during a run"
    assert inertia.reach.keys() == {"inertia", "mass_value"}
    assert (inertia.when, inertia.stays) == ("before a run", INERTIA)
    assert [system.inputs[number].name for number in pressure.inputs] == ["F1.pressure"]
    assert pressure.when == "during a run"
    assert known["F1.pressure.points"].when == "before a run"
    assert known["row1.ratio"].derivative is None
    assert len(known) == len([*known])
    with pytest.raises(KeyError, match=r"did you mean 'F1.gain'"):
        known["F1.gian"]


def test_a_part_of_a_gearbox_has_words_of_its_own() -> None:
    box = cw.Gearbox.of("ZF 8HP") if hasattr(cw.Gearbox, "of") else None
    system = samples.driveline(cw.Transmission).assemble()
    held = [name for name in system.parameters if name.count(".") == 2 and name.endswith(".gain")]
    assert held or box is None
    for name in held:
        one = system.parameters[name]
        assert one.value is None or (one.is_word and one.reach.keys() == {"params"})


def test_a_system_without_names_has_none() -> None:
    system = cw.System.from_bytes(six_speed.gearbox(six_speed.SHIFT).assemble().to_bytes())
    with pytest.raises(ModelError):
        _ = system.parameters


@pytest.mark.parametrize("cls", samples.declared(*samples.ELEMENT_ROLES), ids=lambda cls: cls.kind)
def test_the_table_says_what_a_run_takes(cls: Any) -> None:
    """What may change during a run is set, what may not is refused for the reason that the table gives."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", cw.ModelWarning)
        sim = cw.Simulator(samples.driveline(cls))
        system = sim._system
        known = [one for one in numbers(system) if one.name.startswith("x.") and one.name not in sim._outside.signals]
        for one in known:
            if any(one.name.startswith(f"{signal}.") for signal in sim._outside.signals):
                continue
            value = one._another
            if value is None:
                continue
            try:
                sim.set(one.name, value)
                taken = ""
                sim.release(one.name)
            except ModelError as error:
                taken = error.problems[0].message
            assert taken == ("" if one.stays is None else one.stays.why), one.name


class Scaled(cw.Damper):
    """A damper that follows from another number."""

    role: ClassVar[Role] = Role.COMPOSITE
    kind: ClassVar[str] = "scaled"

    def parts(self) -> Any:
        yield cw.Damper(f"{self.name}.part", base=self.base, follower=self.follower, damping=2.0 * self.damping)


def test_what_a_composite_computes_has_no_derivative_in_the_table() -> None:
    d = cw.Driveline("scaled")
    d.add(Scaled("t", base=d.shaft("a", inertia=0.3, speed=1.0), follower=d.shaft("b", inertia=0.8), damping=0.5))
    one = d.assemble().parameters["t.damping"]
    assert one.reach.keys() == {"params"}
    assert not one.is_word
    assert one.derivative is None


# -------------------------------------------------------------------------------- what is made where it is asked for


@pytest.mark.parametrize("cls", [Mesh, RackMesh])
def test_the_ratio_of_a_gear_with_friction_is_one_of_the_motion(cls: Any) -> None:
    system, name = samples.driveline(cls).assemble(), "x.ratio" if cls is Mesh else "x.radius"
    changes = {name: 1.1 * system.parameters[name].value}
    expected = anew(system, changes)
    assert expected is not None
    assert system.changed(changes).to_bytes() == expected.to_bytes()
    assert "basis_value" in system.parameters[name].reach


def test_a_changed_inertia_is_that_of_all_that_refers_to_it() -> None:
    system = six_speed.gearbox(six_speed.SHIFT).assemble()
    made = system.changed({"w6.inertia": 20.0, "F1.gain": 0.2}).changed({"w6.inertia": 21.0})
    nodes = {node.name: node for node in made.nodes}
    assert nodes["w6"].inertia == 21.0
    assert next(one for one in made.contacts if one.name == "F1").gain == 0.2
    joined = [
        value
        for part in (*made.elements, *made.contacts, *(row.gear for row in made.gears))
        for value in vars(part).values()
        if getattr(value, "name", "") == "w6"
    ]
    assert joined
    assert {node.inertia for node in joined} == {21.0}
    assert next(node for node in made.source.nodes if node.name == "w6").inertia == 21.0
    assert next(node for node in system.nodes if node.name == "w6").inertia == six_speed.INERTIA["w6"]


@pytest.mark.parametrize("copied", [copy.copy, copy.deepcopy, lambda one: pickle.loads(pickle.dumps(one))])
def test_a_changed_system_is_copied_whole(copied: Any) -> None:
    system = six_speed.gearbox(six_speed.SHIFT).assemble()
    changes = {"w6.inertia": 20.0, "F1.gain": 0.2}
    made, expected = copied(system.changed(changes)), anew(system, changes)
    assert expected is not None
    assert made.to_bytes() == expected.to_bytes()
    assert made.nodes == expected.nodes
    assert made.model == expected.model
    assert cw.simulate(made, 0.1)["w6.speed"][-1] == cw.simulate(expected, 0.1)["w6.speed"][-1]


def test_many_changes_of_changes() -> None:
    """Each is made of the one before, whose own values are not asked for."""
    system = made = six_speed.gearbox(six_speed.SHIFT).assemble()
    for number in range(1500):
        made = made.changed({"F1.gain": 0.2 + 1e-5 * number} if number % 50 else {"w6.inertia": 20.0 + number})
    expected = anew(system, {"F1.gain": 0.2 + 1e-5 * 1499, "w6.inertia": 20.0 + 1450})
    assert expected is not None
    assert made.to_bytes() == expected.to_bytes()
    assert made.nodes == expected.nodes
