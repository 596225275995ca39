"""The frozen System: bytes, files, names."""

from __future__ import annotations

import struct

import numpy as np
import pytest

import clutchwork as cw
from clutchwork.assembly.system import SystemFormatError
from clutchwork.declare.layout import COUNTS, FIELDS, layout_text
from clutchwork.declare.schema import Role, kinds, schema_hash
from support import six_speed


@pytest.fixture(scope="module")
def system():
    return six_speed.gearbox(six_speed.SHIFT).assemble()


def test_arrays_have_the_shapes_of_the_layout(system):
    for name, kind, shape, _ in FIELDS:
        array = getattr(system, name)
        assert array.dtype == {"f8": np.float64, "i4": np.int32}[kind]
        assert array.shape == tuple(size if isinstance(size, int) else system.counts[size] for size in shape)
        assert not array.flags.writeable


def test_never_changes(system):
    with pytest.raises(AttributeError):
        system.name = "other"
    with pytest.raises(ValueError, match="read-only"):
        system.mass[0, 0] = 1.0
    with pytest.raises(TypeError):
        system.arrays["mass"] = None


def test_bytes_start_with_magic_hash_and_counts(system):
    data = system.to_bytes()
    assert data[:8] == b"CLUTCHWK"
    assert struct.unpack_from("<q", data, 8)[0] == schema_hash(layout_text())
    counts = struct.unpack_from(f"<{len(COUNTS)}q", data, 16)
    assert dict(zip((name for name, _ in COUNTS), counts, strict=True)) == system.counts
    assert len(data) % 8 == 0


def test_bytes_read_back(system):
    again = cw.System.from_bytes(system.to_bytes())
    assert again.to_bytes() == system.to_bytes()
    np.testing.assert_array_equal(again.mass, system.mass)
    # without names there is little to read, and nothing to fail
    assert "Trajectory done" in repr(cw.simulate(again, 0.01))


def test_bytes_that_do_not_fit(system):
    data = system.to_bytes()
    with pytest.raises(SystemFormatError, match="are not a System"):
        cw.System.from_bytes(b"something else")
    with pytest.raises(SystemFormatError, match="by another version; assemble the driveline again"):
        cw.System.from_bytes(data[:8] + b"\0" * 8 + data[16:])
    with pytest.raises(SystemFormatError, match="is truncated"):
        cw.System.from_bytes(data[:-8])


def test_file_reads_back(system, tmp_path):
    system.save(tmp_path / "box.npz")
    again = cw.System.load(tmp_path / "box.npz")
    assert again.to_bytes() == system.to_bytes()
    assert again.independent == system.independent
    assert [node.name for node in again.nodes] == [node.name for node in system.nodes]
    assert again.elements[0].name == system.elements[0].name


def test_file_with_a_forced_choice_and_a_csv_column(tmp_path):
    (tmp_path / "p.csv").write_text("time,F1\n0,1\n1,2\n")
    d = cw.Driveline("x")
    a, b = d.shaft("a", inertia=1.0), d.shaft("b", inertia=9.0)
    d.add(cw.Gear("g", input=a, output=b, ratio=2.0))
    d.add(cw.Torque("t", shaft=a, torque=cw.Column("p.csv", "F1", folder=str(tmp_path))))
    system = d.assemble(independent=("a",))
    system.save(tmp_path / "x.npz")
    (tmp_path / "p.csv").unlink()
    again = cw.System.load(tmp_path / "x.npz")
    assert again.to_bytes() == system.to_bytes()
    assert again.independent == ("a",)


def test_file_that_is_none(tmp_path):
    (tmp_path / "x.npz").write_text("no archive")
    with pytest.raises(SystemFormatError, match=r"write the file with System\.save"):
        cw.System.load(tmp_path / "x.npz")
    np.savez(tmp_path / "y.npz", mass=np.eye(2))
    with pytest.raises(SystemFormatError, match="cannot read a System"):
        cw.System.load(tmp_path / "y.npz")


