"""What a sweep is asked for, read and checked before the first run."""

from __future__ import annotations

import os
from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

from clutchwork.assembly.system import System
from clutchwork.base import ModelError, UseError, quote
from clutchwork.declare.options import Options
from clutchwork.run.settings import merged, refuse_endless
from clutchwork.run.simulation import Assembles, refuse_fixed
from clutchwork.sweeps.asking import ROWS
from clutchwork.sweeps.axes import Plan
from clutchwork.sweeps.mistakes import few
from clutchwork.sweeps.outputs import Output, asked
from clutchwork.sweeps.result import Swept
from clutchwork.sweeps.variants import Variants, VariantSource, given

# so many values of a name are all looked at before the first run
MOST_LOOKED_AT = 64


@dataclass(frozen=True, eq=False)
class Order:
    """What is run and kept, and where the variants come from."""

    system: System
    source: VariantSource
    outputs: Mapping[str, Output]
    t_end: float  # s
    options: Options

    def __len__(self) -> int:
        return len(self.source)

    @property
    def whole(self) -> Swept:
        """All variants at once."""
        return self.of(self.source.part(0, len(self)))

    def of(self, variants: Variants) -> Swept:
        """The same with some variants."""
        return Swept(self.system, variants, self.outputs, self.t_end, self.options)

    @property
    def without_variants(self) -> Order:
        """The same for a worker, who gets its variants one chunk at a time."""
        return replace(self, source=Variants((), 0))


def ordered(
    call: str,
    model: Assembles | System,
    t_end: Any,
    vary: Any,
    outputs: Any,
    options: Options | None,
    changes: Mapping[str, Any],
) -> Order:
    """What a call asks for; an error names what is wrong with it."""
    if options is not None and not isinstance(options, Options):
        raise UseError(call, [f"options is {quote(options)}: it must be cw.Options(...)"])
    system, wanted = _system(call, model), asked(outputs)
    source = given(vary) if system.source is None else given(vary).in_si(system.source)
    chosen = {**changes} if t_end is None else {**changes, "t_end": t_end}
    useless = [name for name in ROWS if name in changes]
    if useless:
        remedy = "say when in the outputs: cw.at('load.speed', [1.0, 2.0])"
        raise UseError(call, [f"{' and '.join(useless)} would be without effect: {remedy}"])
    end, settled = merged(system.settings, chosen, options)
    plain = settled.changed({"dt": None, "times": None})
    refuse_endless(system.inputs, plain.t_start, end, plain.max_steps)
    refuse_fixed(system, plain)
    # tables have a column of their own for it
    if "status" in wanted:
        raise UseError(call, ["an output is called 'status', as the column that says how a run ended; rename it"])
    return Order(system, source, wanted, end, plain)


def _system(call: str, model: Assembles | System) -> System:
    if isinstance(model, System):
        return model
    if not hasattr(model, "assemble"):
        raise UseError(call, [f"{quote(model)} is not a model; give a Driveline or a System"])
    return model.assemble()


def threads_of(threads: object, call: str = "sweep") -> int:
    """How many runs go at once; by default as many as there are cores."""
    if threads is None:
        return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    if not isinstance(threads, int) or isinstance(threads, bool) or threads < 1:
        raise UseError(call, [f"threads is {quote(threads)}: give a whole number of at least 1"])
    return threads


def refuse_unfit(system: System, variants: Variants) -> None:
    """ModelError where names are unknown or values are wrong on their own; of many, the ends are looked at."""
    plan = Plan(system, variants.plain)
    problems = plan.find()
    for one in plan.variants.varied:
        if one.name in plan.targets:
            problems += plan.wrong_alone(replace(one, values=_telling(one.values)))
    if problems:
        raise ModelError(few(problems), system.name)


def _telling(values: tuple[Any, ...]) -> tuple[Any, ...]:
    """Bounds are intervals, so that all numbers are right where their ends are."""
    if len(values) > MOST_LOOKED_AT and {float, int}.issuperset(map(type, values)):
        return min(values), max(values)
    return values[:MOST_LOOKED_AT]
