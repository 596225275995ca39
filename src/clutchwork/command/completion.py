"""`clutchwork completion`: a script with which a shell completes commands, options, files and names."""

from __future__ import annotations

import argparse
import sys
from pathlib import Path
from typing import Any

from clutchwork.base.extras import need
from clutchwork.base.shell import DONE, Parser, add_command

SHELLS = {
    "bash": "clutchwork completion bash > ~/.local/share/bash-completion/completions/clutchwork",
    "zsh": "clutchwork completion zsh > ~/.zfunc/_clutchwork    # with fpath+=~/.zfunc before compinit in ~/.zshrc",
    "fish": "clutchwork completion fish > ~/.config/fish/completions/clutchwork.fish",
    "tcsh": "clutchwork completion tcsh > ~/.clutchwork.csh    # with source ~/.clutchwork.csh in ~/.tcshrc",
}


def add_commands(commands: Any) -> None:
    """Add `completion`."""
    completion = add_command(
        commands,
        "completion",
        completion_command,
        "let a shell complete commands, options and files",
        about="It is made from the commands as they are now: make it again after an upgrade. Needs shtab: pip install "
        '"clutchwork[completion]".',
        examples=tuple((line, shell) for shell, line in SHELLS.items()),
    )
    completion.add_argument("shell", choices=list(SHELLS), help="the shell that is to read the script")


def completion_command(asked: argparse.Namespace) -> int:
    """Print the script; the exit code."""
    shtab = need("shtab", "completion", "completion")
    if asked.shell not in shtab.SUPPORTED_SHELLS:
        remedy = "pip install --upgrade shtab"
        raise ImportError(
            f"this version of shtab knows {', '.join(shtab.SUPPORTED_SHELLS)}, not {asked.shell}: {remedy}"
        )
    _mark(asked.top, shtab)
    sys.stdout.write(shtab.complete(asked.top, shell=asked.shell) + "\n")
    return DONE


def _mark(parser: argparse.ArgumentParser, shtab: Any) -> None:
    """Say of each argument what it is: a file, a folder, or one of some names."""
    from clutchwork.command.reference import ROLES, kinds

    # argparse has no other way to ask a parser for its arguments
    for action in parser._actions:  # noqa: SLF001
        if isinstance(action.choices, dict) and all(isinstance(one, Parser) for one in action.choices.values()):
            for inner in action.choices.values():
                _mark(inner, shtab)
        elif action.type is Path:
            vars(action)["complete"] = shtab.DIRECTORY if action.metavar == "DIR" else shtab.FILE
        elif action.dest == "name" and parser.get_default("topic") in ROLES:
            action.choices = [*kinds(parser.get_default("topic"))]
