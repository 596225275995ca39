"""Write several FMUs and their connections as one package, SSP 1.0."""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from math import isfinite
from numbers import Real
from pathlib import Path
from typing import Any

from clutchwork.base import FMUError, UseError, near, quote
from clutchwork.base.paths import fitting, path_of
from clutchwork.declare.calls import explained
from clutchwork.fmu import archive
from clutchwork.fmu_import.archive import description_of
from clutchwork.fmu_import.description import INPUT, OUTPUT, PARAMETER, Description, read
from clutchwork.ssp.structure import PARAMETERS, Connector, Package, ParameterValue, parameter_set, powers, structure

# the name of an element is the first word of what stands in a connection
NAME = re.compile(r"[A-Za-z_][A-Za-z0-9_]*")
CALL = "cw.export_ssp"


@explained("cw.export_ssp", path="'car.ssp'", fmus="{'car': 'car.fmu'}")
def export_ssp(
    path: str | Path,
    fmus: Mapping[str, str | Path],
    connections: Iterable[tuple[str, str]] = (),
    *,
    parameters: Mapping[str, float] | None = None,
    t_end: float = 1.0,
    name: str = "",
) -> Path:
    """Write FMUs with their connections and parameters as one package, which other simulators run; its path.

    Use it to hand over a driveline together with its controller. Nothing of the FMUs is run.

    Parameters: fmus, paths by the names of elements, {"car": "car.fmu", "tcu": "tcu.fmu"}, FMI 2.0 for
    co-simulation; connections, pairs from an output to an input, ("tcu.pressure", "car.c1.pressure"); parameters,
    numbers by element and name, {"car.c1.gain": 6e-4}, in the units of the FMU; t_end [s] of the experiment; name of
    the whole, that of the file by default. UseError names all that does not fit, FMUError an FMU that cannot be read.

    Source: System Structure and Parameterization 1.0, https://ssp-standard.org.
    """
    where = fitting(CALL, path, "car.ssp", [".ssp"]).with_suffix(".ssp")
    problems = [f"{quote(key)} is not a name of an element: give a word such as car" for key in fmus if not _fits(key)]
    if not fmus:
        problems.append("fmus is empty: give one at least, {'car': 'car.fmu'}")
    if not isinstance(t_end, Real) or not isfinite(t_end) or t_end <= 0.0:
        problems.append(f"t_end is {quote(t_end)}: give a time in s above 0")
    if problems:
        raise UseError(CALL, problems)
    paths = {key: path_of(CALL, one, "car.fmu") for key, one in fmus.items()}
    read_ = {key: _description(key, one) for key, one in paths.items()}
    ends = list(_connections(read_, connections, problems))
    values = list(_parameters(read_, parameters or {}, problems))
    if problems:
        raise UseError(CALL, problems)
    made = Package(name or where.stem, _tool(), read_, ends, values, float(t_end))
    entries = {"SystemStructure.ssd": structure(made)}
    entries |= {f"resources/{key}.fmu": one.read_bytes() for key, one in paths.items()}
    return archive.write(where, entries | ({PARAMETERS: parameter_set(made)} if values else {}))


def _fits(name: object) -> bool:
    return isinstance(name, str) and NAME.fullmatch(name) is not None


def _description(name: str, path: Path) -> Description:
    try:
        made = read(description_of(path))
    except FMUError as error:
        raise FMUError(f"{name} ({path}): {error}") from None
    if made.version != "2.0":
        raise FMUError(f"{name} ({path}): SSP 1.0 knows FMI 2.0, and this is {made.version}: export it again")
    return made


def _connections(
    fmus: Mapping[str, Description], given: Any, problems: list[str]
) -> Iterable[tuple[Connector, Connector]]:
    """The connections that fit; what does not is a problem."""
    driven: dict[Connector, str] = {}
    for pair in given:
        if not isinstance(pair, list | tuple) or len(pair) != 2:
            problems.append(f"{quote(pair)} is not a connection: give ('tcu.pressure', 'car.c1.pressure')")
            continue
        start, end = (_end(fmus, one, kind, problems) for one, kind in zip(pair, (OUTPUT, INPUT), strict=True))
        if start is None or end is None:
            continue
        one, other = (fmus[at.element].variables[at.connector] for at in (start, end))
        if end in driven:
            problems.append(f"{pair[1]} is driven by {driven[end]} already, and by {pair[0]}: an input has one source")
        elif one.type != other.type:
            problems.append(f"{pair[0]} is {one.type} and {pair[1]} is {other.type}: connect the same types")
        elif None not in (powers(one), powers(other)) and powers(one) != powers(other):
            problems.append(f"{pair[0]} is in {one.unit} and {pair[1]} in {other.unit}, which measure different things")
        else:
            driven[end] = pair[0]
            yield start, end


def _parameters(
    fmus: Mapping[str, Description], given: Mapping[str, Any], problems: list[str]
) -> Iterable[ParameterValue]:
    for name, value in given.items():
        end = _end(fmus, name, PARAMETER, problems)
        if not isinstance(value, Real) or not isfinite(value):
            problems.append(f"{name} is {quote(value)}: give a number")
        elif end is not None:
            yield ParameterValue(end, float(value))


def _end(fmus: Mapping[str, Description], name: Any, kind: str, problems: list[str]) -> Connector | None:
    """An element and its variable, such as car and c1.pressure."""
    element, dot, connector = name.partition(".") if isinstance(name, str) else ("", "", "")
    if element not in fmus or not dot:
        known = near(element, fmus, f"elements are {', '.join(fmus)}")
        problems.append(f"{quote(name)} does not begin with an element and a dot{known}")
        return None
    try:
        fmus[element].variable(connector, kind)
    except FMUError as error:
        problems.append(f"{element}: {error}")
        return None
    return Connector(element, connector)


def _tool() -> str:
    # the package itself, which has all rooms
    from importlib.metadata import version

    return f"clutchwork {version('clutchwork')}"
