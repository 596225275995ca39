"""`clutchwork new`: a commented model to start from."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import Any

from clutchwork.base.shell import DONE, add_command, add_json, tell, tell_json, writable, wrote
from clutchwork.base.writing import put

STARTS = Path(__file__).resolve().parent / "starts"
# what each is, and an option of `run` to try with it
KINDS = {
    "two-discs": ("a clutch closes between a turning disc and one at rest", '--set "c1.pressure=3 bar"'),
    "launch": ("a car is launched by a dry clutch that gets hot", "--set car.mass=1600"),
    "gearbox": ("a planetary set with two clutches shifts under load", '--set "c2.pressure.start=0.6 s"'),
    "torsion": (
        "inertias with springs between them, and a torque that shakes them",
        "--set exciter.torque.frequency=10",
    ),
    "wet-clutch": ("a wet clutch whose piston has to fill", '--set "piston.fill_time=150 ms"'),
}
FIRST = "two-discs"


def add_commands(commands: Any) -> None:
    """Add `new`."""
    new = add_command(
        commands,
        "new",
        new_command,
        "write a commented model to start from",
        about="Kinds:\n" + "\n".join(f"  {kind:<12}{what}" for kind, (what, _) in KINDS.items()),
        examples=(
            ("clutchwork new", f"{FIRST}, as model.toml"),
            ("clutchwork new car.toml --kind launch", "another kind, with a name of your own"),
        ),
    )
    new.add_argument(
        "file", nargs="?", type=Path, default=Path("model.toml"), help="file to write; default: model.toml"
    )
    new.add_argument("--kind", choices=list(KINDS), default=FIRST, help=f"which model; default: {FIRST}")
    new.add_argument("--force", action="store_true", help="overwrite a file that is there")
    add_json(new)


def new_command(asked: argparse.Namespace) -> int:
    """Write the model and say what to do next; the exit code."""
    path = asked.file if asked.file.suffix else asked.file.with_suffix(".toml")
    if path.suffix.lower() != ".toml":
        raise ValueError(f"{path}: a commented model is written as TOML; give a name that ends in .toml")
    writable([path])
    if path.exists() and not asked.force:
        raise FileExistsError(f"{path} is there already; give another name, or --force to overwrite it")
    put(path, start(asked.kind))
    what, attempt = KINDS[asked.kind]
    shown = f'"{path}"' if " " in str(path) else str(path)
    steps = [
        ("check it", f"clutchwork check {shown}"),
        ("run it, and see the picture", f"clutchwork run {shown} --plot {path.stem}.png"),
        ("try another value", f"clutchwork run {shown} {attempt}"),
        ("see what else may be changed", f"clutchwork check {shown} --names"),
        ("see all elements", "clutchwork elements"),
    ]
    if asked.json:
        tell_json({"file": str(path), "kind": asked.kind, "next": [line for _, line in steps]})
    else:
        lines = [f"  # {words}\n  {line}" for words, line in steps]
        tell("\n".join([*wrote([path]), what, "", "next:", *lines]))
    return DONE


def start(kind: str) -> str:
    """The text of a model of a kind."""
    return (STARTS / f"{kind}.toml").read_text(encoding="utf-8")
