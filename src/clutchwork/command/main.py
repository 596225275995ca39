"""The command line: one command for each thing to do with a model, the reference, and help with examples."""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Sequence
from typing import Any

from clutchwork.base.errors import ModelError, ModelFileError
from clutchwork.base.extras import program
from clutchwork.base.shell import (
    DONE,
    EXIT_CODES,
    FILE,
    INTERRUPTED,
    MODEL,
    STOPPED,
    USAGE,
    Help,
    Parser,
    code_text,
    example_text,
    tell_json,
)
from clutchwork.codegen import command as codegen
from clutchwork.command import check, completion, new, plot, reference, run
from clutchwork.diagrams import command as diagrams
from clutchwork.fit import command as fit
from clutchwork.fmu import command as fmu
from clutchwork.linear import command as linear
from clutchwork.page import command as page
from clutchwork.rig import command as rig
from clutchwork.schematic import command as schematic
from clutchwork.ssp import command as ssp
from clutchwork.sweeps import command as sweeps

__all__ = ["EXIT_CODES", "INTERRUPTED", "STOPPED", "main", "parser"]

# those of rooms, each in its command.py
ROOMS = (schematic, diagrams, sweeps, linear, rig, fit, codegen, fmu, ssp, page)
ABOUT = "Simulates drivelines with clutches and brakes: engagements, launches, gear shifts."
EXAMPLES = (
    ("clutchwork demo", "see what it does: a gearbox launches and shifts"),
    ("clutchwork new model.toml", "a commented model to start from"),
    ("clutchwork check model.toml", "is it right? all mistakes at once"),
    ("clutchwork run model.toml --plot out.png", "run it: events, energy, a picture"),
    ('clutchwork run model.toml --set "c1.pressure=3 bar"', "with another value"),
    ("clutchwork elements clutch", "what an element is, with all its fields"),
    ("clutchwork run --help", "all about one command"),
)


def main(arguments: Sequence[str] | None = None) -> int:
    """Entry point; the exit code."""
    words = list(sys.argv[1:] if arguments is None else arguments)
    # `clutchwork help run`, as other programs have it
    words = [*words[1:2], "--help"] if words[:1] == ["help"] else words
    asked, unknown = parser().parse_known_args(words)
    if unknown:
        asked.parser.unknown(unknown)
    if asked.command is None:
        asked.parser.print_help()
        return DONE
    try:
        code = int(asked.command(asked))
        sys.stdout.flush()
    except ModelFileError as error:
        return _fail(asked, FILE, str(error), [str(problem) for problem in error.problems])
    except ModelError as error:
        return _fail(asked, MODEL, str(error), [str(problem) for problem in error.problems])
    except BrokenPipeError:
        # who reads the output has seen enough; nothing is left to be flushed at the exit
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return DONE
    except (OSError, ImportError) as error:
        return _fail(asked, FILE, _of_file(error))
    except (ValueError, TypeError, KeyError) as error:
        return _fail(asked, USAGE, str(error.args[0]) if isinstance(error, KeyError) and error.args else str(error))
    except KeyboardInterrupt:
        return _fail(asked, INTERRUPTED, "interrupted")
    return code


def parser() -> Parser:
    """What the command line understands."""
    top = Parser(
        prog="clutchwork", description=ABOUT, epilog=f"{example_text(EXAMPLES)}\n\n{code_text()}", formatter_class=Help
    )
    top.add_argument("--version", action=_Version, nargs=0, help="show program's version number and exit")
    top.set_defaults(command=None, parser=top, top=top)
    commands = top.add_subparsers(title="commands", metavar="command")
    for own in (new, check, run, plot):
        own.add_commands(commands)
    for room in ROOMS:
        room.add_command(commands)
    for own in (reference, completion):
        own.add_commands(commands)
    return top


def _fail(asked: argparse.Namespace, code: int, message: str, problems: Sequence[str] = ()) -> int:
    if getattr(asked, "json", False):
        tell_json({"error": message, "problems": list(problems), "exit_code": code})
    sys.stderr.write(f"clutchwork: {message}\n")
    return code


def _of_file(error: OSError | ImportError) -> str:
    """What is wrong with a file, without the number that the system gives it."""
    if isinstance(error, OSError) and error.strerror and error.filename:
        return f"{error.filename}: {error.strerror[0].lower()}{error.strerror[1:]}; check the path"
    return str(error)


class _Version(argparse.Action):
    """The version, looked up where it is asked for."""

    def __call__(self, parser: argparse.ArgumentParser, *_: Any) -> None:
        """Print it and end."""
        sys.stdout.write(f"{program()}\n")
        parser.exit()
