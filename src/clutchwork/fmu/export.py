"""Export a driveline as an FMU."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from importlib.metadata import version as installed
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from clutchwork.assembly.system import System
from clutchwork.base import UseError, html, quote
from clutchwork.base.bounds import in_words
from clutchwork.base.errors import warn
from clutchwork.base.paths import fitting
from clutchwork.codegen.sources import licence
from clutchwork.declare.calls import explained
from clutchwork.declare.options import Options
from clutchwork.driveline.driveline import Driveline
from clutchwork.fmu import archive
from clutchwork.fmu.description import description, structured
from clutchwork.fmu.interface import KINDS, Interface, advice, interface
from clutchwork.fmu.libraries import libraries
from clutchwork.fmu.names import plain
from clutchwork.fmu.resource import resource
from clutchwork.fmu.variables import FmuVariable, VariableKind
from clutchwork.run.settings import merged

VERSIONS = ("2.0", "3.0")
PICTURES = {"2.0": "model.png", "3.0": "terminalsAndIcons/icon.png"}
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


@explained("cw.export_fmu", path="'car.fmu'")
def export_fmu(
    model: Driveline | System,
    path: str | Path,
    *,
    inputs: Sequence[str] | str = (),
    outputs: Sequence[str] | str | None = None,
    parameters: Sequence[str] | str | None = None,
    version: str = "2.0",
    kinds: Sequence[str] | str | None = None,
    picture: bool = True,
    t_end: float | None = None,
    options: Options | None = None,
    **changes: Any,
) -> Path:
    """Write a Driveline or a System as an FMU, which other simulators run; its path.

    Use it to take a plant model into Simulink, a vehicle simulation or a test bench: it holds the compiled core and
    needs neither Python nor a compiler. Contacts lock and break away inside of its steps as in `simulate`.

    Parameters: inputs, names of signals that the other simulator sets, such as "c1.pressure"; outputs, names of
    results, all by default; parameters, names of numbers that it may change, all that can be by default; version of
    FMI, "2.0" or "3.0"; kinds, "co-simulation", "model exchange" or both, all that the driveline can be by default;
    picture, whether the schematic goes with it, for which the extra `draw` is needed; t_end [s] and options (rtol=,
    t_start= ...) as for `simulate`, by default those of the settings of the model. UseError names all that does not
    fit. Variables, units and how masters should set inputs: docs/guide/fmu.md.

    Source: Functional Mock-up Interface 2.0.5 and 3.0.2, https://fmi-standard.org.
    """
    where = fitting("cw.export_fmu", path, "car.fmu", [".fmu"])
    if not isinstance(model, Driveline | System):
        raise UseError("cw.export_fmu", [f"model is {quote(model)}: give a Driveline or a System"])
    if version not in VERSIONS:
        raise UseError("cw.export_fmu", [f"version is {quote(version)}: give '2.0' or '3.0'"])
    system = model.assemble() if isinstance(model, Driveline) else model
    end, chosen = merged(system.settings, _with_end(system, changes, t_end, options), options)
    wanted, numbers, asked = (None if names is None else plain(names) for names in (outputs, parameters, kinds))
    if asked is not None and (not asked or set(asked) - set(KINDS)):
        raise UseError("cw.export_fmu", [f"kinds is {quote(kinds)}: give 'co-simulation', 'model exchange' or both"])
    made = interface(system, end, chosen, plain(inputs), wanted, numbers, asked, version)
    for one in advice(made, system):
        warn(one)
    return archive.write(where.with_suffix(".fmu"), _entries(made, where.stem, version, picture))


def _with_end(
    system: System, changes: Mapping[str, Any], t_end: float | None, options: Options | None
) -> dict[str, Any]:
    """What the call gives; an FMU has no end of its own, so that a second is as good as any."""
    known = t_end if t_end is not None else system.settings.get("t_end")
    own = system.settings.get("t_start", 0.0) if options is None else options.t_start
    begin = changes.get("t_start", own)
    return {**changes, "t_end": known if known is not None else float(begin) + 1.0}


def _entries(made: Interface, name: str, version: str, picture: bool) -> dict[str, bytes]:
    """What is in the archive, by path."""
    identifier, content = identifier_of(made.system.name or name), resource(made)
    tool = f"clutchwork {installed('clutchwork')}"
    entries = {
        "modelDescription.xml": description(made, identifier, content.token, version, tool),
        "resources/model.cw": content.content,
        "documentation/index.html": manual(made, version),
        "documentation/licenses/license.txt": licence(),
    }
    for library in libraries():
        entries[f"binaries/{library.folders[version]}/{identifier}{library.ending}"] = library.content()
    if picture and made.system.source is not None:
        entries[PICTURES[version]] = _picture(made.system)
    return entries


def identifier_of(name: str) -> str:
    """A name of the model that C and all file systems take."""
    plain = re.sub(r"\W+", "_", name, flags=re.ASCII).strip("_")
    return plain if re.match(r"[A-Za-z]", plain) else f"model_{plain}".rstrip("_")


def _picture(system: System) -> bytes:
    """The schematic."""
    # it needs an extra, which an FMU without a picture does not
    from clutchwork.driveline.draw import draw

    with TemporaryDirectory() as folder:
        path = Path(folder) / "model.png"
        draw(system, path)
        return path.read_bytes()


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
