"""Paths are taken in the same way everywhere: folders are made, what is no path or has a wrong ending is refused."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import clutchwork as cw
from clutchwork.base.paths import WriteError
from clutchwork.command.main import main
from support.full_disk import full_disk


def braked() -> cw.Driveline:
    """A disc that a brake stops."""
    d = cw.Driveline("braked")
    disc = d.shaft("disc", inertia=1.0, speed=10.0)
    d.add(cw.Brake("b", shaft=disc, friction=cw.Coulomb(static=0.3, kinetic=0.2), gain=1.0, normal_force=50.0))
    return d


Write = Callable[[Any], object]


@pytest.fixture(scope="module")
def writers() -> dict[str, Write]:
    """All that writes, by a name of a file that it may have."""
    d = braked()
    run = d.simulate(0.5)
    sweep = cw.sweep(d, 0.1, vary={"b.normal_force": [10.0, 50.0]}, outputs=["disc.speed"])
    schematic, box = d.draw(), cw.Gearbox.load("zf-6hp26")
    return {
        "run.csv": run.to_csv,
        "run.parquet": run.to_parquet,
        "run.mf4": run.to_mdf,
        "run.mat": run.to_mat,
        "run.nc": run.to_netcdf,
        "written.csv": run.write,
        "events.csv": run.events.to_csv,
        "run.png": lambda path: run.plot(path=path),
        "run.html": lambda path: run.explore(path=path),
        "drawn.svg": d.draw,
        "saved.svg": schematic.save,
        "model.toml": d.save,
        "sweep.csv": sweep.to_csv,
        "sweep.parquet": sweep.to_parquet,
        "losses.svg": lambda path: run.losses().sankey(path),
        "box.toml": box.save,
        "box.svg": lambda path: cw.diagram(box, "stick").save(path),
        "modes.png": cw.linearise(d).plot,
        "run.cwrun": run.save,
        "run.cwstate": run.state().save,
        "model.cwsystem": d.assemble().save,
        "c": lambda path: cw.export_c(d, path, t_end=0.1),
    }


ANY_ENDING = ("run.cwrun", "run.cwstate", "model.cwsystem", "c")


def test_a_missing_folder_is_made(writers: dict[str, Write], tmp_path: Path) -> None:
    for name, write in writers.items():
        path = tmp_path / f"folder of {name}" / "below" / name
        write(str(path))
        assert path.exists(), name


def test_a_folder_that_cannot_be_made_is_named(writers: dict[str, Write], tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    for name, write in writers.items():
        with pytest.raises(WriteError, match=r"file is a file, not a folder; give another path"):
            write(tmp_path / "file" / "below" / name)


def test_what_is_no_path_is_refused_and_nothing_is_written(
    writers: dict[str, Write], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    for name, write in writers.items():
        for wrong in (3, True, b"x.csv", [name]):
            with pytest.raises(cw.UseError, match=r"is not a path; give a string, such as '\w"):
                write(wrong)
        with pytest.raises(cw.UseError, match="is empty"):
            write("")
    assert list(tmp_path.iterdir()) == []


def test_a_wrong_ending_is_refused(writers: dict[str, Write], tmp_path: Path) -> None:
    for name, write in writers.items():
        if name not in ANY_ENDING:
            with pytest.raises((cw.ClutchworkError), match=r"end|\.toml"):
                write(tmp_path / "x.odd")
    assert list(tmp_path.iterdir()) == []


def test_files_that_are_read_are_named_alike(tmp_path: Path) -> None:
    for load in (cw.load_run, cw.State.load, cw.System.load, cw.Driveline.load, cw.read_columns):
        with pytest.raises(cw.UseError, match=r"3 is not a path; give a string, such as '\w"):
            load(3)  # type: ignore[operator]
    for read in (cw.load_run, cw.State.load, cw.System.load):
        with pytest.raises(cw.ClutchworkError, match=r"nix does not exist; check the path"):
            read(tmp_path / "nix")


def test_the_command_line_says_so_before_the_run(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    braked().save(tmp_path / "model.toml")
    for option in ("--csv", "--events"):
        assert main(["run", str(tmp_path / "model.toml"), option, str(tmp_path / "x.txt")]) == 2
        assert "ends in '.txt'" in capsys.readouterr().err
    assert [path.name for path in tmp_path.iterdir()] == ["model.toml"]


def test_a_failed_write_leaves_the_file_that_was_there(writers: dict[str, Write], tmp_path: Path) -> None:
    for name, write in writers.items():
        path = tmp_path / name
        # the folder of C has many files; the first ones are of the model
        path = path / "model.h" if name == "c" else path
        path.parent.mkdir(exist_ok=True)
        path.write_bytes(b"what was there")
        with full_disk(10), pytest.raises(WriteError, match=r"cannot be written: .*; make room on the disk, or give"):
            write(tmp_path / name)
        assert path.read_bytes() == b"what was there", name
        assert [one.name for one in path.parent.iterdir() if one.name.startswith(".")] == [], name
        write(tmp_path / name)
        assert path.read_bytes() != b"what was there", name


def test_rights_links_and_devices_stay(tmp_path: Path) -> None:
    d, path = braked(), tmp_path / "model.toml"
    path.write_text("")
    path.chmod(0o640)
    (tmp_path / "link.toml").symlink_to("model.toml")
    d.save(tmp_path / "link.toml")
    assert (tmp_path / "link.toml").is_symlink()
    assert (path.stat().st_mode & 0o777, cw.Driveline.load(path).name) == (0o640, "braked")
    (tmp_path / "null.csv").symlink_to("/dev/null")
    d.simulate(0.1).to_csv(tmp_path / "null.csv")
    assert not Path("/dev/null").is_file()


# what writes a file in Python
OPENS = re.compile(r"\.write_(text|bytes|html|image)\(|open\([^)]*[\"'][wxa]|\.(savefig|savez|savetxt|savemat)\(")
# the helper, a lock, unpacked FMUs in a folder of their own and the pipe to one, and what gets a file to write from
# `exchange.write` or writes into memory
ALLOWED = r"^(base/writing|studies/lock|plot/canvas|schematic/picture|exchange/(csv_table|mat|mdf)|fmu_import/\w+)\.py$"
# of `replaced`; and a picture writes itself by it
ITS_PATH = r"\bnew\b|\bfigure\.savefig\("


def test_nothing_else_opens_a_file_to_write(root: Path) -> None:
    package = root / "src/clutchwork"
    lines = [(path, line) for path in sorted(package.rglob("*.py")) for line in path.read_text().splitlines()]
    found = [(path.relative_to(package).as_posix(), line.strip()) for path, line in lines if OPENS.search(line)]
    assert [one for one in found if not re.match(ALLOWED, one[0]) and not re.search(ITS_PATH, one[1])] == []
