"""`clutchwork run` and `clutchwork demo`: arguments, report and files."""

from __future__ import annotations

import argparse
import sys
import warnings
from collections.abc import Callable
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any

from clutchwork.base.errors import near
from clutchwork.base.shell import (
    DONE,
    INTERRUPTED,
    STOPPED,
    add_command,
    add_json,
    add_model,
    add_quiet,
    code_text,
    tell,
    tell_json,
    writable,
    wrote,
)
from clutchwork.command.models import add_set, system_of
from clutchwork.command.progress import bar
from clutchwork.declare.speech import words_of_files
from clutchwork.run.flags import add_options, given_options

if TYPE_CHECKING:
    from clutchwork.assembly.system import System
    from clutchwork.declare.options import Options
    from clutchwork.results.trajectory import Trajectory

DEMO = Path("examples", "six_speed", "model.toml")
EXAMPLES = (
    ("clutchwork run model.toml", "events, gears, energy"),
    ("clutchwork run model.toml --plot out.png --csv out.csv", "with a picture, and all signals in a table"),
    ('clutchwork run model.toml --set c1.gain=6e-4 --set "c1.pressure=2 bar"', "with other values than the file has"),
    ('clutchwork run model.toml --signals "c1.*" --signals "*.speed" --csv out.csv', "only some of the signals"),
    ("clutchwork run model.toml --t-end 0.5 --dt 1ms --json", "half a second, a row each millisecond, as JSON"),
)


def add_commands(commands: Any) -> None:
    """Add `run` and `demo`."""
    run = add_command(
        commands, "run", run_command, "compute the motion of a model", examples=EXAMPLES, codes=code_text()
    )
    add_model(run)
    add_set(run)
    run.add_argument(
        "--signals",
        metavar="NAMES",
        action="append",
        help="signals to write, and to print with --json, such as 'c1.*'; may be given several times; default: all "
        "in files, none with --json",
    )
    run.add_argument("--ratio", metavar="A/B", help="shafts whose speed ratio is reported; default: drive and load")
    run.add_argument("--out", type=Path, metavar="DIR", help="folder for picture.png, trajectory.csv, events.csv")
    run.add_argument("--plot", type=Path, metavar="FILE", help="write the picture (png, svg or pdf)")
    run.add_argument("--csv", type=Path, metavar="FILE", help="write the signals")
    run.add_argument("--events", type=Path, metavar="FILE", help="write the events")
    run.add_argument(
        "--write",
        type=Path,
        metavar="FILE",
        action="append",
        default=[],
        help="write the signals for another program, by the ending of the file; may be given several times",
    )
    run.add_argument("--save", type=Path, metavar="FILE", help="store the run, for clutchwork plot and cw.load_run")
    add_json(run)
    add_quiet(run, "report and no progress bar")
    add_options(run)
    demo = add_command(
        commands,
        "demo",
        demo_command,
        "launch and 3-4 shift of a six-speed planetary gearbox",
        examples=(("clutchwork demo", "see out/demo/shift.png"), ("clutchwork demo --out shift", "in another folder")),
    )
    demo.add_argument(
        "--out",
        type=Path,
        metavar="DIR",
        default=Path("out", "demo"),
        help="folder for shift.png, trajectory.csv, events.csv; default: out/demo",
    )
    add_json(demo)
    # what a demonstration shares with a run
    demo.set_defaults(set=[], signals=None, ratio=None, plot=None, csv=None, events=None, write=[], save=None)
    demo.set_defaults(quiet=False)


