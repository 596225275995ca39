"""`clutchwork ssp`: arguments, report and file."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from clutchwork.base import shell

EXAMPLES = (
    (
        "clutchwork ssp car.ssp --fmu car=car.fmu --fmu tcu=tcu.fmu --connect tcu.pressure=car.c1.pressure",
        "a driveline and its controller, one connection",
    ),
    ("clutchwork ssp car.ssp --fmu car=car.fmu --set car.c1.gain=6e-4 --t-end 2", "with a parameter"),
)


def add_command(subparsers: Any) -> None:
    """Add `ssp` to the commands of the command line."""
    ssp = shell.add_command(
        subparsers,
        "ssp",
        ssp_command,
        "write FMUs and their connections as one package, SSP 1.0",
        about="`clutchwork fmu` makes an FMU of a model; those of other programs may be among them.",
        examples=EXAMPLES,
    )
    ssp.add_argument("package", type=Path, help="the file that is written, car.ssp")
    many: dict[str, Any] = {"action": "append", "default": []}
    ssp.add_argument("--fmu", metavar="NAME=FILE", **many, help="an FMU and its name; may be given several times")
    ssp.add_argument("--connect", metavar="OUT=IN", **many, help="an output and the input that it drives, with names")
    ssp.add_argument("--set", metavar="NAME=VALUE", **many, help="a parameter, in the unit of its FMU")
    ssp.add_argument("--t-end", type=float, metavar="S", default=1.0, help="end of the experiment [s]; default: 1")
    shell.add_json(ssp)


def ssp_command(asked: argparse.Namespace) -> int:
    """Write and report; the exit code."""
    # loaded where a package is written
    from clutchwork.ssp.export import export_ssp

    shell.writable([asked.package])
    values = {name: shell.number_or_text(value) for name, value in _pairs("--set", asked.set)}
    path = export_ssp(
        asked.package,
        dict(_pairs("--fmu", asked.fmu)),
        _pairs("--connect", asked.connect),
        parameters=values,  # type: ignore[arg-type]
        t_end=asked.t_end,
    )
    if asked.json:
        shell.tell_json({"path": str(path)})
    else:
        shell.tell(f"wrote {path}")
    return shell.DONE


def _pairs(option: str, given: Sequence[str]) -> list[tuple[str, str]]:
    """What stands on both sides of an equals sign."""
    wrong = [one for one in given if "=" not in one]
    if wrong:
        raise ValueError(f"{option} {wrong[0]}: write it with an equals sign, such as a=b")
    return [(name, value) for name, _, value in (one.partition("=") for one in given)]
