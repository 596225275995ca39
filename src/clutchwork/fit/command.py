"""`clutchwork fit`: arguments, report and files."""

from __future__ import annotations

import argparse
import re
import warnings
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

from clutchwork.base import shell
from clutchwork.base.writing import put, replaced

if TYPE_CHECKING:
    from clutchwork.declare.node import Law
    from clutchwork.fit.result import FitResult
    from clutchwork.fit.unknown import Bounds

DETERMINED, OPEN = 0, 1
EXAMPLES = (
    (
        "clutchwork fit measured.csv --law stribeck --slip slip --torque M --start static=0.15,kinetic=0.1,speed=2",
        "a Stribeck curve; units stand in the head of the file",
    ),
    (
        "clutchwork fit measured.csv --law coulomb --slip slip --torque M --load load --start "
        "static=0.15,kinetic=0.1 --bounds kinetic=0.05:0.2",
        "coefficients under a measured load, within bounds",
    ),
)
_LISTS = re.compile(r"[-+.\de]+(//?[-+.\de]+)+", re.IGNORECASE)
_POINTS = re.compile(r"[^:/]+:[^:/]+(/[^:/]+:[^:/]+)*")


def add_command(subparsers: Any) -> None:
    """Add `fit` to the commands of the command line."""
    fit = shell.add_command(
        subparsers,
        "fit",
        fit_command,
        "parameters of a friction law from measured slip and torque",
        examples=EXAMPLES,
        codes="Exit code 1: the samples do not determine all free parameters, or the residuals are not noise; the "
        "results are written nevertheless.",
    )
    fit.add_argument("file", type=Path, help="CSV file; a unit in brackets after the name of a column is converted")
    fit.add_argument("--law", required=True, metavar="KIND", help="friction law, such as stribeck")
    fit.add_argument("--slip", required=True, metavar="COL", help="column of the slip [rad/s or m/s]")
    fit.add_argument("--torque", required=True, metavar="COL", help="column of the friction torque [N m or N]")
    fit.add_argument(
        "--load", default="1", metavar="COL", help="column or value of the torque per coefficient, default 1"
    )
    fit.add_argument("--temperature", metavar="COL", help="column or value [K], for a law that depends on it")
    fit.add_argument("--time", default="time", metavar="COL", help="column of the time [s], default time")
    fit.add_argument(
        "--start",
        required=True,
        metavar="NAME=VALUE,...",
        help="start values, points of a curve as x:y/x:y, lists as y/y, rows of lists as y/y//y/y",
    )
    fit.add_argument(
        "--free", metavar="NAME,...", help="parameters to be fitted; default: all that do not start at zero"
    )
    fit.add_argument("--bounds", metavar="NAME=LOW:HIGH,...", help="narrower bounds; a side may be empty")
    fit.add_argument("--rest", type=float, metavar="SLIP", help="abs(slip) below which a sample counts as at rest")
    fit.add_argument("--confidence", type=float, default=0.95, help="confidence of the intervals, default 0.95")
    fit.add_argument("--loss", default="linear", help="linear, soft_l1, huber or cauchy: how outliers count")
    fit.add_argument("--out", type=Path, metavar="DIR", default=Path("out", "fit"), help="default: out/fit")
    shell.add_json(fit)


def fit_command(asked: argparse.Namespace) -> int:
    """Fit, report, write; the exit code."""
    from clutchwork.fit.law import fit_csv

    shell.writable([asked.out / "fit.json"])
    result = fit_csv(
        asked.file,
        law_from_text(asked.law, asked.start),
        slip=asked.slip,
        torque=asked.torque,
        time=asked.time,
        load=shell.number_or_text(asked.load),
        temperature=None if asked.temperature is None else shell.number_or_text(asked.temperature),
        free=None if asked.free is None else shell.parts(asked.free),
        bounds=_bounds(asked.bounds),
        rest=asked.rest,
        confidence=asked.confidence,
        loss=asked.loss,
    )
    data = result.data() | {"friction": law_data(result.law)}
    files = list(_write(result, data, asked.out))
    if asked.json:
        text = shell.as_json(data | {"files": [str(path) for path in files]})
    else:
        text = "\n".join([str(result), "", _model_line(result.law), "", *shell.wrote(files)])
    shell.tell(text)
    return DETERMINED if result.determined else OPEN


