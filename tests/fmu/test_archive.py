"""The archive and the library in it."""

from __future__ import annotations

import gzip
import random
import shutil
import subprocess
import sys
import zipfile
from collections.abc import Iterable
from pathlib import Path
from typing import Any

import pytest

import clutchwork as cw
from clutchwork.declare.core import core
from clutchwork.fmu.archive import merge, read, write
from clutchwork.fmu.libraries import OTHERS, Library, libraries, schema_of
from fmu.conftest import INPUTS, SIX_SPEED
from support.fmus import Fmu
from support.project import ROOT

ODD = ["plain", "with space", "per%20cent", "ümlaut", "plus+and&", "a/deep/er"]


@pytest.mark.parametrize("version", ["2.0", "3.0"])
def test_the_same_model_gives_the_same_bytes(tmp_path: Path, version: str) -> None:
    driveline = cw.Driveline.load(SIX_SPEED)
    made = [
        driveline.to_fmu(tmp_path / folder / "six.fmu", inputs=INPUTS, version=version, picture=False).read_bytes()
        for folder in "ab"
    ]
    assert made[0] == made[1]
    with zipfile.ZipFile(tmp_path / "a" / "six.fmu") as archive:
        names = archive.namelist()
    assert names[0] == "modelDescription.xml"
    assert {"resources/model.cw", "documentation/index.html", "documentation/licenses/license.txt"} <= set(names)


def test_the_schematic_goes_with_it(tmp_path: Path) -> None:
    path = cw.Driveline.load(SIX_SPEED).to_fmu(tmp_path / "six.fmu")
    assert read(path)["model.png"].startswith(b"\x89PNG")


@pytest.mark.parametrize("folder", ODD)
def test_odd_folders(six_speed: Fmu, tmp_path: Path, folder: str) -> None:
    """FMI 2.0 gives a URI, 3.0 a path."""
    shutil.copytree(six_speed.folder, tmp_path / folder)
    moved = object.__new__(Fmu)
    vars(moved).update(vars(six_speed) | {"folder": tmp_path / folder})
    with moved.running() as run:
        run.step(0.0, 0.01)


def test_a_resource_of_another_model_or_damaged_is_refused(six_speed: Fmu, tmp_path: Path) -> None:
    whole = (six_speed.folder / "resources" / "model.cw").read_bytes()
    shutil.copytree(six_speed.folder, tmp_path / "bad")
    moved = object.__new__(Fmu)
    vars(moved).update(vars(six_speed) | {"folder": tmp_path / "bad"})
    resource = tmp_path / "bad" / "resources" / "model.cw"
    for bad in (b"", whole[:100], whole[:-8], whole + bytes(8), whole[:8] + bytes(8) + whole[16:], b"x" * len(whole)):
        resource.write_bytes(bad)
        with pytest.raises(Exception, match="nstantiate"):
            moved.instance()
    # any bit
    source = random.Random(1)
    for _ in range(60):
        flipped = bytearray(whole)
        flipped[source.randrange(80, len(whole))] ^= 1 << source.randrange(8)
        resource.write_bytes(bytes(flipped))
        with pytest.raises(Exception, match="nstantiate"):
            moved.instance()
    resource.unlink()
    with pytest.raises(Exception, match="nstantiate"):
        moved.instance()


def test_two_instances_and_two_fmus_of_one_name_do_not_meet(six_speed: Fmu, tmp_path: Path) -> None:
    shutil.copytree(six_speed.folder, tmp_path / "twin")
    twin = object.__new__(Fmu)
    vars(twin).update(vars(six_speed) | {"folder": tmp_path / "twin"})
    start, seen = {"F2.pressure": 6e5, "F4.pressure": 6e5}, ["w1.speed", "F2.heat"]
    with (
        six_speed.running(start) as one,
        six_speed.running({"F4.pressure": 9e5}) as other,
        twin.running(start) as third,
    ):
        for k in range(20):
            for run in (one, other, third):
                run.step(0.05 * k, 0.05)
        assert one.get(seen) == third.get(seen)
        assert one.get(seen) != other.get(seen)


