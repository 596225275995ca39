"""`clutchwork run` and `clutchwork demo`: arguments, report and files."""

from __future__ import annotations

import argparse
import sys
import warnings
from collections.abc import Callable
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from clutchwork.base import near
from clutchwork.base.paths import fitting
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
from clutchwork.command.models import add_set, add_trust, system_of
from clutchwork.command.progress import bar
from clutchwork.declare.wording import words_of_files
from clutchwork.run.flags import add_options, given_options

if TYPE_CHECKING:
    from clutchwork.assembly.system import System
    from clutchwork.declare.options import Options
    from clutchwork.results.state import State
    from clutchwork.run.trajectory import Trajectory

DEMO = Path("examples", "six_speed", "model.toml")
EXAMPLES = (
    ("clutchwork run model.toml", "events, gears, energy"),
    ("clutchwork run model.toml --plot out.png --csv out.csv", "with a picture, and all signals in a table"),
    ("clutchwork run model.toml --losses --sankey out.svg", "what each element loses, as a table and as a picture"),
    ('clutchwork run model.toml --set c1.gain=6e-4 --set "c1.pressure=2 bar"', "with other values than the file has"),
    ('clutchwork run model.toml --signals "c1.*" --signals "*.speed" --csv out.csv', "only some of the signals"),
    ('clutchwork run model.toml --units "*.speed=rpm" --csv out.csv --plot out.png', "speeds in rpm in both files"),
    ("clutchwork run model.toml --t-end 1 --save-state one.state", "up to 1 s, and store where it is"),
    ("clutchwork run model.toml --start one.state --t-end 2", "go on from there up to 2 s, with the same bits"),
    ("clutchwork run model.toml --t-end 0.5 --dt 1ms --json", "half a second, a row each millisecond, as JSON"),
)


def add_commands(commands: Any) -> None:
    """Add `run` and `demo`."""
    run = add_command(
        commands, "run", run_command, "compute the motion of a model", examples=EXAMPLES, codes=code_text()
    )
    add_model(run)
    add_set(run)
    add_trust(run)
    run.add_argument(
        "--signals",
        metavar="NAMES",
        action="append",
        help="signals to write, and to print with --json, such as 'c1.*'; may be given several times; default: all "
        "in files, none with --json",
    )
    run.add_argument(
        "--units",
        metavar="NAME=UNIT",
        action="append",
        default=[],
        help="another unit than that of SI in files of signals and in the picture, such as '*.speed=rpm'; may be given "
        "several times",
    )
    run.add_argument("--ratio", metavar="A/B", help="shafts whose speed ratio is reported; default: drive and load")
    run.add_argument("--out", type=Path, metavar="DIR", help="folder for picture.png, trajectory.csv, events.csv")
    run.add_argument("--plot", type=Path, metavar="FILE", help="write the picture (png, svg or pdf)")
    run.add_argument("--losses", action="store_true", help="report what each element loses")
    run.add_argument("--sankey", type=Path, metavar="FILE", help="write the energy of all elements as a Sankey picture")
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
    run.add_argument("--start", type=Path, metavar="FILE", help="go on from a state that --save-state or Python wrote")
    run.add_argument("--save-state", type=Path, metavar="FILE", help="store the state at the end, to go on from")
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
    demo.set_defaults(set=[], signals=None, units=[], ratio=None, plot=None, csv=None, events=None, write=[], save=None)
    demo.set_defaults(start=None, save_state=None, losses=False, sankey=None)
    demo.set_defaults(quiet=False, trust=False)


def run_command(asked: argparse.Namespace) -> int:
    """Run, report, write; the exit code."""
    from clutchwork.command import report
    from clutchwork.command.choose import chosen_shafts, chosen_signals, given_units
    from clutchwork.results.channels import channels
    from clutchwork.results.ratios import phases
    from clutchwork.results.state import State
    from clutchwork.run.settings import merged
    from clutchwork.run.simulation import begin_of

    wanted = _wanted(asked)
    writable(wanted)
    system = system_of(asked.model, asked.set, trust=asked.trust)
    shafts = chosen_shafts(system, asked.ratio)
    start = State.load(asked.start) if asked.start is not None else None
    with words_of_files():
        given = given_options(asked)
        given |= begin_of(system, start, given) if start is not None else {}
        t_end, options = merged(system.settings, given)
        known = channels(system, options.angles, options.work)
        chosen = SignalFiles(chosen_signals(known, asked.signals or ["*"]), given_units(asked.units, known))
    names = chosen.names
    _say_unused(asked)
    run, code, why = _simulated(system, t_end, options, start, hidden=asked.quiet or asked.json)
    found = phases(run, shafts) if shafts and len(run) else []
    written = _write(run, chosen, wanted) if len(run) else []
    if asked.json:
        data = report.run_data(run, found, shafts, names if asked.signals else ())
        more = {"losses": run.losses().to_dict()} if asked.losses and len(run) else {}
        failed = {"status": "failed", "message": why} if why and run.finished else {}
        tell_json(data | failed | more | {"files": [str(path) for path in written]})
    elif not asked.quiet:
        losses = ["", str(run.losses())] if asked.losses and len(run) else []
        tell("\n".join([report.run_text(run, found, shafts), *losses, *(["", *wrote(written)] if written else [])]))
    if why:
        sys.stderr.write(f"clutchwork: {why}\n")
    return code


