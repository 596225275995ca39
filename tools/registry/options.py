"""The settings of a run that the core knows: a struct with their defaults, and what each may be."""

from __future__ import annotations

import math
from collections.abc import Iterator

from clutchwork.declare.options import OPTIONS
from clutchwork.declare.schema import Spec


def options() -> Iterator[str]:
    """The struct Options and a function that visits its members."""
    rows = {name: row for name, row in OPTIONS.items() if row.core}
    yield "/// Settings of a run."
    yield "struct Options {"
    for name, row in rows.items():
        kind = option_type(name, row.spec)
        unit = f"[{row.spec.unit}] " if row.unit else ""
        yield f"  {kind} {name} = {kind}({number(row.number(row.default))});  ///< {unit}{row.spec.doc}"
    yield "};"
    yield "/// What a setting may be; `unset` is a number that stands for none, NaN where there is no such number."
    yield "struct OptionRange {"
    yield "  double least, most, unset;"
    yield "  bool whole;"
    yield "  constexpr bool allows(double x) const {"
    yield "    return x == unset || (x >= least && x <= most && (!whole || x == double(std::int64_t(x))));"
    yield "  }"
    yield "};"
    yield "/// Calls f(setting, its name, its range) for all settings, in order."
    yield "template <class O, class F> void visit_options(O& o, F&& f) {"
    for name, row in rows.items():
        unset = row.unset if row.spec.optional else math.nan
        numbers = ", ".join(number(x) for x in (row.least, row.most, unset))
        yield f'  f(o.{name}, "{name}", OptionRange{{{numbers}, {str(row.whole).lower()}}});'
    yield "}"


def option_type(name: str, spec: Spec) -> str:
    """The C++ type of a setting; the numbers of a choice are those of an enumeration of the layout."""
    if spec.choices:
        return name.capitalize()
    return "bool" if spec.flag else "std::int64_t" if spec.whole else "double"


def number(x: float) -> str:
    """A double, exactly."""
    if math.isnan(x):
        return '__builtin_nan("")'
    return repr(float(x)) if math.isfinite(x) else "__builtin_huge_val()"
