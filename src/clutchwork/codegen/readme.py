"""README.md of an exported model: what is in the folder, how large it is, how a program calls it."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from clutchwork.codegen.model import Exported

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


def readme(model: Exported, memory: int) -> Iterator[str]:
    """The lines; memory of a run [bytes]."""
    yield from (f"# {model.system.name}", "", "Made by clutchwork: a driveline as C, with the core that runs it.", "")
    yield from USE
    yield from ("", "| what | how large |", "|---|---|")
    yield f"| system, constant | {len(model.data)} bytes |"
    yield f"| memory of a run | {memory} bytes |"
    yield f"| numbers in a row | {len(model.columns)} |"
    yield f"| inputs, parameters | {len(model.system.inputs)}, {len(model.settable)} |"
    yield from ("", *NEEDS)