def test_merge_joins_platforms_and_refuses_two_models(tmp_path: Path) -> None:
    one = cw.Driveline.load(SIX_SPEED).to_fmu(tmp_path / "one.fmu", picture=False)
    entries = read(one)
    library = next(name for name in entries if name.startswith("binaries/"))
    other = {name: content for name, content in entries.items() if name != library}
    write(tmp_path / "other.fmu", {**other, "binaries/win64/six.dll": b"MZ"})
    merged = read(merge([one, tmp_path / "other.fmu"], tmp_path / "both.fmu"))
    assert {library, "binaries/win64/six.dll"} <= set(merged)
    write(tmp_path / "third.fmu", {**other, "resources/model.cw": b"another"})
    with pytest.raises(cw.UseError, match=r"model\.cw"):
        merge([one, tmp_path / "third.fmu"], tmp_path / "both.fmu")


def test_libraries_of_other_platforms_go_with_it(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Those that were built for what this core writes; the one of this machine is its own."""
    others = tmp_path / "static"
    others.mkdir()
    schema, here = schema_of(core().schema_hash()), folders_of(libraries())
    names = {"x86_64-windows": "dll", "aarch64-darwin": "dylib", "aarch64-linux": "so", "x86_64-linux": "so"}
    for platform, ending in names.items():
        (others / f"{platform}.{schema}.{ending}.gz").write_bytes(gzip.compress(platform.encode()))
    (others / "x86_64-darwin.0123456789abcdef.dylib.gz").write_bytes(gzip.compress(b"of another version"))
    monkeypatch.setattr("clutchwork.fmu.libraries.OTHERS", others)
    entries = read(cw.Driveline.load(SIX_SPEED).to_fmu(tmp_path / "one.fmu", version="3.0", picture=False))
    binaries = {Path(name).parent.name: content for name, content in entries.items() if name.startswith("binaries/")}
    assert binaries.keys() == names.keys() | here
    assert binaries["x86_64-windows"] == b"x86_64-windows"
    (own,) = here
    assert len(binaries[own]) > 1e6


def folders_of(found: Iterable[Library]) -> set[str]:
    """Platforms of libraries, without those that were built beside the package."""
    return {one.folders["3.0"] for one in found if one.path.suffix != ".gz"}


def test_the_tool_names_them_as_the_package_reads_them() -> None:
    sys.path.append(str(ROOT / "tools"))
    import build_fmu_libraries

    assert build_fmu_libraries.schema() == schema_of(core().schema_hash())
    assert OTHERS == build_fmu_libraries.WHERE


def _told(*command: Any) -> str:
    return subprocess.run(list(map(str, command)), capture_output=True, text=True, check=True).stdout


@pytest.mark.skipif(not shutil.which("objdump"), reason="needs binutils")
def test_the_library_needs_libc_and_libm_alone() -> None:
    """It runs on any Linux of the last ten years: memcpy of 2.14 is the newest that it needs."""
    (library,) = [one for one in libraries() if one.path.name.endswith("linux.so")]
    told = _told("objdump", "-p", library.path)
    needed = {line.split()[1] for line in told.splitlines() if line.strip().startswith("NEEDED")}
    assert needed <= {"libc.so.6", "libm.so.6"}
    versions = {word for word in told.split() if word.startswith("GLIBC_")}
    assert all(tuple(map(int, one.removeprefix("GLIBC_").split("."))) <= (2, 14) for one in versions), versions


@pytest.mark.skipif(not shutil.which("nm"), reason="needs binutils")
def test_the_library_exports_the_standard_alone_and_keeps_no_data() -> None:
    (library,) = [one for one in libraries() if one.path.name.endswith("linux.so")]
    lines = [line.split() for line in _told("nm", "-D", "--defined-only", library.path).splitlines()]
    names = {line[-1] for line in lines}
    assert all(name.startswith(("fmi2", "fmi3")) for name in names)
    assert not [line for line in lines if line[-2] == "u"]
    # all functions of FMI 2.0 and 3.0: importers refuse a library that lacks one
    assert len([name for name in names if name.startswith("fmi2")]) == 44
    assert len([name for name in names if name.startswith("fmi3")]) == 75
    sections = {
        line.split()[1]: int(line.split()[2], 16)
        for line in _told("objdump", "-h", library.path).splitlines()
        if line.strip()[:1].isdigit()
    }
    assert sections[".data"] + sections[".bss"] <= 128
