"""The command line: run | check | demo | sweep | linearise | rig | fit | export | --version."""

from __future__ import annotations

import argparse
import json
import os
import sys
import warnings
from collections.abc import Callable, Sequence
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING, Any

from clutchwork.base.errors import ModelError, ModelFileError, ModelWarning
from clutchwork.command.progress import Bar
from clutchwork.declare.speech import words_of_files
from clutchwork.run.flags import add_options, given_options

if TYPE_CHECKING:
    from clutchwork.assembly.system import System
    from clutchwork.face.driveline import Driveline
    from clutchwork.results.trajectory import Trajectory

DONE, STOPPED, USAGE, MODEL, FILE, INTERRUPTED = 0, 1, 2, 3, 4, 130
EXIT_CODES = {
    DONE: "done",
    STOPPED: "the run stopped early; what was asked for is written up to there",
    USAGE: "the command line or an option is wrong",
    MODEL: "the model is wrong; every mistake is listed",
    FILE: "a file, such as the model, is missing or cannot be read or written, or a package is missing",
    INTERRUPTED: "interrupted; a run writes what was asked for up to there",
}
DEMO = Path("examples", "six_speed", "model.toml")


def main(arguments: Sequence[str] | None = None) -> int:
    """Entry point; the exit code."""
    asked = parser().parse_args(arguments)
    try:
        return int(asked.command(asked))
    except ModelFileError as error:
        return _fail(asked, FILE, str(error), [str(problem) for problem in error.problems])
    except ModelError as error:
        return _fail(asked, MODEL, str(error), [str(problem) for problem in error.problems])
    except BrokenPipeError:
        # who reads the output has seen enough; nothing is left to be flushed at the exit
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return DONE
    except (OSError, ImportError) as error:
        return _fail(asked, FILE, str(error))
    except (ValueError, TypeError, KeyError) as error:
        return _fail(asked, USAGE, str(error.args[0]) if isinstance(error, KeyError) and error.args else str(error))
    except KeyboardInterrupt:
        return _fail(asked, INTERRUPTED, "interrupted")


def parser() -> argparse.ArgumentParser:
    """What the command line understands."""
    top = argparse.ArgumentParser(prog="clutchwork", description=__doc__, epilog=_codes())
    top.add_argument("--version", action="version", version=_version())
    commands = top.add_subparsers(required=True, metavar="command")
    _run_parser(commands.add_parser("run", help="compute the motion of a model", epilog=_codes()))
    _check_parser(commands.add_parser("check", help="check a model and list its ratios, without running it"))
    _demo_parser(commands.add_parser("demo", help="launch and 3-4 shift of a six-speed planetary gearbox"))
    for module in ("sweeps", "linear", "rig", "fit", "codegen"):
        import_module(f"clutchwork.{module}.command").add_command(commands)
    return top


def _run_parser(run: argparse.ArgumentParser) -> None:
    run.set_defaults(command=_run)
    run.add_argument("model", type=Path, help="model file, TOML or JSON")
    run.add_argument("--ratio", metavar="A/B", help="shafts whose speed ratio is reported; default: drive and load")
    run.add_argument("--out", type=Path, metavar="DIR", help="folder for picture.png, trajectory.csv, events.csv")
    run.add_argument("--plot", type=Path, metavar="FILE", help="write the picture (png, svg or pdf)")
    run.add_argument("--csv", type=Path, metavar="FILE", help="write all signals")
    run.add_argument("--events", type=Path, metavar="FILE", help="write the events")
    run.add_argument("--json", action="store_true", help="print the results as JSON on standard output")
    run.add_argument("--quiet", action="store_true", help="print no report and no progress bar")
    add_options(run)


def _check_parser(check: argparse.ArgumentParser) -> None:
    check.set_defaults(command=_check)
    check.add_argument("model", type=Path, help="model file, TOML or JSON")
    check.add_argument("--ratio", metavar="A/B", help="shafts whose speed ratio is reported; default: drive and load")
    check.add_argument("--json", action="store_true", help="print the results as JSON on standard output")


def _demo_parser(demo: argparse.ArgumentParser) -> None:
    demo.set_defaults(command=_demo)
    demo.add_argument(
        "--out",
        type=Path,
        metavar="DIR",
        default=Path("out", "demo"),
        help="folder for shift.png, trajectory.csv, events.csv; default: out/demo",
    )
    demo.add_argument("--json", action="store_true", help="print the results as JSON on standard output")


def _run(asked: argparse.Namespace) -> int:
    from clutchwork.command import report
    from clutchwork.face.driveline import Driveline
    from clutchwork.results.ratios import phases

    system = _assembled(Driveline.load(asked.model))
    shafts = _shafts(system, asked.ratio)
    run, code = _simulated(system, asked)
    found = phases(run, shafts) if shafts and len(run) else []
    written = _write(run, asked) if len(run) else []
    if asked.json:
        _print_json(report.run_data(run, found, shafts) | {"files": [str(path) for path in written]})
    elif not asked.quiet:
        print(report.run_text(run, found, shafts))
        print("\n".join(["", *(f"wrote {path}" for path in written)]) if written else "", end="\n" if written else "")
    if not run.finished:
        print(f"clutchwork: {run.message}", file=sys.stderr)
    return code


