"""What was measured in one run, and what was done in it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import field
from pathlib import Path
from typing import Any

from clutchwork.base import dataclass
from clutchwork.fit.columns import columns


@dataclass(frozen=True, eq=False)
class Record:
    """One measured run of a driveline, for `fit_records`.

    Parameters: time [s], rising, at which the samples were taken; the run begins at 0 s. measured, samples by the name
    of the signal, "engine.speed", a row of numbers or, where a signal has instants of its own, a pair (times, values).
    inputs, what drove this run by the name of the input, "c1.pressure": a row over `time`, a pair, a number or a
    signal. start, initial values of this run, {"engine.speed": 150.0}. deviation, standard deviation of the noise by
    signal, a number or one for each sample, by which samples count; without any, each signal counts by its own size.
    units, in which numbers of `measured` and `inputs` are by name, where that is not SI. name, for messages.
    """

    time: Any = field(repr=False)
    measured: Mapping[str, Any] = field(repr=False)
    inputs: Mapping[str, Any] = field(default_factory=dict, repr=False)
    start: Mapping[str, Any] = field(default_factory=dict)
    deviation: Mapping[str, Any] = field(default_factory=dict)
    units: Mapping[str, str] = field(default_factory=dict)
    name: str = ""
    # columns of a file that say none, by name
    without_unit: Mapping[str, str] = field(default_factory=dict, repr=False)

    @classmethod
    def read(
        cls,
        path: str | Path,
        measured: Mapping[str, str],
        inputs: Mapping[str, str] | None = None,
        *,
        time: str = "time",
        window: Sequence[float] | None = None,
        start: Mapping[str, Any] | None = None,
        deviation: Mapping[str, Any] | None = None,
        group: str | None = None,
        name: str = "",
    ) -> Record:
        """A record from a CSV, MDF, MAT, Parquet or NetCDF file.

        Parameters: measured and inputs, columns by the name of the signal or the input: {"engine.speed": "n_eng"},
        with a unit where the file says none, "n_eng [1/min]", otherwise they are taken as SI, which `notes` of the fit
        say; time, column with the times, where it is not called "time"; window, begin and end [s]
        of what is used: times count from its begin. start, deviation, which is in SI, and name as of `Record`, by
        default the name of the file; group, of the channels of an MDF file.

        Units of the file are converted, those that do not fit are refused by the fit. FitError names all columns that
        cannot be used.
        """
        asked = {**measured, **(inputs or {})}
        found = columns(path, asked, time, group, window)
        pairs = {key: (one.times, one.values) for key, one in found.items()}
        return cls(
            next(iter(pairs.values()))[0],
            {key: pairs[key] for key in measured},
            {key: pairs[key] for key in inputs or {}},
            dict(start or {}),
            dict(deviation or {}),
            {key: one.unit for key, one in found.items() if one.unit},
            name or Path(path).stem,
            {key: asked[key] for key, one in found.items() if not one.unit},
        )
