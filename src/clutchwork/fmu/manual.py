"""What is written inside of an FMU about it: how to use it, its variables, its licence."""

from __future__ import annotations

from clutchwork.base import html
from clutchwork.base.bounds import in_words
from clutchwork.fmu.description import structured
from clutchwork.fmu.interface import Interface
from clutchwork.fmu.variables import FmuVariable, VariableKind

HOW = (
    "Contacts lock, slip and break away inside of the steps of this FMU, at their exact instants, whatever the step "
    "size of the master.",
    "Inputs are held over a step where nothing else is said, which lags behind a ramp by half a step. Give their rates "
    "too, as {rates}: then a ramp is exact.",
    "Fixed parameters are set before the initialisation ends, tunable ones at any time. Values out of bounds are "
    "refused, with a message in the log, and nothing changes.",
    "Events are messages of the log category `events`.",
)
RATES = {"2.0": "input derivatives (fmi2SetRealInputDerivatives)", "3.0": "the inputs der(...)"}
PARTS = (
    ("Inputs", (VariableKind.INPUT, VariableKind.SLOPE)),
    ("Parameters", (VariableKind.TUNABLE, VariableKind.FIXED)),
    ("Outputs", (VariableKind.SIGNAL, VariableKind.MODE)),
)


def manual(made: Interface, version: str) -> bytes:
    """The page of an FMU."""
    parts = [html.heading(made.system.name)]
    parts += [html.paragraph(words.format(rates=RATES[version])) for words in HOW]
    for title, kinds in PARTS:
        known = [one for _, one in made.of(*kinds) if not one.hidden]
        known = [one for one in known if version == "3.0" or one.kind is not VariableKind.SLOPE]
        head = ("name", "unit", "start", "bounds", "kind", "meaning")
        parts += [html.heading(title), html.table(head, map(_line, known), most=len(known))]
    if made.not_exchanged:
        parts += [html.heading("Why it is not for model exchange")]
        parts += [html.paragraph(why) for why in made.not_exchanged]
    if made.left_out:
        parts += [
            html.heading("Numbers that are not parameters"),
            html.table(("name", "why"), made.left_out, most=len(made.left_out)),
        ]
    body = html.page(*parts)
    called = f"<title>{html.text(made.system.name)}</title>"
    top = f'<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8">{called}</head>'
    return f"{top}<body>{body}</body></html>\n".encode()


def _line(one: FmuVariable) -> tuple[str, ...]:
    given = one.kind in (VariableKind.INPUT, VariableKind.SLOPE, VariableKind.TUNABLE, VariableKind.FIXED)
    kind = one.kind.name.lower() if given else ""
    return structured(one.name), one.unit, f"{one.start:g}" if given else "", in_words(one.bounds), kind, one.about
