"""`clutchwork plot`: the picture of a stored run, or of several, to compare them."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from clutchwork.base.shell import DONE, FilesError, add_command, add_json, tell, tell_json, writable, wrote
from clutchwork.declare.wording import words_of_files

if TYPE_CHECKING:
    from clutchwork.run.trajectory import Trajectory

# endings of model files
MODELS = (".toml", ".json")
PICTURES = (".png", ".svg", ".pdf")
EXAMPLES = (
    ("clutchwork run model.toml --save first.run", "store a run"),
    ("clutchwork plot first.run", "its picture, first.png"),
    ('clutchwork plot first.run c1.slip "*.speed" --out speeds.svg', "some of its signals"),
    ("clutchwork plot first.run second.run c1.torque", "the same signal of two runs, to compare them"),
)


def add_commands(commands: Any) -> None:
    """Add `plot`."""
    plot = add_command(commands, "plot", plot_command, "draw a stored run, or compare several", examples=EXAMPLES)
    plot.add_argument("run", type=Path, help="file that clutchwork run --save wrote")
    plot.add_argument(
        "more", nargs="*", default=(), help="more of them, to compare; then signals, such as c1.slip or '*.speed'"
    )
    plot.add_argument("--out", type=Path, metavar="FILE", help="picture (png, svg or pdf); default: named as the run")
    add_json(plot)


def split(first: Path, more: Sequence[str]) -> tuple[list[Path], list[str]]:
    """The files and the signals: a file is there, or ends as the first one does."""
    files = [word for word in more if Path(word).is_file() or (first.suffix != "" and word.endswith(first.suffix))]
    return [first, *map(Path, files)], [word for word in more if word not in files]


def plot_command(asked: argparse.Namespace) -> int:
    """Draw, and say where; the exit code."""
    with words_of_files():
        return _plotted(asked)


def _plotted(asked: argparse.Namespace) -> int:
    import clutchwork as cw

    files, names = split(asked.run, asked.more)
    path = asked.out or Path(asked.run.with_suffix(".png").name)
    writable([path])
    runs = dict(zip(labels(files), _loaded(files), strict=True))
    if len(files) == 1:
        plot: Any = runs[labels(files)[0]].plot
        plot(*names, path=path)
    else:
        cw.compare(runs, *names, path=path)
    if asked.json:
        tell_json({"runs": [str(file) for file in files], "signals": names, "files": [str(path)]})
    else:
        tell("\n".join(wrote([path])))
    return DONE


def _loaded(files: Sequence[Path]) -> list[Trajectory]:
    """The stored runs; FilesError names all files that hold none."""
    import clutchwork as cw

    runs, wrong = list["Trajectory"](), list[str]()
    for file in files:
        if file.suffix.lower() in PICTURES:
            wrong.append(f"{file}: is a picture; give the run first: clutchwork plot first.run --out {file}")
            continue
        if file.suffix in MODELS and file.is_file():
            wrong.append(f"{file}: is a model; run it first: clutchwork run {file} --save {file.stem}.run")
            continue
        try:
            runs.append(cw.load_run(file))
        except cw.ClutchworkError as error:
            wrong.append(str(error))
    if wrong:
        raise FilesError("\n".join(wrong))
    return runs


def labels(files: Sequence[Path]) -> list[str]:
    """Short names of files that tell them apart."""
    stems = [file.stem for file in files]
    return stems if len(set(stems)) == len(stems) else [str(file) for file in files]
