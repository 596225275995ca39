"""What the commands of the command line have in common: arguments, help with examples, exit codes, what they print."""

from __future__ import annotations

import argparse
import json
import math
import os
import re
import sys
from collections.abc import Callable, Iterable, Sequence
from pathlib import Path
from shutil import get_terminal_size
from textwrap import wrap
from typing import Any, NoReturn

from clutchwork.base.errors import near

DONE, STOPPED, USAGE, MODEL, FILE, INTERRUPTED = 0, 1, 2, 3, 4, 130
EXIT_CODES = {
    DONE: "done",
    STOPPED: "the run stopped early; what was asked for is written up to there",
    USAGE: "the command line or an option is wrong",
    MODEL: "the model is wrong; every mistake is listed",
    FILE: "a file, such as the model, is missing or cannot be read or written, or a package is missing",
    INTERRUPTED: "interrupted; a run writes what was asked for up to there",
}
WIDEST = 120
_CHOICE = re.compile(r"argument (.+?): invalid choice: '(.*)' \(choose from (.*)\)")

# a command line, and what it is for
Example = tuple[str, str]


def width() -> int:
    """Characters in a line of the terminal, 80 where there is none."""
    return max(40, min(WIDEST, get_terminal_size((80, 24)).columns))


def paragraphs(text: str, wide: int, indent: str = "") -> str:
    """Text in lines that fit; lines that begin with spaces stay as they are."""
    made = []
    for part in text.strip("\n").split("\n\n"):
        kept = part.startswith(" ") or "\n " in part
        lines = part.split("\n") if kept else wrap(part, wide - len(indent), break_on_hyphens=False)
        made.append("\n".join(indent + line for line in lines))
    return "\n\n".join(made)


class Help(argparse.HelpFormatter):
    """Help whose examples stay as they are written."""

    def __init__(self, prog: str, **more: Any) -> None:
        super().__init__(prog, **{"max_help_position": 28, "width": width() - 2} | more)

    def add_argument(self, action: argparse.Action) -> None:
        """Take in an argument; the names of commands stand further in than argparse counts."""
        super().add_argument(action)
        if isinstance(action.choices, dict) and action.choices:
            self._action_max_length += self._indent_increment

    def _fill_text(self, text: str, width: int, indent: str) -> str:
        return paragraphs(text, width, indent)


class Parser(argparse.ArgumentParser):
    """A parser without colours, whose errors are one line that names what was probably meant."""

    def __init__(self, *args: Any, **more: Any) -> None:
        super().__init__(*args, **more)
        # newer versions of Python colour their help
        self.color = False

    def error(self, message: str) -> NoReturn:
        """End with what is wrong, and where the help is."""
        found = _CHOICE.fullmatch(message)
        if found:
            known = re.findall(r"[\w.-]+", found[3])
            message = f"{found[1]} {found[2]!r} is unknown{near(found[2], known, 'known: ' + ', '.join(known))}"
        self.exit(USAGE, f"{self.prog}: {message}\nhelp, with examples: {self.prog} --help\n")

    def unknown(self, words: Sequence[str]) -> NoReturn:
        """End with arguments that are not known, and near names of the options among them."""
        known = re.findall(r"--[a-z][\w-]*", self.format_help())
        options = [word.partition("=")[0] for word in words if word.startswith("-")]
        if not options:
            self.error(f"too many arguments: {' '.join(words)}")
        self.error("; ".join(f"no option {option}{near(option, known)}" for option in options))


def add_command(
    commands: Any,
    name: str,
    run: Callable[[argparse.Namespace], int],
    purpose: str,
    *,
    about: str = "",
    examples: Sequence[Example] = (),
    codes: str = "",
    aliases: Sequence[str] = (),
) -> argparse.ArgumentParser:
    """Add a command with its help.

    Parameters: commands, what `add_subparsers` returned; purpose, half a line for the list of commands; about, what
    else the help says first; examples, at its end; codes, exit codes of its own; aliases, further names.
    """
    first = f"{purpose[0].upper()}{purpose[1:]}."
    parser: argparse.ArgumentParser = commands.add_parser(
        name,
        aliases=aliases,
        help=purpose,
        description="\n\n".join(filter(None, (first, about))),
        epilog="\n\n".join(filter(None, (example_text(examples), codes))) or None,
        formatter_class=Help,
    )
    parser.set_defaults(command=run, parser=parser)
    return parser


def example_text(examples: Iterable[Example]) -> str:
    """Examples for the end of a help: what each is for, and its line."""
    lines = [f"  # {what}\n  {line}" for line, what in examples]
    return "\n".join(["examples:", *lines]) if lines else ""


def code_text() -> str:
    """All exit codes in words."""
    return "Exit codes: " + "; ".join(f"{code} {words.replace(';', ',')}" for code, words in EXIT_CODES.items()) + "."


def add_model(parser: Any) -> None:
    """Add the model that a command reads."""
    parser.add_argument("model", type=Path, help="model file, TOML or JSON")


def add_json(parser: Any) -> None:
    """Add the wish for results that other programs read."""
    parser.add_argument("--json", action="store_true", help="print the results as JSON on standard output")


def add_quiet(parser: Any, what: str = "report") -> None:
    """Add the wish for silence."""
    parser.add_argument("--quiet", action="store_true", help=f"print no {what}")


def parts(text: str) -> list[str]:
    """What stands between commas."""
    return [part.strip() for part in text.split(",") if part.strip()]


def number_or_text(text: str) -> float | str:
    """A number, or anything else as it stands."""
    try:
        return float(text)
    except ValueError:
        return text


def tell(text: str) -> None:
    """Print a report."""
    sys.stdout.write(text + "\n")


def tell_json(data: Any) -> None:
    """Print results for other programs."""
    tell(as_json(data))


def as_json(data: Any) -> str:
    """Results as JSON; what it has no word for, infinity and the like, is null."""
    return json.dumps(finite(data), indent=2, allow_nan=False)


def finite(value: Any) -> Any:
    """The same with None in place of what JSON cannot say."""
    if isinstance(value, dict):
        return {key: finite(entry) for key, entry in value.items()}
    if isinstance(value, list | tuple):
        return [finite(entry) for entry in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


def wrote(paths: Iterable[Path]) -> list[str]:
    """A line for each file that was written."""
    return [f"wrote {path}" for path in paths]


class FilesError(OSError):
    """Files that cannot be written or read, all at once, found before the work is done."""


def writable(paths: Iterable[Path | None]) -> None:
    """FilesError when one of the files cannot be written, found before the run that would be lost."""
    wrong = [f"{path}: cannot be written: {why}" for path in paths if path is not None and (why := _unwritable(path))]
    if wrong:
        raise FilesError("\n".join(wrong))


def _unwritable(path: Path) -> str:
    if path.is_dir():
        return f"it is a folder; give a file in it, such as {path / 'run.csv'}"
    if path.exists():
        return "" if os.access(path, os.W_OK) else "you may not change this file; give another name"
    folder = path.parent
    # a folder that is missing is made
    while not folder.exists() and folder != folder.parent:
        folder = folder.parent
    if not folder.is_dir():
        return f"{folder} is a file, not a folder; give another path"
    return "" if os.access(folder, os.W_OK) else f"you may not write into {folder}; give another folder"
