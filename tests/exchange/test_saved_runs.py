"""Runs in one file: what is loaded is what was saved, to the last bit, and nothing of it is code."""

from __future__ import annotations

import json
import pickle
import tracemalloc
import warnings
import zipfile
from contextlib import suppress
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import clutchwork as cw
from clutchwork.declare.schema import Role
from clutchwork.run.save import RUN_PARTS
from clutchwork.run.saved import RepeatError, RunFormatError
from support import random_drivelines, random_mixes, samples
from support.amount import amount

ROOT = Path(__file__).resolve().parents[2]


def _same(run: cw.Trajectory, other: cw.Trajectory) -> None:
    assert other.names == run.names
    assert other.units == run.units
    np.testing.assert_array_equal(other.time, run.time)
    for name in run.names:
        np.testing.assert_array_equal(other[name], run[name])
    assert other.events == run.events
    assert str(other.events) == str(run.events)
    if run.options.work:
        assert other.energy == run.energy
    assert (other.status, other.message, other.t_end) == (run.status, run.message, run.t_end)
    assert other.statistics == run.statistics
    assert other.dependent == run.dependent
    assert other.system.name == run.system.name


def _again(run: cw.Trajectory, folder: Path) -> cw.Trajectory:
    run.save(folder / "run.cwrun")
    return cw.load_run(folder / "run.cwrun")


@pytest.mark.parametrize("path", sorted(ROOT.glob("examples/*/model.toml")), ids=lambda path: path.parent.name)
def test_examples(path: Path, tmp_path: Path) -> None:
    run = cw.Driveline.load(path).simulate()
    loaded = _again(run, tmp_path)
    _same(run, loaded)
    assert loaded.options == run.options
    assert loaded.plot() is not None


@pytest.mark.parametrize("seed", range(4))
def test_random_drivelines_and_their_repetition(seed: int, tmp_path: Path) -> None:
    run = random_drivelines.describe(seed).driveline().simulate(1.0, rtol=1e-8, dt=0.01)
    loaded = _again(run, tmp_path)
    _same(run, loaded)
    times = [0.123, 0.5, 0.5, 1.0]
    exact, other = run.at(times), loaded.at(times)
    np.testing.assert_array_equal(other.rows, exact.rows)
    assert other.events == exact.events


@pytest.mark.parametrize("cls", samples.declared(Role.CONTACT, Role.TORQUE), ids=lambda c: c.kind)
def test_every_element(cls: Any, tmp_path: Path) -> None:
    with warnings.catch_warnings():
        # of the numbers of the sample
        warnings.simplefilter("ignore", cw.ModelWarning)
        run = samples.driveline(cls).simulate(0.05)
    _same(run, _again(run, tmp_path))


def _controlled() -> cw.Trajectory:
    d = cw.Driveline("controlled")
    a, b = d.shaft("a", inertia=0.2, speed=100.0), d.shaft("b", inertia=0.8)
    law = cw.Coulomb(static=0.1, kinetic=0.1)
    rule = cw.Sampled(lambda time, readings: 100.0 if time > 0.2 else 0.0, 0.1)
    d.add(cw.Clutch("c1", base=a, follower=b, friction=law, gain=1.0, normal_force=rule))
    d.add(cw.Torque("t", shaft=a, torque=cw.Sampled(lambda time, readings: -readings["a.speed"], 0.05)))
    return d.simulate(2.0)


def test_a_run_with_controllers_is_saved_but_not_repeated(tmp_path: Path) -> None:
    run = _controlled()
    loaded = _again(run, tmp_path)
    _same(run, loaded)
    with pytest.raises(RepeatError, match=r"Python functions \(t.torque, c1.normal_force\).*simulate the model again"):
        loaded.at([1.0])
    # what was loaded is saved, sent and handed on like any other
    _same(run, pickle.loads(pickle.dumps(loaded)))
    with pytest.raises(RepeatError):
        loaded.to_pandas(dt=0.1)
    assert len(loaded.to_pandas()) == len(run)


def test_what_was_loaded_is_saved_again(tmp_path: Path) -> None:
    for run in (_controlled(), random_drivelines.describe(1).driveline().simulate(0.5)):
        loaded = _again(_again(run, tmp_path), tmp_path)
        _same(run, loaded)
        if any(item.signal.sampling() for item in run.system.inputs):
            with pytest.raises(RepeatError):
                loaded.at([0.1])


def test_a_run_that_stopped_early(tmp_path: Path) -> None:
    with pytest.warns(cw.StoppedEarly):
        run = random_drivelines.describe(3).driveline().simulate(2.0, max_steps=60)
    loaded = _again(run, tmp_path)
    _same(run, loaded)
    with pytest.raises(cw.SimulationError, match="max_steps"):
        loaded.raise_for_status()


def test_without_angles_and_work(tmp_path: Path) -> None:
    run = random_drivelines.describe(3).driveline().simulate(0.5, angles=False, work=False, times=[0.1, 0.2])
    loaded = _again(run, tmp_path)
    _same(run, loaded)
    with pytest.raises(KeyError, match="run with work=True"):
        loaded[f"{run.system.contacts[0].name}.heat"]


def test_a_system_without_names(tmp_path: Path) -> None:
    data = random_drivelines.describe(3).driveline().assemble().to_bytes()
    run = cw.simulate(cw.System.from_bytes(data), 0.5)
    loaded = _again(run, tmp_path)
    np.testing.assert_array_equal(loaded.rows, run.rows)


# ------------------------------------------------------------------------------------------------------------- damage


