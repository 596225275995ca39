"""What a sweep may be asked for: outputs as a command line writes them, and options of single runs alone."""

from __future__ import annotations

# options that say which rows a single run has
ROWS = ("dt", "times", "output", "points")
# what may follow the name of a signal or contact
CALLS = {
    "at": "INSTANT[, INSTANT ...]",
    "maximum": "",
    "minimum": "",
    "peak": "",
    "integral": "",
    "squared_jerk": "SHAFT",
    "jerk": "WINDOW",
    "lock": "NUMBER",
    "break_away": "NUMBER",
}
OF = {"SHAFT": "SHAFT", "WINDOW": "SHAFT[, WINDOW]", "NUMBER": "CONTACT[, NUMBER]", "": "SIGNAL"}
FORMS = [f"{call}({OF.get(more, f'SIGNAL, {more}')})" for call, more in CALLS.items()]
KNOWN = f"known: {', '.join(FORMS)}"
