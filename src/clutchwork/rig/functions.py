"""The function of every experiment."""

from __future__ import annotations

from clutchwork.rig import experiments as experiments
from clutchwork.rig.experiment import EXPERIMENTS as EXPERIMENTS
from clutchwork.rig.experiment import runner

breakaway = runner("breakaway")
drift = runner("drift")
hysteresis = runner("hysteresis")
judder = runner("judder")
lag = runner("lag")
memory = runner("memory")
stall = runner("stall")
steady = runner("steady")
stick_slip = runner("stick_slip")
