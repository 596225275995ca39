"""Saved systems: damaged, swollen and foreign archives."""

from __future__ import annotations

import zipfile

import pytest

import clutchwork as cw
from clutchwork.assembly.system import SystemFormatError
from clutchwork.base import archive
from clutchwork.base import regular as files


def _driveline():
    d = cw.Driveline("two")
    engine, load = d.shaft("engine", inertia=0.2, speed=100.0), d.shaft("load", inertia=0.8)
    lining = cw.Coulomb(static=0.12, kinetic=0.1)
    d.add(cw.Clutch("c", base=load, follower=engine, friction=lining, gain=5e-4, pressure=1e5))
    return d


def _saved(tmp_path):
    d = _driveline()
    d.assemble().save(tmp_path / "system")
    return tmp_path / "system"


def _repacked(path, **changed):
    with zipfile.ZipFile(path) as stored:
        parts = {name: stored.read(name) for name in stored.namelist()}
    archive.write(path, parts | changed)
    return path


def test_a_saved_system_reads_back(tmp_path):
    path = _saved(tmp_path)
    d = _driveline()
    assert cw.System.load(path).to_bytes() == d.assemble().to_bytes()
    assert cw.System.load(_repacked(path)).to_bytes() == cw.System.load(path).to_bytes()


@pytest.mark.parametrize(
    "changed",
    [
        {"content": b""},
        {"content": b"CLUTCHWK" + b"\xff" * 500},
        {"model": b"[" * 100_000},
        {"model": b"{}"},
        {"model": b"\xff"},
        {"independent": b"5"},
        {"independent": b"[5]"},
        {"independent": b'["nobody"]'},
        {"more": b""},
    ],
    ids=str,
)
def test_an_archive_with_other_parts(tmp_path, changed):
    with pytest.raises((SystemFormatError, cw.ModelError)):
        cw.System.load(_repacked(_saved(tmp_path), **changed))


def test_arrays_of_another_model(tmp_path):
    d = _driveline()
    d.shaft("third", inertia=1.0)
    with pytest.raises(SystemFormatError, match="do not fit its model"):
        cw.System.load(_repacked(_saved(tmp_path), content=d.assemble().to_bytes()))


def test_archives_that_unpack_to_much(tmp_path, monkeypatch):
    path = _repacked(_saved(tmp_path), model=b" " * 10_000_000)
    monkeypatch.setattr(archive, "MOST_BYTES", 1_000_000)
    with pytest.raises(SystemFormatError, match="unpacks to more than"):
        cw.System.load(path)
    monkeypatch.setattr(archive, "MOST_BYTES", 100)
    with pytest.raises(SystemFormatError, match="more than 100"):
        cw.System.load(path)


def test_every_byte_of_an_archive_is_checked(tmp_path):
    whole = _saved(tmp_path).read_bytes()
    good = cw.System.load(tmp_path / "system").to_bytes()
    for place in range(0, len(whole), 7):
        (tmp_path / "bad").write_bytes(whole[:place] + bytes([whole[place] ^ 0x55]) + whole[place + 1 :])
        try:
            assert cw.System.load(tmp_path / "bad").to_bytes() == good
        except SystemFormatError:
            continue


def test_archives_are_regular_files(tmp_path):
    for path in ("/dev/zero", tmp_path):
        with pytest.raises(SystemFormatError, match="cannot read a System"):
            cw.System.load(path)
    with pytest.raises(SystemFormatError, match="does not exist; check the path"):
        cw.System.load(tmp_path / "none")


def test_the_reader_stops_at_its_limit(tmp_path):
    (tmp_path / "x").write_bytes(b"x" * 100)
    assert files.read_regular(tmp_path / "x", 100) == b"x" * 100
    with pytest.raises(files.UnfitFileError):
        files.read_regular(tmp_path / "x", 99)
