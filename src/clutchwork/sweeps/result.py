"""What a sweep found: an array for each output, how each variant ended, and tables for other programs."""

from __future__ import annotations

import json
from collections import Counter
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from clutchwork.base import ModelError, UnknownName, UseError, counted, near, quote
from clutchwork.base.extras import need
from clutchwork.base.paths import fitting
from clutchwork.base.writing import put_csv, replaced
from clutchwork.declare.calls import explained, explained_methods
from clutchwork.declare.layout import DONE, INTERRUPTED, STATUSES
from clutchwork.results.channels import Channels, channels
from clutchwork.results.selection import chosen
from clutchwork.run.simulation import told
from clutchwork.sweeps.outputs import AtTimes, Computed, FeltJerk, Integral, Output, SquaredJerk, When
from clutchwork.sweeps.single import single
from clutchwork.sweeps.table import Shown

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping

    from clutchwork.assembly.system import System
    from clutchwork.declare.options import Options
    from clutchwork.run.trajectory import Trajectory
    from clutchwork.sweeps.batch import Block
    from clutchwork.sweeps.variants import Variants, Varied

Array = NDArray[Any]


@dataclass(frozen=True, eq=False)
class Swept:
    """What a sweep was asked for."""

    system: System
    variants: Variants
    outputs: Mapping[str, Output]
    t_end: float  # s
    options: Options


class OutputWarning(UserWarning):
    """A function that a sweep asks raised; its value is missing for that variant."""


class Missing(NamedTuple):
    """An output that could not be had of a variant, and why."""

    variant: int
    output: str
    reason: str

    def __str__(self) -> str:
        return f"output {self.output!r} of variant {self.variant}: {self.reason}"


