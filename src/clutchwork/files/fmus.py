"""FMUs of other people in a model file: [[fmu]] with name, path, period, inputs, parameters, time_limit."""

from __future__ import annotations

import os
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from clutchwork.base import FMUError, Problem, UseError, near, quote
from clutchwork.fmu_import.fmu import FMU

# what says where it is, then what it is told
KEYS = ("name", "path", "period", "inputs", "parameters", "time_limit")
UNTRUSTED = "runs a library of another program with your permissions"


def fmu(entry: Mapping[str, Any], name: str, folder: str, *, trust: bool) -> FMU | list[Problem]:
    """An FMU of a model file, or all that is wrong with it."""
    path = f'fmu "{name}"'
    problems = [
        Problem(path, str(key), f"is an unknown key{near(key, KEYS)}", remedy=f"known keys: {', '.join(KEYS)}")
        for key in entry
        if key not in KEYS
    ]
    missing = [key for key in ("path", "period") if key not in entry]
    problems += [Problem(path, key, "is missing", remedy=f"give a {key}") for key in missing]
    if not isinstance(entry.get("path", ""), str):
        problems.append(Problem(path, "path", "must be a string", quote(entry["path"]), "give the path of an FMU"))
    if not trust:
        in_python = "cw.Driveline.load(path, trust=True)"
        remedy = f"where you know where it is from give --trust to run or check, or in Python {in_python}"
        problems.append(Problem(path, "", UNTRUSTED, remedy=remedy))
    if problems:
        return problems
    given = {key: value for key, value in entry.items() if key in KEYS[2:]}
    try:
        return FMU(Path(folder, entry["path"]), trust=True, name=name, **given)
    except UseError as error:
        return [Problem(path, "", fault) for fault in error.problems]
    except FMUError as error:
        return [Problem(path, "path", str(error), quote(entry["path"]))]


def table(made: FMU, name: str, folder: str | None) -> dict[str, Any]:
    """An FMU as a model file holds it, by a name of the model; its path relative to a folder."""
    path = str(made.path) if folder is None else Path(os.path.relpath(made.path, folder or ".")).as_posix()
    more = {key: dict(value) for key in ("inputs", "parameters") if (value := getattr(made, key))}
    return {"name": name, "path": path, "period": made.period, **more, "time_limit": made.time_limit}
