"""The rig: experiments that tell friction laws apart.

    from clutchwork import rig

    result = rig.drift(["lugre", "elastoplastic", "mykhalevych"])
    print(result)
    result.plot("drift.png")

Every experiment takes `laws` (names, laws, or a mapping from labels to them), a `preset` that gives the parameters of
laws that are named, and its own settings by name. What each one shows stands in its docstring and in docs/guide/rig.md.
"""

from __future__ import annotations

from clutchwork.rig import experiments as experiments
from clutchwork.rig.bench import Bench as Bench
from clutchwork.rig.experiment import EXPERIMENTS as EXPERIMENTS
from clutchwork.rig.experiment import Experiment as Experiment
from clutchwork.rig.experiment import Result as Result
from clutchwork.rig.experiment import runner
from clutchwork.rig.looks import title as title
from clutchwork.rig.presets import PRESETS as PRESETS
from clutchwork.rig.presets import Preset as Preset
from clutchwork.rig.table import Table as Table

breakaway = runner("breakaway")
drift = runner("drift")
hysteresis = runner("hysteresis")
judder = runner("judder")
lag = runner("lag")
memory = runner("memory")
stall = runner("stall")
steady = runner("steady")
stick_slip = runner("stick_slip")
