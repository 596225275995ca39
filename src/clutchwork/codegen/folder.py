"""Write a model with the core as a folder that builds without Python."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

from clutchwork.assembly.system import System
from clutchwork.base import UseError, quote
from clutchwork.base.paths import fitting
from clutchwork.base.paths import folder as made_folder
from clutchwork.base.writing import put
from clutchwork.codegen.model import Exported, chosen, files
from clutchwork.codegen.precision import is_single
from clutchwork.codegen.single import refuse
from clutchwork.codegen.sources import GENERATED, sources
from clutchwork.declare.calls import explained
from clutchwork.declare.options import Options
from clutchwork.declare.schema import Role
from clutchwork.driveline.driveline import Driveline
from clutchwork.results.channels import channels
from clutchwork.run.settings import merged

TEMPLATES = Path(__file__).parent / "templates"
# intervals of the grid when no spacing is given
INTERVALS = 1000
# main.c holds its rows in static memory, [bytes]
MOST_MEMORY = 2**28
USE = """\
    make           # model: the whole run at once; model_steps: a step at a time
    ./model > model.csv
    make report    # sizes, stack, time of a step and the longest one, on the machine that runs it
    make SMALL=1   # the least code, with the same numbers""".splitlines()
NEEDS = """\
No call allocates on the heap, throws, or writes anywhere but into the memory that it is given. It needs memcpy,
memmove, memset, memcmp and strcmp, floor, fmod, sqrt and nearbyint, and nothing else of a C library.

The core is compiled with what this model uses alone: `core/include/clutchwork/parts.gen.hpp`. Another export into this
folder compiles it again only where its model uses other parts.

`model.h` has every input, signal and parameter by name, with unit and bounds; `model_set_param` refuses what is out of
bounds or fixed. `core/include/clutchwork/c_api.h` says what each call does.""".splitlines()
NEEDS_OF_SINGLES = ("", "Its steps, of single precision, need floorf, fmodf, sqrtf and nearbyintf as well.")
FILE = "parts.gen.hpp"
# arrays with the kinds of each role
KINDS = {
    Role.TORQUE: "element_kind",
    Role.CONTACT: "contact_kind",
    Role.LAW: "contact_law",
    Role.FLOW: "flow_kind",
    Role.PROCESS: "process_kind",
}
SMALL, SPARSE, FULL = 1, 2, 4


@explained("cw.export_c")
def export_c(
    model: Driveline | System,
    folder: str | Path,
    *,
    t_end: float | None = None,
    signals: Sequence[str] | None = None,
    options: Options | None = None,
    whole_core: bool = False,
    precision: str = "double",
    **changes: Any,
) -> Path:
    """Write C and C++ of a Driveline or a System into a folder; its path.

    Parameters: t_end [s]; signals, names of what main.c prints, all by default; options, an `Options`, or its fields by
    name (rtol=, dt=, method= ...); whole_core, whether the core has all kinds of elements and laws, so that its library
    serves other models too, else those of this model; precision of the steps of method="fixed", "single" for processors
    without another one. What is left out is that of the settings of the model, as for `simulate`. `make` in the folder
    builds it, with a C and a C++20 compiler and nothing else. What is in it:
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
    single = is_single(precision)
    if single:
        refuse(system, made)
    spacing = made.dt or (end - made.t_start) / INTERVALS
    exported = Exported(system, end, spacing, made, chosen(signals, known), single)
    _refuse_large(exported)
    return _write(exported, made_folder(where), whole_core)


def _refuse_large(exported: Exported) -> None:
    size = 8 * exported.instants * len(exported.columns)
    if size > MOST_MEMORY:
        words = f"{exported.instants} instants need {size / 2**20:.0f} MiB of static memory"
        raise ValueError(f"dt is {exported.dt:g} s: {words}; use a larger dt")


def _write(exported: Exported, folder: Path, whole: bool) -> Path:
    about = {"README.md": readme(exported, exported.memory)}
    for name, lines in {**files(exported), **about}.items():
        _put(folder / name, ("\n".join(lines) + "\n").encode())
    core = {**sources(), GENERATED / FILE: ("\n".join(parts(exported.system, whole, exported.single)) + "\n").encode()}
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


def readme(model: Exported, memory: int) -> Iterator[str]:
    """README.md of an exported model; memory of a run [bytes]."""
    yield from (f"# {model.system.name}", "", "Made by clutchwork: a driveline as C, with the core that runs it.", "")
    yield from USE
    yield from ("", "| what | how large |", "|---|---|")
    yield f"| system, constant | {len(model.data)} bytes |"
    yield f"| memory of a run | {memory} bytes |"
    yield f"| numbers in a row | {len(model.columns)} |"
    yield f"| inputs, parameters | {len(model.system.inputs)}, {len(model.settable)} |"
    yield from ("", *NEEDS)
    if model.single:
        yield from NEEDS_OF_SINGLES


def parts(system: System, whole: bool, single: bool = False) -> Iterator[str]:
    """The header that says what a model needs, which registry.gen.hpp includes.

    Kinds and forms, all of them where it is to be `whole`, and whether steps have single precision.
    """
    yield from ("// What the exported model needs of the core; a System that needs more is refused.", "#pragma once")
    yield from ("// one run at a time", "#define CLUTCHWORK_ALONE")
    if single:
        yield from ("// steps of one length have single precision", "#define CLUTCHWORK_SINGLE")
    if whole:
        return
    for role, array in KINDS.items():
        kinds = set(system.arrays[array].tolist())
        # a switch has at least one case
        mask = sum(1 << kind for kind in kinds) or 1
        yield f"#define CLUTCHWORK_{role.value.upper()} {mask:#x}ull"
    yield f"#define CLUTCHWORK_FORMS {FULL if system.full[0] else SMALL + SPARSE}"
