"""One law on the bench, and what its runs gave."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TypeVar

from clutchwork.base import dataclass, near
from clutchwork.rig.bench import Bench
from clutchwork.rig.presets import Preset
from clutchwork.run.trajectory import Trajectory

# cases of one law by name
Runs = Mapping[str, Trajectory]
NOT_REACHED = float("nan")

V = TypeVar("V")


@dataclass(frozen=True, eq=False)
class Trial:
    """One law on the bench, and what its runs gave."""

    bench: Bench
    runs: Runs

    @property
    def preset(self) -> Preset:
        """The preset of the bench."""
        return self.bench.preset

    def __getitem__(self, case: str) -> Trajectory:
        """The run of one case; KeyError with a near match for an unknown one."""
        return found(self.runs, case, "case")

    @property
    def early(self) -> list[Trajectory]:
        """Runs that stopped before their end."""
        return [run for run in self.runs.values() if not run.finished]

    @property
    def note(self) -> str:
        """Why runs are incomplete, in a few words; empty when all are complete."""
        return f"{self.early[0].status} at {self.early[0].time[-1]:.4g} s" if self.early else ""


def found(mapping: Mapping[str, V], key: str, what: str) -> V:
    """What a mapping holds under a name; KeyError with a near match when it holds none."""
    if key not in mapping:
        rest = f"there are {', '.join(mapping)}"
        raise KeyError(f"no {what} {key!r}{near(key, mapping, rest)}")
    return mapping[key]
