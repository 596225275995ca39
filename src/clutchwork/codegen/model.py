"""What is written about one model: its layout as a header, its tables, its bytes."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import cached_property
from math import inf

import numpy as np

from clutchwork.assembly.provenance import SystemParameter
from clutchwork.assembly.system import System
from clutchwork.assembly.wiring import Wiring, wiring
from clutchwork.base import dataclass
from clutchwork.base.bounds import in_words
from clutchwork.base.c_literal import literal
from clutchwork.codegen.text import comment, enumeration, identifiers, string
from clutchwork.declare.layout import CAUSES, EVENT, MODES, STATUS
from clutchwork.declare.options import OPTIONS, Options
from clutchwork.results.channels import Channel, Channels, channels
from clutchwork.results.forms import Mode
from clutchwork.results.rows import numbers
from clutchwork.run.begin import new_run
from clutchwork.run.grid import output_grid

MADE = "Made by clutchwork. Do not edit: export the model again."
BYTES_PER_LINE = 16


@dataclass(frozen=True)
class Exported:
    """A System with its grid, the settings of the solver and the signals that are printed."""

    system: System
    t_end: float  # s
    dt: float  # s
    options: Options
    printed: tuple[str, ...]
    single: bool = False  # precision of its steps

    @cached_property
    def data(self) -> bytes:
        """The frozen System."""
        return self.system.to_bytes()

    @cached_property
    def memory(self) -> int:
        """Memory of a run [bytes]."""
        run = new_run(self.data)
        return int(run.single_size if self.single else run.memory_size)

    @cached_property
    def wiring(self) -> Wiring:
        """Who is joined to what."""
        return wiring(self.system)

    @cached_property
    def signals(self) -> dict[str, Channel]:
        """All signals that are numbers, by name."""
        known = channels(self.system, self.options.angles, self.options.work)
        return {name: item for name, item in known.items() if not _is_text(item)}

    @cached_property
    def functions(self) -> dict[str, str]:
        """The C function of each signal."""
        return dict(zip(self.signals, identifiers("model_get_", self.signals), strict=True))

    @cached_property
    def columns(self) -> list[str]:
        """The identifier of each number of a row."""
        return identifiers("MODEL_ROW_", [name for name, _ in numbers(self.wiring)])

    @property
    def outside(self) -> set[int]:
        """Numbers of the inputs that are set from outside alone."""
        return set(np.flatnonzero(self.system.arrays["input_count"] == 0).tolist())

    @property
    def settable(self) -> dict[str, int]:
        """Parameters and their places, without those that are fixed when a run is loaded."""
        run, values = new_run(self.data), self.system.arrays["params"]
        return {path: k for path, k in self.system.places.items() if run.is_settable(k, float(values[k]))}

    def parameter(self, path: str) -> SystemParameter | None:
        """Description of a number by its path; None: it belongs to a part without a name."""
        return self.system.parameters[path] if path in self.known else None

    @cached_property
    def known(self) -> frozenset[str]:
        """Everything of the driveline that has a name."""
        return frozenset(self.system.parameters) if self.system.source is not None else frozenset()

    @property
    def instants(self) -> int:
        """Number of instants of the grid."""
        grid = output_grid(self.options.changed({"dt": self.dt, "times": None}), self.t_end)
        return 0 if grid is None else len(grid)


def header(model: Exported) -> Iterator[str]:
    """model.h: sizes, settings, layout of rows and events, signals."""
    yield f"/* The model {comment(model.system.name)}. {MADE} */"
    yield from ("#ifndef MODEL_H", "#define MODEL_H", "", "#include <math.h>", "")
    yield from ("#include <clutchwork/c_api.h>", '#include "model_system.h"', "")
    yield "/* Memory of a run, aligned to 16 bytes; cw_load refuses when another machine needs more. */"
    yield from (f"#define MODEL_MEMORY {model.memory}", "")
    yield "/* The grid of main.c: t_start, t_start + dt ... t_end. */"
    yield f"#define MODEL_T_START {literal(model.options.t_start)} /* s */"
    yield f"#define MODEL_T_END {literal(model.t_end)} /* s */"
    yield f"#define MODEL_DT {literal(model.dt)} /* s */"
    yield from (f"#define MODEL_INSTANTS {model.instants}", "")
    yield from _enumerations(model)
    yield from ("#ifdef __cplusplus", 'extern "C" {', "#endif", "")
    yield "/* The settings of the solver with which the model was exported; 0: the core refuses one. */"
    yield from ("int model_set_options(cw_run *run);", "")
    yield "/* Set a number of enum model_param. 1: done; 0: out of its bounds, or fixed once a run has begun. */"
    yield from ("int model_set_param(cw_run *run, int64_t param, double value);", "")
    yield "/* What main.c prints: name, unit, value in a row. */"
    yield "typedef struct {"
    yield from ("  const char *name, *unit;", "  double (*value)(const double *row);", "} model_signal;")
    yield f"#define MODEL_SIGNALS {len(model.printed)}"
    yield from ("extern const model_signal model_signals[MODEL_SIGNALS];", "")
    yield "/* Names of the contacts, in the order of their numbers in events. */"
    contacts = len(model.system.contacts)
    yield from (
        f"#define MODEL_CONTACTS {contacts}",
        f"extern const char *const model_contacts[{max(contacts, 1)}];",
        "",
    )
    yield from ("#ifdef __cplusplus", "}", "#endif", "")
    yield "/* All signals, from one row. */"
    for name, channel in model.signals.items():
        yield f"/* {comment(name)} [{comment(channel.unit)}] */"
        yield f"static inline double {model.functions[name]}(const double *row) {{"
        value = channel.evaluate.c(model.columns)
        yield from (*(["  (void)row;"] if "row" not in value else []), f"  return {value};", "}")
    yield from ("", "#endif")


def _enumerations(model: Exported) -> Iterator[str]:
    """The layout of rows and events, and all that has a number."""
    row = [(column, k, f"{n} [{u}]") for k, (column, (n, u)) in enumerate(zip(model.columns, _row(model), strict=True))]
    yield "/* Where each number stands in a row. */"
    yield from enumeration("model_row", [*row, ("MODEL_ROW_SIZE", len(row), "numbers in a row")])
    yield from (
        "",
        "/* Inputs, as cw_set_input takes them; those from outside alone are at zero until they are set. */",
    )
    names = identifiers("MODEL_INPUT_", [item.name for item in model.system.inputs])
    inputs = [(name, k, _input(model, k)) for k, name in enumerate(names)]
    counts = [("MODEL_INPUTS", len(inputs), "all"), ("MODEL_OUTSIDE", len(model.outside), "from outside alone")]
    yield from enumeration("model_input", [*inputs, *counts])
    yield from ("", "/* Numbers that model_set_param changes: unit, bounds, and when. */")
    settable = model.settable
    count = len(model.system.arrays["params"])
    named = zip(identifiers("MODEL_PARAM_", settable), settable, strict=True)
    members = [(name, settable[path], _parameter(model, path)) for name, path in named]
    yield from enumeration("model_param", [*members, ("MODEL_PARAMS", count, "numbers in the pool")])
    yield from ("", "/* Modes of a contact: slip below zero, locked, slip above zero, open. */")
    yield from enumeration("model_mode", [(f"MODEL_MODE_{name.upper()}", k, "") for k, name in MODES.items()])
    yield from ("", "/* What led to an event. */")
    causes = [(f"MODEL_CAUSE_{word.replace(' ', '_').upper()}", k, meaning) for k, (word, meaning) in CAUSES.items()]
    yield from enumeration("model_cause", causes)
    yield from ("", "/* What cw_advance returns. */")
    statuses = [(f"MODEL_STATUS_{name.upper()}", k, message) for k, (name, message, _) in enumerate(STATUS)]
    refused = (
        "MODEL_STATUS_INVALID_CALL",
        -1,
        "the end time is before the present one or not a number, or there is no room",
    )
    yield from enumeration("model_status", [refused, *statuses])
    yield from ("", "/* Where each number stands in an event. */")
    event = [(f"MODEL_EVENT_{name.upper()}", k, unit) for k, (name, unit) in enumerate(EVENT)]
    yield from (*enumeration("model_event", [*event, ("MODEL_EVENT_SIZE", len(event), "numbers in an event")]), "")


def _input(model: Exported, number: int) -> str:
    item, spec = model.system.inputs[number], model.system.inputs[number].spec
    words = f"{item.name} [{item.unit}]{_within(spec.ends)}"
    return f"{words}, from outside alone" if number in model.outside else words


def _parameter(model: Exported, path: str) -> str:
    found = model.parameter(path)
    return path if found is None else f"{path} [{found.unit}]{_within(found.bounds)}, {found.when}"


def _within(bounds: tuple[float, float]) -> str:
    words = in_words(bounds)
    return f", {words}" if words else ""


def _row(model: Exported) -> list[tuple[str, str]]:
    return numbers(model.wiring)


def tables(model: Exported) -> Iterator[str]:
    """model.c: settings, printed signals, names of contacts."""
    yield from (f"/* {MADE} */", '#include "model.h"', "", "int model_set_options(cw_run *run) {")
    yield "  return 1"
    for name, value in model.options.core_options().items():
        row = OPTIONS[name]
        words = comment(f"[{row.spec.unit}] {row.spec.doc}" if row.unit else row.spec.doc)
        yield f'         && cw_set_option(run, "{name}", {literal(value)}) /* {words} */'
    yield from ("      ;", "}", "")
    yield from _bounds(model)
    yield "const model_signal model_signals[MODEL_SIGNALS] = {"
    for name in model.printed:
        yield f"    {{{string(name)}, {string(model.signals[name].unit)}, {model.functions[name]}}},"
    yield from ("};", "", f"const char *const model_contacts[{max(len(model.system.contacts), 1)}] = {{")
    yield from (f"    {string(contact.name)}," for contact in model.system.contacts)
    yield from (["    0,"] if not model.system.contacts else [])
    yield "};"


def _bounds(model: Exported) -> Iterator[str]:
    """The bounds of parameters as a switch, and the call that keeps them."""
    yield "int model_set_param(cw_run *run, int64_t param, double value) {"
    yield from ("  double low = -INFINITY, high = INFINITY;", "  int fixed = 0;", "  switch (param) {")
    for name, path in zip(identifiers("MODEL_PARAM_", model.settable), model.settable, strict=True):
        found = model.parameter(path)
        if found is not None:
            low, high = map(_limit, found.bounds)
            yield f"    case {name}: low = {low}, high = {high}, fixed = {int(found.stays is not None)}; break;"
    yield from ("    default: return 0;", "  }", "  int64_t counts[7] = {0};", "  cw_statistics(run, counts);")
    yield "  if (!(value >= low && value <= high) || (fixed && counts[0] + counts[1] > 0)) return 0;"
    yield from ("  return cw_set_param(run, param, value);", "}", "")


def _limit(bound: float) -> str:
    return literal(bound) if abs(bound) < inf else "INFINITY" if bound > 0 else "-INFINITY"


def system_header(model: Exported) -> Iterator[str]:
    """model_system.h: the bytes of the frozen System."""
    yield f"/* {MADE} */"
    yield from ("#ifndef MODEL_SYSTEM_H", "#define MODEL_SYSTEM_H", "")
    yield "/* The frozen system, little endian. It must outlive every run that was loaded from it. */"
    yield f"#define MODEL_SYSTEM_BYTES {len(model.data)}"
    yield from ("#ifdef __cplusplus", 'extern "C"', "#else", "extern", "#endif")
    yield from ("    const unsigned char model_system[MODEL_SYSTEM_BYTES];", "", "#endif")


def system_bytes(data: bytes) -> Iterator[str]:
    """model_system.c."""
    yield from (f"/* {MADE} */", '#include "model_system.h"', "")
    yield "_Alignas(16) const unsigned char model_system[MODEL_SYSTEM_BYTES] = {"
    for first in range(0, len(data), BYTES_PER_LINE):
        yield "    " + "".join(f"{byte}," for byte in data[first : first + BYTES_PER_LINE])
    yield "};"


def files(model: Exported) -> dict[str, Iterator[str]]:
    """All files that depend on the model."""
    return {
        "model.h": header(model),
        "model.c": tables(model),
        "model_system.h": system_header(model),
        "model_system.c": system_bytes(model.data),
    }


def _is_text(channel: Channel) -> bool:
    return isinstance(channel.evaluate, Mode) and channel.evaluate.named


def chosen(names: Sequence[str] | None, channels: Channels) -> tuple[str, ...]:
    """The names that are printed, all numbers by default; KeyError with near ones for an unknown name."""
    if names is None:
        return tuple(name for name, item in channels.items() if not _is_text(item))
    for name in names:
        if _is_text(channels[name]):
            raise ValueError(f"{name} is a string: use {name.rpartition('.')[0]}.mode, its number")
    return tuple(names)
