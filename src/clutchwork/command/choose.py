"""What a command line names: signals with wildcards, two shafts."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import TYPE_CHECKING

from clutchwork.assembly.wiring import wiring
from clutchwork.base import UseError, near
from clutchwork.results.ratios import input_and_output
from clutchwork.results.selection import chosen
from clutchwork.results.units import among

if TYPE_CHECKING:
    from clutchwork.assembly.system import System
    from clutchwork.results.channels import Channel

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


def given_units(wanted: Sequence[str], known: Mapping[str, Channel]) -> dict[str, str]:
    """Units by name or pattern of `--units NAME=UNIT`; an error names all that fit no signal of a run."""
    # a name may hold an equals sign itself
    cut = [text.rpartition("=") for text in wanted]
    wrong = [text for text, (name, _, unit) in zip(wanted, cut, strict=True) if not name.strip() or not unit.strip()]
    if wrong:
        raise UseError("run", [f"--units {text}: write NAME=UNIT, such as '*.speed=rpm'" for text in wrong])
    found = {name.strip(): unit.strip() for name, _, unit in cut}
    among({**{name: channel.unit for name, channel in known.items()}, "time": "s"}, found)
    return found


def chosen_shafts(system: System, asked: str | None) -> tuple[str, str] | None:
    """The two shafts of `--ratio A/B`, by default drive and load, or those of a gearbox; None where there are none."""
    if asked is None:
        ends = [(table.input, table.output) for table in system.gearboxes]
        return input_and_output(wiring(system)) or (ends[0] if len(ends) == 1 else None)
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
