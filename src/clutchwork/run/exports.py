"""What a run offers to other programs."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from clutchwork.declare.calls import explained
from clutchwork.results.recorded import Recorded

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path
    from typing import TypeAlias

    Units: TypeAlias = Mapping[str, str] | None


class Exports(Recorded):
    """Ways out of a run. All take the same choice of signals and instants.

    Parameters: names, signals by name, or wildcards such as `c1.*` and `*.speed`, all by default; dt, distance of the
    instants [s], or times, the instants [s], all of the run by default. Other instants are computed, as by `at`, not
    interpolated. units, other ones than those of SI by signal, `*` for any characters: `{"engine.speed": "rpm",
    "*.pressure": "bar", "time": "ms"}`; events stay in SI. path, with the
    ending of the format or none; its folder is made. UnknownName, a KeyError, lists all names that mean nothing, with
    near ones; UseError all units that do not fit.
    """

    @explained("run.to_csv")
    def to_csv(
        self, path: str | Path, names: Any = None, *, dt: float | None = None, times: Any = None, units: Units = None
    ) -> None:
        """Write signals as columns `name [unit]` with 17 digits, the time first: for Excel, and for `cw.Column`."""
        self._write("csv", path, names, dt, times, units)

    @explained("run.to_parquet", path="'run.parquet'")
    def to_parquet(
        self, path: str | Path, names: Any = None, *, dt: float | None = None, times: Any = None, units: Units = None
    ) -> None:
        """Write a Parquet file, a column for each signal with its unit. Needs pyarrow."""
        self._write("parquet", path, names, dt, times, units)

    @explained("run.to_mdf", path="'run.mf4'")
    def to_mdf(
        self, path: str | Path, names: Any = None, *, dt: float | None = None, times: Any = None, units: Units = None
    ) -> None:
        """Write an MDF 4 file, a channel for each signal with its unit, and the events; time in s. Needs asammdf."""
        self._write("mdf", path, names, dt, times, units)

    @explained("run.to_mat", path="'run.mat'")
    def to_mat(
        self, path: str | Path, names: Any = None, *, dt: float | None = None, times: Any = None, units: Units = None
    ) -> None:
        """Write a MAT file with a structure `run`: signals, units, names, events. Needs scipy."""
        self._write("mat", path, names, dt, times, units)

    @explained("run.to_netcdf", path="'run.nc'")
    def to_netcdf(
        self, path: str | Path, names: Any = None, *, dt: float | None = None, times: Any = None, units: Units = None
    ) -> None:
        """Write a NetCDF file, a variable for each signal with its unit, and the events. Needs xarray and h5netcdf."""
        self._write("netcdf", path, names, dt, times, units)

    @explained("run.write")
    def write(
        self, path: str | Path, names: Any = None, *, dt: float | None = None, times: Any = None, units: Units = None
    ) -> None:
        """Write the format that the ending of the file names: .csv, .parquet, .mf4, .mat or .nc."""
        self._write("", path, names, dt, times, units)

    @explained("run.to_pandas")
    def to_pandas(self, names: Any = None, *, dt: float | None = None, times: Any = None, units: Units = None) -> Any:
        """A pandas DataFrame over time; `frame.attrs["units"]` holds the units. Needs pandas."""
        from clutchwork.exchange.content import content
        from clutchwork.exchange.frames import to_pandas

        return to_pandas(content(self, names, dt, times, units))

    @explained("run.to_xarray")
    def to_xarray(self, names: Any = None, *, dt: float | None = None, times: Any = None, units: Units = None) -> Any:
        """An xarray Dataset with units as attributes. Needs xarray."""
        from clutchwork.exchange.content import content
        from clutchwork.exchange.frames import to_xarray

        return to_xarray(content(self, names, dt, times, units))

    def _write(self, form: str, path: str | Path, names: Any, dt: float | None, times: Any, units: Units) -> None:
        from clutchwork.exchange import write

        write(self, path, names, dt, times=times, units=units, form=form)
