"""The commands of the command line and their arguments, asked of its parser."""

from __future__ import annotations

import argparse

from clutchwork.command.main import parser


def commands() -> list[str]:
    """Names of all commands."""
    return list(_commands())


def options(name: str) -> list[argparse.Action]:
    """Arguments of one command."""
    return list(_commands()[name]._actions)


def _commands() -> dict[str, argparse.ArgumentParser]:
    (found,) = [action for action in parser()._actions if isinstance(action, argparse._SubParsersAction)]
    named: dict[int, tuple[str, argparse.ArgumentParser]] = {}
    for name, one in found.choices.items():
        # the first name of each; others are spellings of it
        named.setdefault(id(one), (name, one))
    return dict(named.values())
