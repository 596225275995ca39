"""Random cases by number: what is written, and what is done with it."""

from __future__ import annotations

import contextlib
import io
import json
import tomllib
import warnings
import zipfile
from collections.abc import Callable
from functools import cache
from pathlib import Path
from random import Random
from typing import Any

import clutchwork as cw
from clutchwork.command.main import main
from clutchwork.declare.schema import Role
from clutchwork.files.writer import toml
from clutchwork.fit import table
from support import samples
from support.fuzz import mutate

EXAMPLES = Path(__file__).resolve().parents[3] / "examples"
SECRET = "root-secret-4711"
TABLE = "time,p,q\n0,0,1\n0.5,2e5,3\n0.5,1e5,3\n1,3e5,text\n"
# codes of the command line for a model that is right, wrong, or cannot be read
CODES = (0, 3, 4)
# parts of archives that are JSON
TEXTS = ("model", "independent", "run", "events")


@cache
def models() -> tuple[dict[str, Any], ...]:
    """The models of the examples, and one with each element and each friction law."""
    found = [tomllib.loads(path.read_text()) for path in sorted(EXAMPLES.glob("*/model.toml"))]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        found += [samples.driveline(cls).to_dict() for cls in samples.declared(*samples.ELEMENT_ROLES)]
        for cls in samples.declared(Role.LAW):
            d = cw.Driveline("law")
            shaft, lining = d.shaft("a", inertia=1.0, speed=3.0), d.thermal("plates", capacity=50.0)
            d.add(cw.Brake("b", shaft=shaft, friction=samples.law(cls), gain=1.0, pressure=1.0, heat=lining))
            found.append(d.to_dict())
    return tuple(found)


@cache
def archives(folder: Path) -> tuple[bytes, ...]:
    """Saved systems."""
    made = []
    for number, data in enumerate(models()[3:12]):
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            cw.Driveline.from_dict(data).assemble().save(folder / f"seed{number}")
        made.append((folder / f"seed{number}").read_bytes())
    return tuple(made)


@cache
def runs(folder: Path) -> tuple[bytes, ...]:
    """Saved runs."""
    made = []
    for data in models()[3:9]:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            cw.Driveline.from_dict(data).simulate(0.01, max_steps=100).save(folder / "seed run")
        made.append((folder / "seed run").read_bytes())
    return tuple(made)


def model_file(folder: Path, random: Random) -> None:
    """A damaged model file: read, checked, assembled, run for a moment."""
    seed = random.choice(models())
    as_json = random.random() < 0.5
    if random.random() < 0.6:
        seed = mutate.tree(seed, random)
        as_json = as_json or not isinstance(seed, dict)
    try:
        whole = json.dumps(seed) if as_json else toml(seed)
    except (AttributeError, ValueError, RecursionError):
        whole, as_json = json.dumps(models()[0]), True
    if random.random() < 0.5:
        whole = mutate.text(whole, random)
    path = folder / ("model.json" if as_json else "model.toml")
    path.write_bytes(whole.encode("utf-8", "surrogatepass"))
    (folder / "p.csv").write_text(TABLE)
    (folder / "secret.csv").write_text(f"{SECRET}\n{SECRET}\n")
    said = io.StringIO()
    with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
        code = main(["check", str(path)])
    assert code in CODES, code
    assert SECRET not in said.getvalue()
    assert "\x1b" not in said.getvalue()
    d = cw.Driveline.load(path)
    system = d.assemble()
    d.save(folder / "again.json")
    assert cw.Driveline.load(folder / "again.json").assemble().to_bytes() == system.to_bytes()
    run = cw.simulate(system, 1e-3, max_steps=100, max_events=50, points=10)
    run.to_csv(folder / "run.csv")


def csv_file(folder: Path, random: Random) -> None:
    """A damaged CSV file, read by a signal and as a measurement."""
    whole = mutate.text(TABLE, random).encode("utf-8", "surrogatepass")
    if random.random() < 0.3:
        whole = mutate.data(whole, random)
    (folder / "p.csv").write_bytes(whole)
    names = random.choice((("p", "time"), ("q", "time"), ("time", "time"), ("p", "p"), ("r", "time"), ("", "")))
    column = cw.Column("p.csv", names[0], time=names[1], scale=random.choice((1.0, 1e5, 1e308)), folder=str(folder))
    d = cw.Driveline("csv")
    d.add(cw.Torque("t", shaft=d.shaft("a", inertia=1.0), torque=column))
    # what is wrong is told, not raised
    problems = d.check()
    with contextlib.suppress(cw.ClutchworkError):
        table.read(folder / "p.csv", {"time": names[1], "slip": "p", "torque": names[0], "load": 1.0})
    if not problems:
        d.assemble().to_bytes()


def saved_system(folder: Path, random: Random) -> None:
    """A damaged archive of a System, with or without right checksums."""
    whole = random.choice(archives(folder))
    whole = mutate.data(whole, random) if random.random() < 0.5 else _repacked(whole, random)
    path = folder / "system"
    path.write_bytes(whole)
    cw.System.load(path).to_bytes()


def saved_run(folder: Path, random: Random) -> None:
    """A damaged file of a run."""
    whole = random.choice(runs(folder))
    (folder / "run").write_bytes(mutate.data(whole, random) if random.random() < 0.5 else _repacked(whole, random))
    run = cw.load_run(folder / "run")
    assert len(run.time) == len(run.rows)


def _repacked(whole: bytes, random: Random) -> bytes:
    with zipfile.ZipFile(io.BytesIO(whole)) as archive:
        parts = {name: archive.read(name) for name in archive.namelist()}
    chosen = random.choice(list(parts))
    if chosen not in TEXTS or random.random() < 0.3:
        parts[chosen] = mutate.data(parts[chosen], random)
    else:
        parts[chosen] = json.dumps(mutate.tree(json.loads(parts[chosen]), random)).encode()
    if random.random() < 0.1:
        parts[chosen] = bytes(400_000_000) if random.random() < 0.1 else b"[" * 100_000
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED) as archive:
        for name, part in parts.items():
            archive.writestr(name, part)
    return stream.getvalue()


CASES: dict[str, Callable[[Path, Random], None]] = {
    "model_file": model_file,
    "csv_file": csv_file,
    "saved_system": saved_system,
    "saved_run": saved_run,
}
