"""The rig: experiments that distinguish friction laws.

    from clutchwork import rig

    result = rig.drift(["lugre", "elastoplastic", "mykhalevych"])
    print(result)
    result.plot("drift.png")

Every experiment takes `laws` (names, laws, or a mapping from labels to them), a `preset` that gives the parameters of
laws that are named, and its own settings by name. What each one shows stands in its docstring and in docs/guide/rig.md.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from clutchwork.base import near

if TYPE_CHECKING:
    from clutchwork.rig import presets as presets
    from clutchwork.rig.bench import Bench as Bench
    from clutchwork.rig.experiment import EXPERIMENTS as EXPERIMENTS
    from clutchwork.rig.experiment import Experiment as Experiment
    from clutchwork.rig.experiment import Result as Result
    from clutchwork.rig.functions import breakaway as breakaway
    from clutchwork.rig.functions import drift as drift
    from clutchwork.rig.functions import hysteresis as hysteresis
    from clutchwork.rig.functions import judder as judder
    from clutchwork.rig.functions import lag as lag
    from clutchwork.rig.functions import memory as memory
    from clutchwork.rig.functions import stall as stall
    from clutchwork.rig.functions import steady as steady
    from clutchwork.rig.functions import stick_slip as stick_slip
    from clutchwork.rig.looks import title as title
    from clutchwork.rig.presets import PRESETS as PRESETS
    from clutchwork.rig.presets import Preset as Preset
    from clutchwork.rig.table import Table as Table

# names that are loaded when they are first used, with their module: the command line imports this package to ask less
_LAZY = {
    "Bench": "bench",
    "Experiment": "experiment",
    "PRESETS": "presets",
    "Preset": "presets",
    "Result": "experiment",
    "Table": "table",
    "title": "looks",
}
# names that need the experiments to be known
_KNOWING = (
    "EXPERIMENTS", "breakaway", "drift", "hysteresis", "judder", "lag", "memory", "stall", "steady", "stick_slip",
)  # fmt: skip
__all__ = [*sorted([*_LAZY, *_KNOWING]), "presets"]


if not TYPE_CHECKING:
    # to a type checker any name would do
    def __getattr__(name: str) -> Any:
        if name == "presets":
            return import_module("clutchwork.rig.presets")
        if name in _LAZY:
            return getattr(import_module(f"clutchwork.rig.{_LAZY[name]}"), name)
        if name in _KNOWING:
            return getattr(import_module("clutchwork.rig.functions"), name)
        raise AttributeError(f"clutchwork.rig has no {name!r}{near(name, __all__)}")


def __dir__() -> list[str]:
    return sorted(__all__)