def _say_unused(asked: argparse.Namespace) -> None:
    """Say which options choose among signals where no signal is written."""
    signals = bool(asked.out or asked.csv or asked.write)
    unused = ["--signals"] if asked.signals and not (signals or asked.json) else []
    unused += ["--units"] if asked.units and not (signals or asked.plot) else []
    for option in unused:
        more = " or --json" if option == "--signals" else " or --plot FILE"
        remedy = f"give --csv FILE, --write FILE, --out DIR{more}"
        sys.stderr.write(f"clutchwork: {option} has no effect, for no signals are asked for; {remedy}\n")


def _simulated(
    system: System, t_end: float, options: Options, start: State | None, *, hidden: bool
) -> tuple[Trajectory, int, str]:
    """What came of a run, the exit code, and why it ended early."""
    from clutchwork.run.failure import Interrupted, StoppedEarly
    from clutchwork.run.simulation import simulate
    from clutchwork.run.trajectory import SimulationError

    with warnings.catch_warnings(), bar(options.t_start, t_end, hidden=hidden) as told:
        # the exit code and the message report it
        warnings.simplefilter("ignore", StoppedEarly)
        try:
            run = simulate(system, t_end, start=start, options=options, progress=told)
        except Interrupted as stop:
            return stop.trajectory, INTERRUPTED, stop.trajectory.message
        except SimulationError as stop:
            # what a model file can have of that is an FMU
            if stop.trajectory is None:
                raise
            return stop.trajectory, STOPPED, str(stop)
    return run, DONE if run.finished else STOPPED, run.message


class SignalFiles(NamedTuple):
    """What files of signals hold."""

    names: tuple[str, ...]
    units: dict[str, str]  # other ones than those of SI


Writer = Callable[["Trajectory", Path, SignalFiles], object]


def _wanted(asked: argparse.Namespace) -> dict[Path, Writer]:
    """The files that are asked for, and what writes each."""
    folder = asked.out
    for option, path in (("--csv", asked.csv), ("--events", asked.events)):
        if path is not None:
            fitting(option, path, f"{option[2:]}.csv", [".csv"])
    named: list[tuple[Path | None, Writer]] = [
        (asked.plot or (folder and folder / "picture.png"), _plot),
        (asked.sankey, _sankey),
        (asked.csv or (folder and folder / "trajectory.csv"), _csv),
        (asked.events or (folder and folder / "events.csv"), _events),
        *((path, _writer(path)) for path in asked.write),
        (asked.save, _save),
        (asked.save_state, _save_state),
    ]
    return {path: write for path, write in named if path is not None}


def _plot(run: Trajectory, path: Path, chosen: SignalFiles) -> None:
    # what only tables have
    run.plot(path, units={name: unit for name, unit in chosen.units.items() if name != "time"})


def _sankey(run: Trajectory, path: Path, _chosen: SignalFiles) -> None:
    run.sankey(path)


def _csv(run: Trajectory, path: Path, chosen: SignalFiles) -> None:
    run.to_csv(path, chosen.names, units=chosen.units)


def _events(run: Trajectory, path: Path, _chosen: SignalFiles) -> None:
    run.events.to_csv(path)


def _save(run: Trajectory, path: Path, _chosen: SignalFiles) -> None:
    run.save(path)


def _save_state(run: Trajectory, path: Path, _chosen: SignalFiles) -> None:
    run.state().save(path)


def _writer(path: Path) -> Writer:
    """What writes a file for another program."""
    from clutchwork.exchange import ENDINGS

    if path.suffix.lower() not in ENDINGS:
        known = f"known: {', '.join(ENDINGS)}"
        raise ValueError(f"--write {path}: no format ends in {path.suffix!r}{near(path.suffix, ENDINGS, known)}")
    return lambda run, path, chosen: run.write(path, chosen.names, units=chosen.units)


def _write(run: Trajectory, chosen: SignalFiles, wanted: dict[Path, Writer]) -> list[Path]:
    """Write the wanted files; their paths."""
    for path, write in wanted.items():
        write(run, path, chosen)
    return [*wanted]


def demo_command(asked: argparse.Namespace) -> int:
    """The demonstration is a plain run of a model of the examples; its picture needs a package that a user may lack."""
    out, drawn = asked.out, find_spec("matplotlib") is not None
    asked.model, asked.out = _demo_model(), None
    asked.csv, asked.events = out / "trajectory.csv", out / "events.csv"
    asked.plot = out / "shift.png" if drawn else None
    code = run_command(asked)
    if not drawn:
        sys.stderr.write('clutchwork: no picture, which needs matplotlib: pip install "clutchwork[draw]"\n')
    return code


def _demo_model() -> Path:
    """The model that ships with the package; in a checkout the one of the examples."""
    package = Path(__file__).resolve().parents[1]
    for folder in (package, package.parents[1]):
        if (folder / DEMO).is_file():
            return folder / DEMO
    raise FileNotFoundError(f"{package / DEMO} not found: install clutchwork again")
