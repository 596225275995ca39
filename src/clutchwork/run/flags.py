"""The options of a run as arguments of a command line."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterable, Mapping
from typing import Any

from clutchwork.declare.docs import default_in_words
from clutchwork.declare.options import SIMULATION
from clutchwork.declare.quantity import QuantityError, in_si
from clutchwork.declare.setting import Setting

DEFAULTS = {"t_end": "t_end of that table"}


def add_options(
    parser: argparse.ArgumentParser, names: Iterable[str] = SIMULATION, defaults: Mapping[str, str] = DEFAULTS
) -> None:
    """Add an argument for each of the options; a number may have a unit, such as "1 ms".

    Parameters: names of the options; defaults, the text shown for options without a default value.
    """
    group = parser.add_argument_group("options of the run", "they overrule the [simulation] table of the model file")
    for name in names:
        row = SIMULATION[name]
        kinds: dict[str, Any] = {"type": _reader(row), "metavar": _metavar(row)}
        if row.spec.flag:
            kinds = {"action": argparse.BooleanOptionalAction}
        elif row.spec.choices:
            kinds = {"choices": row.spec.choices}
        group.add_argument(f"--{name.replace('_', '-')}", help=_help(row, defaults.get(name, "")), **kinds)


def given_options(asked: argparse.Namespace) -> dict[str, Any]:
    """The options that a command line gives."""
    return {name: value for name in SIMULATION if (value := getattr(asked, name, None)) is not None}


def _reader(row: Setting) -> Callable[[str], Any]:
    """What turns the text of an argument into a value in SI."""

    def number(text: str) -> Any:
        try:
            plain = float(text)
        except ValueError:
            return _converted(text, row.spec.unit)
        return int(plain) if row.spec.whole and plain.is_integer() else plain

    def numbers(text: str) -> list[Any]:
        return [number(part) for part in text.split(",")]

    return numbers if row.spec.what == "numbers" else number


def _converted(text: str, unit: str) -> Any:
    try:
        return in_si(text, unit)
    except QuantityError as bad:
        raise argparse.ArgumentTypeError(str(bad)) from None


def _metavar(row: Setting) -> str:
    one = row.spec.unit.upper() if row.unit else "N" if row.spec.whole else "X"
    return f"{one},{one},..." if row.spec.what == "numbers" else one


def _help(row: Setting, default: str) -> str:
    """Meaning, unit and default."""
    unit = f" [{row.spec.unit}]" if row.unit else ""
    if not default and row.default is not None:
        default = default_in_words(row.default, row.spec)
    words = f"{row.spec.doc}{unit}" + (f"; default: {default}" if default else "")
    # argparse fills in what follows a percent sign
    return words.replace("%", "%%")