@pytest.fixture
def saved(tmp_path: Path) -> Path:
    random_drivelines.describe(3).driveline().simulate(0.5).save(tmp_path / "run")
    return tmp_path / "run"


def _changed(path: Path, **parts: Any) -> Path:
    """The same archive with parts replaced, or left out where None is given."""
    with zipfile.ZipFile(path) as archive:
        content = {name: archive.read(name) for name in archive.namelist()}
    content |= parts
    with zipfile.ZipFile(path, "w") as archive:
        for name, data in content.items():
            if data is not None:
                archive.writestr(name, data)
    return path


def _about(path: Path, **values: Any) -> bytes:
    with zipfile.ZipFile(path) as archive:
        return json.dumps(json.loads(archive.read("run")) | values).encode()


def test_a_newer_format_names_both_versions(saved: Path) -> None:
    changed = _changed(saved, run=_about(saved, format=2, program="clutchwork 9.0"))
    with pytest.raises(RunFormatError, match=r"saved by clutchwork 9\.0 in format 2; clutchwork .* reads 1: update it"):
        cw.load_run(changed)


def test_another_layout_names_both_versions(saved: Path) -> None:
    with zipfile.ZipFile(saved) as archive:
        content = bytearray(archive.read("content"))
    content[8] ^= 1
    with pytest.raises(RunFormatError, match=r"assembled by another version.*saved by clutchwork"):
        cw.load_run(_changed(saved, content=bytes(content)))


@pytest.mark.parametrize(
    ("parts", "words"),
    [
        ({"rows": None}, "other parts"),
        ({"more": b""}, "other parts"),
        ({"run": b"[]"}, "does not say what it holds"),
        ({"run": b"{"}, "cannot read a run"),
        ({"rows": b"12345678"}, "do not fit its model"),
        ({"time": b"1"}, "cannot read a run"),
        ({"events": b"[[1]]"}, "cannot read a run"),
        ({"events": b"3"}, "cannot read a run"),
        ({"model": b"{}"}, "cannot"),
        ({"content": b""}, "cannot"),
    ],
)
def test_damaged_parts(saved: Path, parts: dict[str, Any], words: str) -> None:
    with pytest.raises(RunFormatError, match=words):
        cw.load_run(_changed(saved, **parts))


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ({"status": "fine"}, "its status is none"),
        ({"options": {"rtoll": 1}}, "rtoll"),
        ({"options": {"rtol": -1}}, "rtol"),
        ({"options": 3}, "cannot read a run"),
        ({"t_end": "x"}, "t_end"),
        ({"format": "x"}, "cannot read a run"),
    ],
)
def test_damaged_words(saved: Path, values: dict[str, Any], words: str) -> None:
    with pytest.raises(RunFormatError, match=words):
        cw.load_run(_changed(saved, run=_about(saved, **values)))


def test_modes_that_there_are_not(saved: Path) -> None:
    run = cw.load_run(saved)
    rows = run.rows.copy()
    rows[3, run.wiring.columns["contact_mode"].start] = 7.0
    with pytest.raises(RunFormatError, match="mode of a contact"):
        cw.load_run(_changed(saved, rows=rows.tobytes()))


def test_flipped_bytes_are_found(saved: Path) -> None:
    data, run = saved.read_bytes(), cw.load_run(saved)
    rng = np.random.default_rng(1)
    for place in rng.integers(0, len(data), 60):
        damaged = bytearray(data)
        damaged[place] ^= 0xFF
        saved.write_bytes(damaged)
        # bytes that no reader looks at, such as a date, change nothing
        with suppress(RunFormatError):
            _same(cw.load_run(saved), run)


@pytest.mark.parametrize("name", RUN_PARTS)
def test_no_part_unpacks_to_more_than_the_run_holds(saved: Path, name: str) -> None:
    # 0.1 MB that would be 100 MB
    with zipfile.ZipFile(saved) as archive:
        content = {item: archive.read(item) for item in archive.namelist()}
    with zipfile.ZipFile(saved, "w", zipfile.ZIP_DEFLATED) as archive:
        for item, data in content.items():
            with archive.open(item, "w", force_zip64=True) as stream:
                stream.write(data if item != name else b"")
                for _ in range(100 if item == name else 0):
                    stream.write(bytes(1_000_000))
    tracemalloc.start()
    with pytest.raises(RunFormatError, match=r"more than a run can hold|do not fit its model"):
        cw.load_run(saved)
    most = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    assert most < 40e6


@pytest.mark.random
def test_random_mixes_of_all_elements_read_back(tmp_path: Path) -> None:
    count = 0
    for seed in range(amount(150)):
        d = random_mixes.driveline(seed)
        if d is None:
            continue
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", cw.ModelWarning)
            # a ratio may be jammed from the start
            warnings.simplefilter("ignore", cw.StoppedEarly)
            run = d.simulate(0.01, max_steps=200, max_events=50, **({"output": "steps"} if seed % 2 else {}))
            if len(run):
                _same(run, _again(run, tmp_path))
        system = d.assemble()
        system.save(tmp_path / "system")
        assert cw.System.load(tmp_path / "system").to_bytes() == system.to_bytes()
        count += 1
    assert count > 0.9 * amount(150)


@pytest.mark.parametrize("path", ["none", ".", "/dev/zero", "a\0b"])
def test_no_file(tmp_path: Path, path: str, monkeypatch: Any) -> None:
    monkeypatch.chdir(tmp_path)
    with pytest.raises(RunFormatError):
        cw.load_run(path)
    (tmp_path / "text").write_text("hello")
    with pytest.raises(RunFormatError, match="not an archive"):
        cw.load_run(tmp_path / "text")
