"""What a command line names: signals with wildcards, two shafts."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

from clutchwork.assembly.wiring import wiring
from clutchwork.base.errors import near
from clutchwork.results.ratios import input_and_output
from clutchwork.results.selection import chosen

if TYPE_CHECKING:
    from clutchwork.assembly.system import System

WHERE = "clutchwork check MODEL --signals lists all"


def chosen_signals(known: Iterable[str], wanted: Sequence[str]) -> tuple[str, ...]:
    """Names of signals, in the order in which they are asked for.

    Parameters: known, all names; wanted, names or wildcards such as "c1.*" and "*.speed", several in one with commas
    between them. UnknownName lists all that lead nowhere.
    """
    names = list(known)
    return chosen([part for text in wanted for part in _parts(text, names)], names, lambda one: _fault(one, names))


def _fault(wanted: str, names: Sequence[str]) -> str:
    wild = "*" in wanted or "?" in wanted
    told = f"; {WHERE}" if wild else near(wanted, names, WHERE)
    return f"--signals: no signal {'matches' if wild else 'is called'} {wanted!r}{told}"


def _parts(text: str, names: Sequence[str]) -> list[str]:
    """What stands between commas; a name may hold one itself."""
    return [text] if text in names else [part.strip() for part in text.split(",") if part.strip()]


def chosen_shafts(system: System, asked: str | None) -> tuple[str, str] | None:
    """The two shafts of `--ratio A/B`, by default drive and load; None where there are none."""
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