def run_command(asked: argparse.Namespace) -> int:
    """Run, report, write; the exit code."""
    from clutchwork.command import report
    from clutchwork.command.choose import chosen_shafts, chosen_signals
    from clutchwork.results.channels import channels
    from clutchwork.results.ratios import phases
    from clutchwork.run.settings import merged

    wanted = _wanted(asked)
    writable(wanted)
    system = system_of(asked.model, asked.set)
    shafts = chosen_shafts(system, asked.ratio)
    with words_of_files():
        t_end, options = merged(system.settings, given_options(asked))
    names = chosen_signals(channels(system, options.angles, options.work), asked.signals or ["*"])
    run, code = _simulated(system, t_end, options, hidden=asked.quiet or asked.json)
    found = phases(run, shafts) if shafts and len(run) else []
    written = _write(run, names, wanted) if len(run) else []
    if asked.json:
        data = report.run_data(run, found, shafts, names if asked.signals else ())
        tell_json(data | {"files": [str(path) for path in written]})
    elif not asked.quiet:
        tell("\n".join([report.run_text(run, found, shafts), *(["", *wrote(written)] if written else [])]))
    if not run.finished:
        sys.stderr.write(f"clutchwork: {run.message}\n")
    return code


def _simulated(system: System, t_end: float, options: Options, *, hidden: bool) -> tuple[Trajectory, int]:
    """What came of a run, and the exit code."""
    from clutchwork.run.failure import Interrupted, StoppedEarly
    from clutchwork.run.simulation import simulate

    with warnings.catch_warnings(), bar(t_end, hidden=hidden) as told:
        # the exit code and the message report it
        warnings.simplefilter("ignore", StoppedEarly)
        try:
            run = simulate(system, t_end, options=options, progress=told)
        except Interrupted as stop:
            return stop.trajectory, INTERRUPTED
    return run, DONE if run.finished else STOPPED


Writer = Callable[["Trajectory", Path, tuple[str, ...]], object]


def _wanted(asked: argparse.Namespace) -> dict[Path, Writer]:
    """The files that are asked for, and what writes each."""
    folder = asked.out
    named: list[tuple[Path | None, Writer]] = [
        (asked.plot or (folder and folder / "picture.png"), _plot),
        (asked.csv or (folder and folder / "trajectory.csv"), _csv),
        (asked.events or (folder and folder / "events.csv"), _events),
        *((path, _writer(path)) for path in asked.write),
        (asked.save, _save),
    ]
    return {path: write for path, write in named if path is not None}


def _plot(run: Trajectory, path: Path, _names: tuple[str, ...]) -> None:
    run.plot(path)


def _csv(run: Trajectory, path: Path, names: tuple[str, ...]) -> None:
    run.to_csv(path, names)


def _events(run: Trajectory, path: Path, _names: tuple[str, ...]) -> None:
    run.events.to_csv(path)


def _save(run: Trajectory, path: Path, _names: tuple[str, ...]) -> None:
    run.save(path)


def _writer(path: Path) -> Writer:
    """What writes a file for another program."""
    from clutchwork.results.exchange import ENDINGS

    if path.suffix.lower() not in ENDINGS:
        known = f"known: {', '.join(ENDINGS)}"
        raise ValueError(f"--write {path}: no format ends in {path.suffix!r}{near(path.suffix, ENDINGS, known)}")
    return lambda run, path, names: run.write(path, names)


def _write(run: Trajectory, names: tuple[str, ...], wanted: dict[Path, Writer]) -> list[Path]:
    """Write the wanted files; their paths."""
    for path, write in wanted.items():
        path.parent.mkdir(parents=True, exist_ok=True)
        write(run, path, names)
    return [*wanted]


def demo_command(asked: argparse.Namespace) -> int:
    """The demonstration is a plain run of a model of the examples; its picture needs a package that a user may lack."""
    out, drawn = asked.out, find_spec("matplotlib") is not None
    asked.model, asked.out = _demo_model(), None
    asked.csv, asked.events = out / "trajectory.csv", out / "events.csv"
    asked.plot = out / "shift.png" if drawn else None
    code = run_command(asked)
    if not drawn:
        sys.stderr.write("clutchwork: no picture, which needs matplotlib: pip install 'clutchwork[plot]'\n")
    return code


def _demo_model() -> Path:
    """The model that ships with the package; in a checkout the one of the examples."""
    package = Path(__file__).resolve().parents[1]
    for folder in (package, package.parents[1]):
        if (folder / DEMO).is_file():
            return folder / DEMO
    raise FileNotFoundError(f"{package / DEMO} not found: install clutchwork again")