def test_objects_are_never_unpickled(tmp_path):
    np.savez(tmp_path / "x.npz", content=np.array([{"a": 1}], dtype=object), model=1, independent=1)
    with pytest.raises(SystemFormatError, match="cannot read a System"):
        cw.System.load(tmp_path / "x.npz")


def test_system_with_a_controller_is_not_saved(tmp_path):
    d = cw.Driveline("x")
    d.add(cw.Torque("t", shaft=d.shaft("a", inertia=1.0), torque=cw.Sampled(lambda time, readings: 1.0, 0.1)))
    with pytest.raises(SystemFormatError, match="save its driveline"):
        d.assemble().save(tmp_path / "x.npz")


def test_names(system):
    assert [item.name for item in system.inputs] == ["load.torque", "F1.pressure", "F2.pressure", "F4.pressure"]
    assert [item.unit for item in system.inputs] == ["N m", "Pa", "Pa", "Pa"]
    assert system.params[system.places["F2.gain"]] == six_speed.GAIN["F2"]
    assert system.params[system.places["F4.friction.fast"]] == 0.065
    with pytest.raises(AttributeError, match="did you mean 'basis'"):
        _ = system.bassis


def test_kinds_and_offsets(system):
    assert [kinds(Role.TORQUE)[kind] for kind in system.element_kind] == [e.kind for e in system.elements]
    assert [kinds(Role.CONTACT)[kind] for kind in system.contact_kind] == ["clutch"] * 3
    for element, offset in zip(system.elements, system.element_param, strict=True):
        if element.kind == "spring_damper":
            assert system.params[offset : offset + 2].tolist() == [element.stiffness, element.damping]
        if element.kind == "speed_torque":
            first, count = system.params[offset : offset + 2].astype(int)
            assert system.points[first : first + count, :2].tolist() == [list(point) for point in element.torque]


def test_curves_carry_the_slope_to_the_next_point(system):
    x, y, slope = system.points.T
    np.testing.assert_allclose(slope[:-1], np.diff(y) / np.diff(x))
    assert slope[-1] == slope[-2]


def test_force_and_pressure_are_the_same_input():
    d = cw.Driveline()
    a, m = d.shaft("a", inertia=1.0), d.mass("m", mass=1.0)
    law = cw.Coulomb(static=0.2, kinetic=0.1)
    d.add(cw.Brake("b", shaft=a, friction=law, gain=1.0, normal_force=cw.Step(height=3.0)))
    d.add(cw.OneWayClutch("o", base=d.housing, follower=a))
    d.add(cw.PrescribedSpeed("p", shaft=m, speed=2.0))
    d.add(cw.ResistingTorque("r", shaft=m, torque=5.0, speed=1.0))
    system = d.assemble()
    names = {item.name: item.unit for item in system.inputs}
    assert names == {"r.torque": "N", "b.normal_force": "N", "o.pressure": "Pa", "p.speed": "m/s"}
    pressure = [item.name for item in system.inputs].index("o.pressure")
    assert system.segment_coef[system.input_first[pressure], 0] == 0.0
    assert [system.inputs[system.input_refs[ref]].name for ref in system.contact_input] == [
        "b.normal_force",
        "o.pressure",
    ]


def test_initial_twist_and_locked_contacts():
    d = cw.Driveline()
    a, b = d.shaft("a", inertia=1.0, angle=0.5), d.shaft("b", inertia=1.0)
    d.add(cw.Spring("s", base=a, follower=b, stiffness=30.0, initial_twist=0.1))
    law = cw.Coulomb(static=0.2, kinetic=0.1)
    d.add(cw.Brake("l", shaft=a, friction=law, gain=1.0, pressure=1.0, locked=True, tolerance=0.01))
    d.add(cw.Brake("u", shaft=b, friction=law, gain=1.0, pressure=1.0))
    system = d.assemble()
    assert system.initial_state.tolist() == [3.0]
    assert system.initial_angle.tolist() == [0.5, 0.0]
    assert system.contact_initial.tolist() == [1, 0]
    assert system.contact_tolerance.tolist() == [0.01, 0.0]