@explained_methods("sweep")
@dataclass(frozen=True, eq=False)
class Sweep:
    """The result of a sweep.

    `result["lock(c1)"]` is an array with one value for each variant, in the shape of the grid where there is one;
    outputs at several instants have these as their last axis. `result.names` lists all outputs, `result.status` how
    each variant ended: "done", or why it stopped early.
    """

    swept: Swept = field(repr=False)
    codes: NDArray[np.int32] = field(repr=False)  # of the status of each variant, layout.STATUS
    detail: NDArray[np.float64] = field(repr=False)
    values: dict[str, Array] = field(repr=False)  # one line for each variant, whatever the shape
    problems: list[Missing] = field(repr=False, default_factory=list)  # values that are missing, for a function raised

    @classmethod
    def empty(cls, swept: Swept) -> Sweep:
        """Nothing is done yet."""
        count = len(swept.variants)
        return cls(swept, np.full(count, INTERRUPTED, dtype=np.int32), np.full((count, 4), np.nan), {})

    def take(self, block: Block) -> None:
        """Take over what the core gave for some variants."""
        last = block.first + len(block.status)
        self.codes[block.first : last] = block.status
        self.detail[block.first : last] = block.detail
        for name, values in block.values.items():
            if name not in self.values:
                self.values[name] = empty_like(values, len(self))
            self.values[name][block.first : last] = values

    def take_one(self, number: int, found: Mapping[str, Any], status: str) -> None:
        """Take over what was made of the run of one variant."""
        if self.codes[number] == INTERRUPTED:
            self.codes[number] = STATUSES.index(status)
        for name, value in found.items():
            if name not in self.values:
                self.values[name] = self._column(name, value)
            self.values[name][number] = value

    def _column(self, name: str, first: Any) -> Array:
        one = self.swept.outputs[name]
        if isinstance(one, AtTimes):
            return empty_like(np.asarray(first)[np.newaxis], len(self))
        return np.full(len(self), None, dtype=object)

    # ------------------------------------------------------------------------------------------------------ what it has

    @property
    def names(self) -> tuple[str, ...]:
        """Names of all outputs."""
        return tuple(self.swept.outputs)

    @property
    def varied(self) -> tuple[str, ...]:
        """Names of the values that vary."""
        return tuple(one.name for one in self.swept.variants.varied)

    @property
    def shape(self) -> tuple[int, ...]:
        """Number of values of each name of a grid, or number of variants."""
        return (len(self),) if self.swept.variants.shape is None else self.swept.variants.shape

    @property
    def coords(self) -> dict[str, Array]:
        """The axes of a grid, or the columns of a table: what varies, as numbers or labels."""
        varied = self.swept.variants.varied
        if self.swept.variants.shape is None:
            return {one.name: one.column for one in varied}
        return {one.name: np.array(one.labels) for one in varied}

    @property
    def units(self) -> dict[str, str]:
        """Unit of every output, and of every value that varies; empty for those of functions, signals and laws."""
        known = channels(self.swept.system, True, True)
        varied = {self._given(one.name): one.unit for one in self.swept.variants.varied if _is_number(one)}
        return varied | {name: unit_of(one, known) for name, one in self.swept.outputs.items()}

    @property
    def status(self) -> Array:
        """How each variant ended, in the shape of the grid."""
        return np.array(STATUSES)[self.codes].reshape(self.shape)

    @property
    def finished(self) -> NDArray[np.bool_]:
        """Which variants reached the end time, in the shape of the grid."""
        return np.array(self.codes == DONE).reshape(self.shape)

    def __len__(self) -> int:
        """Number of variants."""
        return len(self.codes)

    def __contains__(self, name: object) -> bool:
        return name in self.swept.outputs

    def __getitem__(self, name: str) -> Array:
        """An output of all variants, in the shape of the grid; KeyError with near names when there is none."""
        if name not in self.swept.outputs:
            known = (*self.swept.outputs, *self.varied)
            raise UnknownName(f"no output {quote(name)}{near(name, known, '`sweep.names` lists all outputs')}")
        values = self.flat(name)
        return values.reshape((*self.shape, *values.shape[1:]))

    def flat(self, name: str) -> Array:
        """An output with one line for each variant."""
        if name in self.values:
            found = self.values[name]
            return _plain(found) if found.dtype == object else found
        one = self.swept.outputs[name]
        return np.full((len(self), len(one.times)) if isinstance(one, AtTimes) else len(self), np.nan)

    def variant(self, number: int) -> dict[str, Any]:
        """The values of one variant by name; variants are counted in the order of the flat arrays."""
        return self.swept.variants[self._counted(number)]

    def _counted(self, number: object) -> int:
        """The number of a variant; UseError where there is none of it."""
        if isinstance(number, int | np.integer) and not isinstance(number, bool) and -len(self) <= number < len(self):
            return int(number)
        remedy = f"give a whole number from 0 to {len(self) - 1}" if len(self) else "the sweep has no variants"
        raise UseError("sweep", [f"there is no variant {quote(number)}; {remedy}"])

    def run(self, number: int) -> Trajectory:
        """The run of one variant, as `simulate` gives it."""
        swept = self.swept
        return single(swept.system, self.variant(number), swept.t_end, swept.options)

    def message(self, number: int) -> str:
        """Why a variant stopped early, with what to do; empty when it reached the end."""
        code = int(self.codes[self._counted(number)])
        if code == DONE:
            return ""
        component, time, value, column = self.detail[number].tolist()
        if np.isnan(component):
            return "was not run"
        try:
            system = self.swept.system.changed(self.variant(number))
        except ModelError:
            system = self.swept.system
        return told(system, code, int(component), time, value, int(column))

    def __repr__(self) -> str:
        return f"<{self._words()}; {', '.join(self.names)}>"

    def _words(self) -> str:
        """How many variants there are, and how they ended."""
        ends = Counter(np.array(STATUSES)[self.codes].tolist())
        told_of = ", ".join(f"{count} {name}" for name, count in ends.most_common())
        return f"Sweep of {counted(len(self), 'variants')}: {told_of}"

    def __str__(self) -> str:
        """What `print` shows: how the variants ended, and the first lines of the table."""
        return self._shown().text()

    def _repr_html_(self) -> str:
        """The first lines of the table for a notebook."""
        return self._shown().page()

    def _shown(self) -> Shown:
        notes = list(self.without_values())
        return Shown(repr(self), len(self), dict(self.columns()), self.column_units(), notes)

    def without_values(self) -> Iterator[str]:
        """A line for each output that some variants do not have, such as the lock-up of a clutch that never locks."""
        for name in self.names:
            if count := self.without_value(name):
                yield f"{name}: no value in {count} of {counted(len(self), 'variants')}"

    def without_value(self, name: str) -> int:
        """How many variants have no value of an output: a contact that never locks, a run that stopped before it."""
        values = self[name].reshape(len(self), -1)
        if values.dtype.kind == "f":
            return int(np.isnan(values).any(axis=1).sum())
        return sum(any(value is None or (isinstance(value, str) and not value) for value in line) for line in values)

    # --------------------------------------------------------------------------------------------------------- tables

    def columns(self, names: Any = None) -> Iterator[tuple[str, Array]]:
        """Columns of a table with one line for each variant: values that vary, outputs, the status.

        Parameters: names, outputs by name, or wildcards such as `*.heat`, all by default.
        """
        picked = self._picked(names)
        for one in self.swept.variants.varied:
            yield self._given(one.name), one.column
        for name in picked:
            values = self.flat(name)
            lines = values.T if isinstance(self.swept.outputs[name], AtTimes) else [values]
            yield from zip(self._columns_of(name), lines, strict=True)
        yield "status", np.array(STATUSES)[self.codes]

    def column_units(self, names: Any = None) -> dict[str, str]:
        """The unit of each column of `columns` that has one; a value at an instant has that of its output."""
        units = self.units
        made = {self._given(one): units.get(self._given(one), "") for one in self.varied}
        for name in self._picked(names):
            made |= dict.fromkeys(self._columns_of(name), units[name])
        return {column: unit for column, unit in made.items() if unit}

    def _columns_of(self, name: str) -> list[str]:
        output = self.swept.outputs[name]
        return [f"{name} {time:g} s" for time in output.times] if isinstance(output, AtTimes) else [name]

    def _picked(self, names: Any) -> tuple[str, ...]:
        return chosen(names, self.swept.outputs, self._unknown)

    def _unknown(self, name: str) -> str:
        known = self.swept.outputs
        return f"no output {quote(name)}{near(name, known, '`sweep.names` lists all outputs')}"

    def to_pandas(self, names: Any = None) -> Any:
        """A pandas DataFrame with one line for each variant; `attrs["units"]` holds the units. Needs pandas.

        Parameters: names, outputs by name, or wildcards such as `*.heat`, all by default.
        """
        frame = need("pandas", "tables", "a table").DataFrame(dict(self.columns(names)))
        frame.attrs["units"] = self.units | self.column_units(names)
        return frame

    def _given(self, name: str) -> str:
        """What a table calls a value that varies: an initial speed and the speed at the end have one name."""
        return f"{name} given" if name in self.swept.outputs else name

    def to_xarray(self, names: Any = None) -> Any:
        """An xarray Dataset over the axes of the grid, or over the variants, with units as attributes. Needs xarray.

        Parameters: names, outputs by name, or wildcards such as `*.heat`, all by default.
        """
        xarray, units, swept = need("xarray", "tables", "a Dataset"), self.units, self.swept
        grid = swept.variants.shape is not None and len(swept.variants.varied) > 0
        axes = tuple(map(self._given, self.varied)) if grid else ("variant",)
        named = {self._given(name): axis for name, axis in self.coords.items()}
        coords: dict[str, Any] = {
            name: (name if grid else "variant", axis, {"units": units[name]} if name in units else {})
            for name, axis in named.items()
        }
        shape, data = self.shape if grid else (len(self),), dict[str, Any]()
        for name in self._picked(names):
            values, dims, output = self.flat(name), axes, swept.outputs[name]
            if isinstance(output, AtTimes):
                dims = (*axes, f"{name} time")
                coords[dims[-1]] = (dims[-1], np.array(output.times), {"units": "s"})
            data[name] = (dims, values.reshape((*shape, *values.shape[1:])), {"units": units[name]})
        data["status"] = (axes, np.array(STATUSES)[self.codes].reshape(shape))
        return xarray.Dataset(data, coords=coords)

    @explained("sweep.to_parquet", path="'sweep.parquet'")
    def to_parquet(self, path: str | Path, names: Any = None) -> None:
        """Write the table of `to_pandas` as a Parquet file, with the units as metadata. Needs pyarrow.

        Parameters: names, outputs by name, or wildcards such as `*.heat`, all by default.
        """
        pyarrow = need("pyarrow", "exchange", "a Parquet file")
        table = pyarrow.table({name: pyarrow.array(column.tolist()) for name, column in self.columns(names)})
        units = self.column_units(names)
        words = {f"unit {name}": unit for name, unit in units.items()}
        # where pandas looks for `attrs`
        words["PANDAS_ATTRS"] = json.dumps({"units": units})
        with replaced(fitting("sweep.to_parquet", path, "sweep.parquet", [".parquet"])) as new:
            need("pyarrow.parquet", "exchange").write_table(table.replace_schema_metadata(words), str(new))

    @explained("sweep.to_csv", path="'sweep.csv'")
    def to_csv(self, path: str | Path, names: Any = None) -> None:
        """Write the table with all digits; heads are `name [unit]` where there is one.

        Parameters: names, outputs by name, or wildcards such as `*.heat`, all by default.
        """
        units, table = self.column_units(names), dict(self.columns(names))
        heads = [f"{name} [{units[name]}]" if units.get(name) else name for name in table]
        lines = zip(*(column.tolist() for column in table.values()), strict=True)
        put_csv(fitting("sweep.to_csv", path, "sweep.csv", [".csv"]), [heads, *lines])