def law_from_text(kind: str, text: str) -> Law:
    """A law from its kind and `name=value,...`, read as in a model file: units, near matches and bounds included."""
    from clutchwork.base.errors import ModelWarning
    from clutchwork.driveline.driveline import Driveline

    values = {name: _value(value) for name, value in _pairs("--start", text)}
    shaft = {"name": "shaft", "inertia": 1.0}
    # a law without a temperature of its own takes that of a thermal node
    thermal = {"name": "lining", "capacity": 1.0}
    element = {"name": "--start", "type": "bearing_friction", "shaft": "shaft", "torque": 1.0, "heat": "lining"}
    element |= {"friction": {"type": kind} | values}
    data = {"name": "--law and --start", "shaft": [shaft], "thermal": [thermal], "element": [element]}
    with warnings.catch_warnings():
        # the fitted values count, not those at the start
        warnings.simplefilter("ignore", ModelWarning)
        bearing: Any = Driveline.from_dict(data).elements[0]
    law: Law = bearing.friction
    return law


def law_data(law: Law) -> dict[str, Any]:
    """A law as in a model file."""
    from clutchwork.declare.node import Node
    from clutchwork.elements.bearing_friction import BearingFriction
    from clutchwork.files.writer import Writer

    bearing = BearingFriction("bearing", shaft=Node("shaft"), friction=law, torque=1.0)
    data: dict[str, Any] = Writer(None, embed=True).element(bearing)["friction"]
    return data


def _model_line(law: Law) -> str:
    """The line of a model file."""
    from clutchwork.files.writer import toml

    line = toml({"element": {"friction": _rounded(law_data(law))}}).splitlines()[-1]
    return f"for a model file (all digits are in fit.json):\n{line}"


def _rounded(value: Any) -> Any:
    """The same with numbers of six digits."""
    if isinstance(value, dict):
        return {key: _rounded(entry) for key, entry in value.items()}
    if isinstance(value, list):
        return [_rounded(entry) for entry in value]
    return float(f"{value:.6g}") if isinstance(value, float) else value


def _pairs(option: str, text: str) -> Iterator[tuple[str, str]]:
    for part in text.split(","):
        name, sign, value = (word.strip() for word in part.partition("="))
        if not (name and sign and value):
            raise ValueError(f"{option}: {part.strip()!r} is not name=value; separate the pairs with commas")
        yield name, value


def _value(text: str) -> Any:
    """A number, points, lists, true or false, or a word, which may be a number with a unit."""
    if _POINTS.fullmatch(text):
        return [[_number("--start", number) for number in pair.split(":")] for pair in text.split("/")]
    if _LISTS.fullmatch(text):
        rows = [[_number("--start", number) for number in row.split("/")] for row in text.split("//")]
        return rows if len(rows) > 1 else rows[0]
    if text in ("true", "false"):
        return text == "true"
    return shell.number_or_text(text)


def _number(option: str, text: str) -> float:
    try:
        return float(text)
    except ValueError:
        raise ValueError(f"{option}: {text!r} is not a number") from None


def _bounds(text: str | None) -> Bounds | None:
    if text is None:
        return None
    made = {}
    for name, value in _pairs("--bounds", text):
        low, colon, high = value.partition(":")
        if not colon:
            raise ValueError(f"--bounds: {value!r} of {name} is not low:high; leave a side empty for no bound")
        made[name] = (_number("--bounds", low) if low else None, _number("--bounds", high) if high else None)
    return made


def _write(result: FitResult, data: dict[str, Any], folder: Path) -> Iterator[Path]:
    """Results, samples and, last, the picture, which needs a package more."""
    import numpy as np

    yield put(folder / "fit.json", shell.as_json(data) + "\n")
    path, samples = folder / "samples.csv", result.samples
    force, speed = ("N", "m/s") if samples.translation else ("N m", "rad/s")
    head = f"time [s],slip [{speed}],load [{force}],measured [{force}],fitted [{force}],equation"
    columns = [samples.time, samples.slip, samples.load, samples.torque, result.fitted, result.equations]
    if samples.temperature is not None:
        head, columns = f"{head},temperature [K]", [*columns, samples.temperature]
    table = np.column_stack(columns)
    with replaced(path) as new:
        np.savetxt(new, table, delimiter=",", header=head, comments="", fmt="%.10g")
    yield path
    result.plot(folder / "fit.png")
    yield folder / "fit.png"
