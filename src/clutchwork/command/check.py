"""`clutchwork check`: arguments and report."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from clutchwork.base import columns
from clutchwork.base.shell import DONE, add_command, add_json, add_model, tell, tell_json
from clutchwork.command.models import add_set, add_trust, system_of

EXAMPLES = (
    ("clutchwork check model.toml", "all mistakes at once, or what the model has and the ratios of its gears"),
    ("clutchwork check model.toml --names", "what --set may change, and its value"),
    ("clutchwork check model.toml --signals", "what a run computes, with units"),
)


def add_commands(commands: Any) -> None:
    """Add `check`."""
    check = add_command(
        commands, "check", check_command, "check a model and list its ratios, without running it", examples=EXAMPLES
    )
    add_model(check)
    add_set(check)
    add_trust(check)
    check.add_argument("--names", action="store_true", help="list what --set and --vary may change, with its value")
    check.add_argument("--signals", action="store_true", help="list the signals of a run, with their units")
    check.add_argument("--ratio", metavar="A/B", help="shafts whose speed ratio is reported; default: drive and load")
    add_json(check)


def check_command(asked: argparse.Namespace) -> int:
    """Check and report; the exit code."""
    from clutchwork.command import report
    from clutchwork.command.choose import chosen_shafts

    system = system_of(Path(asked.model), asked.set, trust=asked.trust)
    shafts = chosen_shafts(system, asked.ratio)
    names = report.changeable_values(system) if asked.names else {}
    units = report.signal_units(system) if asked.signals else {}
    if asked.json:
        more: dict[str, Any] = {"names": names} if asked.names else {}
        tell_json(report.model_data(system, shafts) | more | ({"signals": units} if asked.signals else {}))
    elif asked.names or asked.signals:
        words = {name: report.in_words(value) for name, value in names.items()}
        lists = [columns([*table.items()]) for table in (words, units) if table]
        tell("\n\n".join(lists))
    else:
        tell(report.model_text(system, shafts))
    return DONE