def _assembled(driveline: Driveline) -> System:
    """The system of a model; its warnings go to standard error."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ModelWarning)
        system = driveline.assemble()
    for text in system.warnings:
        print(f"warning: {text}", file=sys.stderr)
    return system


def _simulated(system: System, asked: argparse.Namespace) -> tuple[Trajectory, int]:
    """Run with the settings of the file, overruled by those of the command line; what came of it, and the exit code."""
    from clutchwork.run.failure import Interrupted, StoppedEarly
    from clutchwork.run.settings import merged
    from clutchwork.run.simulation import simulate

    with words_of_files():
        t_end, options = merged(system.settings, given_options(asked))
    with warnings.catch_warnings(), Bar(hidden=asked.quiet or asked.json) as bar:
        # the exit code and the message report it
        warnings.simplefilter("ignore", StoppedEarly)
        try:
            run = simulate(system, t_end, options=options, progress=bar.show)
        except Interrupted as stop:
            return stop.trajectory, INTERRUPTED
    return run, DONE if run.finished else STOPPED


def _write(run: Trajectory, asked: argparse.Namespace) -> list[Path]:
    """Write the wanted files; their paths."""
    folder = asked.out
    wanted: list[tuple[Path | None, Callable[[Path], object]]] = [
        (asked.plot or (folder and folder / "picture.png"), run.plot),
        (asked.csv or (folder and folder / "trajectory.csv"), run.to_csv),
        (asked.events or (folder and folder / "events.csv"), run.events.to_csv),
    ]
    written = []
    for path, write in wanted:
        if path is not None:
            path.parent.mkdir(parents=True, exist_ok=True)
            write(path)
            written.append(path)
    return written


def _check(asked: argparse.Namespace) -> int:
    from clutchwork.command import report
    from clutchwork.face.driveline import Driveline

    system = _assembled(Driveline.load(asked.model))
    shafts = _shafts(system, asked.ratio)
    if asked.json:
        _print_json(report.model_data(system, shafts))
    else:
        print(report.model_text(system, shafts))
    return DONE


def _demo(asked: argparse.Namespace) -> int:
    """The demonstration is a plain run of a model of the examples; its picture needs a package that a user may lack."""
    out = asked.out
    line = ["run", str(_demo_model()), "--csv", str(out / "trajectory.csv"), "--events", str(out / "events.csv")]
    drawn = find_spec("matplotlib") is not None
    if drawn:
        line += ["--plot", str(out / "shift.png")]
    code = int(_run(parser().parse_args([*line, "--json"] if asked.json else line)))
    if not drawn:
        print("clutchwork: no picture, which needs matplotlib: pip install 'clutchwork[plot]'", file=sys.stderr)
    return code


def _demo_model() -> Path:
    """The model that ships with the package; in a checkout the one of the examples."""
    package = Path(__file__).resolve().parents[1]
    for folder in (package, package.parents[1]):
        if (folder / DEMO).is_file():
            return folder / DEMO
    raise FileNotFoundError(f"{package / DEMO} not found: install clutchwork again")


def _shafts(system: System, asked: str | None) -> tuple[str, str] | None:
    from clutchwork.assembly.wiring import wiring
    from clutchwork.base.errors import near
    from clutchwork.results.ratios import input_and_output

    if asked is None:
        return input_and_output(wiring(system))
    names = [node.name for node in wiring(system).nodes]
    # a name may hold a slash itself
    cuts = [(asked[:place], asked[place + 1 :]) for place, sign in enumerate(asked) if sign == "/"]
    for upper, lower in cuts:
        if upper in names and lower in names:
            return upper, lower
    if not cuts:
        raise ValueError(f"--ratio {asked}: must be two shafts, such as {'/'.join(names[:2])}")
    missing = next((name for name in cuts[0] if name not in names), asked)
    raise ValueError(f"--ratio {asked}: no shaft {missing!r}{near(missing, names, 'write it as input/output')}")


def _fail(asked: argparse.Namespace, code: int, message: str, problems: Sequence[str] = ()) -> int:
    if getattr(asked, "json", False):
        _print_json({"error": message, "problems": list(problems), "exit_code": code})
    print(f"clutchwork: {message}", file=sys.stderr)
    return code


def _print_json(data: dict[str, Any]) -> None:
    print(json.dumps(data, indent=2))


def _codes() -> str:
    return "Exit codes: " + "; ".join(f"{code} {words.replace(';', ',')}" for code, words in EXIT_CODES.items()) + "."


def _version() -> str:
    from importlib.metadata import PackageNotFoundError, version

    try:
        return f"clutchwork {version('clutchwork')}"
    except PackageNotFoundError:
        return "clutchwork (not installed)"