class SweepInterrupted(KeyboardInterrupt):
    """Ctrl-C during a sweep; `sweep` holds the variants that were done before, the others have status interrupted."""

    def __init__(self, message: str, sweep: Sweep) -> None:
        super().__init__(message)
        self.sweep = sweep

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (str(self), self.sweep)


def empty_like(values: Array, count: int) -> Array:
    """Lines of the same kind without values."""
    shape = (count, *values.shape[1:])
    if values.dtype.kind == "O":
        return np.full(shape, None, dtype=object)
    return np.full(shape, np.nan) if values.dtype.kind == "f" else np.full(shape, "", dtype=values.dtype)


def _is_number(one: Varied) -> bool:
    return bool(one.unit) and one.column.dtype.kind in "fiu"


# of jerks by those of speeds
JERKS = {"rad/s": "rad/s3", "m/s": "m/s3"}


def unit_of(one: Output, channels: Channels) -> str:
    """The unit of an output, empty where there is none."""
    if isinstance(one, When):
        return "s"
    if isinstance(one, Computed):
        return ""
    if isinstance(one, FeltJerk):
        return JERKS[channels[one.signal].unit]
    if isinstance(one, SquaredJerk):
        # the square of m/s3 over s
        return channels[one.signal].unit.replace("rad/s2", "rad2/s5").replace("m/s2", "m2/s5")
    return channels[one.kept_as(channels) if isinstance(one, Integral) else one.signal].unit


def _plain(values: Array) -> Array:
    """What functions gave, as numbers where all are."""
    listed = [np.nan if value is None else value for value in values.tolist()]
    try:
        return np.array(listed, dtype=float)
    except (TypeError, ValueError):
        return values
