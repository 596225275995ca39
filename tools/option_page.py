"""The reference page of the options of a run, from the table that `Options` is."""

from __future__ import annotations

from collections.abc import Iterator

from clutchwork.declare.docs import default_in_words
from clutchwork.declare.options import SIMULATION
from clutchwork.declare.setting import Setting

INTRODUCTION = """# Options of a run

Every option goes by the same name through every door:

- `d.simulate(2.0, rtol=1e-8)` and `cw.simulate(...)`, or all of them as `options=cw.Options(rtol=1e-8)`;
- `d.simulation["rtol"] = 1e-8`, the settings of a driveline, which its `System` carries too;
- `rtol = 1e-8` below `[simulation]` of a [model file](../guide/model-files.md), where a time may have a unit, `"1 ms"`;
- `clutchwork run model.toml --rtol 1e-8`, `--max-step "1 ms"`, and `--no-work` for one that is true or false;
- `cw_set_option(run, "rtol", 1e-8)` in [C](../guide/export.md), for those that the core knows.

A run takes what the call or the command line gives, else what the settings of its model say, else the default.
`options=cw.Options(...)` replaces all settings of the model but `t_end`.

| option | unit | default | values | in C | meaning |
|---|---|---|---|---|---|"""

AFTER = """
`dt` and `times` exclude each other: the one that a call gives replaces the other in the settings of the model. The
steps of the solver do not depend on the output that is asked for. In C a word is its number, true is 1 and false is 0.
"""


def page() -> str:
    """The page."""
    return "\n".join([INTRODUCTION, *_rows(), AFTER])


def _rows() -> Iterator[str]:
    for name, row in SIMULATION.items():
        default = "required" if name == "t_end" else default_in_words(row.default, row.spec)
        cells = (f"`{name}`", row.unit.strip(), default, _values(row), _in_c(row), row.spec.doc)
        yield f"| {' | '.join(cells)} |"


def _values(row: Setting) -> str:
    """What it may be."""
    if row.spec.choices:
        return ", ".join(f"`{word}`" for word in row.spec.choices)
    if row.spec.flag:
        return "`true`, `false`"
    return f"list, {row.spec.bound}" if row.spec.what == "numbers" else row.spec.bound


def _in_c(row: Setting) -> str:
    """Whether the core knows it, and its numbers there."""
    if not row.core:
        return ""
    if row.spec.optional:
        return f"yes; {'INFINITY' if row.unset else '0'}: none"
    return ", ".join(f"{number} `{word}`" for number, word in enumerate(row.spec.choices)) or "yes"
