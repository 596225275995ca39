"""Write a model with the core as a folder that builds without Python."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from clutchwork.base import UseError, quote
from clutchwork.base.paths import fitting
from clutchwork.base.paths import folder as made_folder
from clutchwork.base.writing import put
from clutchwork.codegen.model import Exported, chosen, files
from clutchwork.codegen.parts import FILE, parts
from clutchwork.codegen.readme import readme
from clutchwork.codegen.sources import GENERATED, sources
from clutchwork.declare.calls import explained
from clutchwork.declare.options import Options
from clutchwork.driveline.driveline import Driveline
from clutchwork.results.channels import channels
from clutchwork.run.begin import new_run
from clutchwork.run.settings import merged

if TYPE_CHECKING:
    from clutchwork.assembly.system import System

TEMPLATES = Path(__file__).parent / "templates"
# intervals of the grid when no spacing is given
INTERVALS = 1000
# main.c holds its rows in static memory, [bytes]
MOST_MEMORY = 2**28


@explained("cw.export_c")
def export_c(
    model: Driveline | System,
    folder: str | Path,
    *,
    t_end: float | None = None,
    signals: Sequence[str] | None = None,
    options: Options | None = None,
    whole_core: bool = False,
    **changes: Any,
) -> Path:
    """Write C and C++ of a Driveline or a System into a folder; its path.

    Parameters: t_end [s]; signals, names of what main.c prints, all by default; options, an `Options`, or its fields by
    name (rtol=, dt=, method= ...); whole_core, whether the core has all kinds of elements and laws, so that its library
    serves other models too, else those of this model. What is left out is that of the settings of the model, as for
    `simulate`. `make` in the folder builds it, with a C and a C++20 compiler and nothing else. What is in it:
    docs/guide/export.md.
    """
    where = fitting("cw.export_c", folder, "c")
    if not (isinstance(model, Driveline) or hasattr(model, "settings")):
        raise UseError("cw.export_c", [f"model is {quote(model)}: give a Driveline or a System"])
    system = model if not isinstance(model, Driveline) else model.assemble()
    end, made = merged(system.settings, changes if t_end is None else {**changes, "t_end": t_end}, options)
    if made.times is not None:
        raise ValueError("times cannot be exported: give dt, the spacing of the grid")
    known = channels(system, made.angles, made.work)
    exported = Exported(system, end, made.dt or (end - made.t_start) / INTERVALS, made, chosen(signals, known))
    _refuse_large(exported)
    return _write(exported, made_folder(where), whole_core)


def _refuse_large(exported: Exported) -> None:
    size = 8 * exported.instants * len(exported.columns)
    if size > MOST_MEMORY:
        words = f"{exported.instants} instants need {size / 2**20:.0f} MiB of static memory"
        raise ValueError(f"dt is {exported.dt:g} s: {words}; use a larger dt")


def _write(exported: Exported, folder: Path, whole: bool) -> Path:
    about = {"README.md": readme(exported, new_run(exported.data).memory_size)}
    for name, lines in {**files(exported), **about}.items():
        _put(folder / name, ("\n".join(lines) + "\n").encode())
    core = {**sources(), GENERATED / FILE: ("\n".join(parts(exported.system, whole)) + "\n").encode()}
    for path, content in core.items():
        _put(folder / "core" / path, content)
    # these belong to their editor
    for template in sorted(TEMPLATES.iterdir()):
        if not (folder / template.name).exists():
            _put(folder / template.name, template.read_bytes())
    return folder


def _put(path: Path, content: bytes) -> None:
    """Write a file; one that is the same keeps its date, so that it is not compiled again."""
    if not path.is_file() or path.read_bytes() != content:
        put(path, content)
