"""A study on disk: columns, tables and queries over its parts, whatever of them is there."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from clutchwork.assembly.system import System, SystemFormatError
from clutchwork.base import UnknownName, UseError, columns, dataclass, html, near, quote
from clutchwork.base.extras import need
from clutchwork.base.paths import path_of
from clutchwork.declare.calls import explained, explained_methods
from clutchwork.declare.options import Options
from clutchwork.results.selection import chosen
from clutchwork.studies.manifest import MODEL, Manifest, StudyError
from clutchwork.studies.parts import Written, file_of, there
from clutchwork.studies.picture import distributions
from clutchwork.sweeps.single import single

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from clutchwork.run.trajectory import Trajectory

STATUS = "status"
HEADS = ("output", "unit", "mean", "deviation", "5 %", "median", "95 %", "no value")


@explained_methods("study")
@dataclass(frozen=True, eq=False)
class Study:
    """The data set of a study: a folder with Parquet files, of which only the requested part is read.

    `found["lock(c1)"]` is a column, one value for each variant that is there, in their order; `found.names` lists the
    outputs, `found.varied` what varies. All columns are `variant`, those, and `status`. The files below `data` are for
    any other program too.
    """

    folder: Path
    manifest: Manifest
    parts: dict[int, Written]

    @classmethod
    @explained("cw.Study.load", folder="'out/study'")
    def load(cls, folder: str | Path) -> Study:
        """The study of a folder, as far as it is done; StudyError where there is none."""
        where = path_of("cw.Study.load", folder, "out/study")
        manifest = Manifest.read(where)
        return cls(where, manifest, there(where, manifest.sizes))

    # ------------------------------------------------------------------------------------------------------ what it has

    @property
    def names(self) -> tuple[str, ...]:
        """Names of all outputs, those at several instants by instant."""
        given = {"variant", STATUS, *self.varied}
        return tuple(one.name for one in self.manifest.columns if one.name not in given)

    @property
    def varied(self) -> tuple[str, ...]:
        """Names of the values that vary."""
        known = tuple(one.name for one in self.manifest.columns)
        # they stand behind the number of the variant
        return known[1 : 1 + self.manifest.varied]

    @property
    def units(self) -> dict[str, str]:
        """Unit of every column that has one, of SI."""
        return {one.name: one.unit for one in self.manifest.columns if one.unit}

    @property
    def count(self) -> int:
        """Variants that the study is to have."""
        return self.manifest.count

    def __len__(self) -> int:
        """Variants that are there."""
        return sum(part.variants for part in self.parts.values())

    @property
    def complete(self) -> bool:
        """Whether all variants are there."""
        return len(self) == self.count

    @property
    def files(self) -> list[Path]:
        """The Parquet files that are there, in the order of the variants."""
        return [file_of(self.folder, number) for number in sorted(self.parts)]

    @property
    def workers(self) -> dict[str, tuple[int, float]]:
        """Who ran it: variants and seconds of each worker, which is a machine and a process."""
        made = dict[str, tuple[int, float]]()
        for part in self.parts.values():
            count, seconds = made.get(part.worker, (0, 0.0))
            made[part.worker] = count + part.variants, seconds + part.seconds
        return made

    @property
    def ends(self) -> dict[str, int]:
        """How many variants ended in which way: done, or why they stopped early."""
        return dict(Counter(self[STATUS].tolist()).most_common())

    # ---------------------------------------------------------------------------------------------------------- columns

    def __contains__(self, name: object) -> bool:
        return name in {one.name for one in self.manifest.columns}

    def __getitem__(self, name: str) -> NDArray[Any]:
        """A column of the variants that are there; KeyError with near names when there is none."""
        if name not in self:
            raise UnknownName(self._unknown(name))
        if not self.parts:
            return np.zeros(0)
        return np.asarray(self.dataset().to_table(columns=[name])[name].to_numpy())

    def dataset(self) -> Any:
        """The data set of pyarrow, for programs that read it in pieces."""
        return need("pyarrow.dataset", "study", "a study").dataset([str(file) for file in self.files])

    def to_pandas(self, names: Any = None) -> Any:
        """A pandas DataFrame with one line for each variant that is there; `attrs["units"]` holds the units.

        Parameters: names, columns by name, or wildcards such as `*.heat`, all by default.
        """
        known = [one.name for one in self.manifest.columns]
        picked = list(chosen(names, known, self._unknown))
        frame = self.dataset().to_table(columns=picked).to_pandas()
        frame.attrs["units"] = {name: self.units[name] for name in picked if name in self.units}
        return frame

    @explained("study.query", sql="'SELECT count(*) FROM study'")
    def query(self, sql: str) -> Any:
        """What DuckDB finds; the columns are those of the table `study`, in double quotes: "lock(c1)".

        `.df()` of the result is a DataFrame, `.fetchall()` a list. Only the columns that a query names are read. Needs
        duckdb.
        """
        if not isinstance(sql, str):
            raise UseError("study.query", [f"sql is {quote(sql)}: give a query as a string"])
        duckdb = need("duckdb", "study", "a query")
        connection = duckdb.connect()
        connection.from_parquet([str(file) for file in self.files]).create_view("study")
        try:
            return connection.sql(sql)
        except duckdb.Error as error:
            plain = [one.name for one in self.manifest.columns if one.name in sql.replace(f'"{one.name}"', "")]
            if not plain:
                raise
            quoted = ", ".join(f'"{name}"' for name in plain)
            told = str(error).partition("\n")[0].rstrip("!. ")
            raise UseError("study.query", [f"{told}; put names of columns into double quotes: {quoted}"]) from None

    def run(self, number: int) -> Trajectory:
        """The run of one variant, as `simulate` gives it, where no Python function sets a signal."""
        line = self._line(number)
        try:
            system = System.load(self.folder / MODEL)
        except SystemFormatError as error:
            raise StudyError(f"{self.folder}: its model cannot be run again: {error}") from None
        options = {name: value for name, value in self.manifest.asked["options"].items() if name != "t_end"}
        end = self.manifest.asked["options"]["t_end"]
        return single(system, line, end, Options(**options))

    def _line(self, number: object) -> dict[str, Any]:
        """The values of one variant by name."""
        if not isinstance(number, int | np.integer) or isinstance(number, bool) or not 0 <= number < self.count:
            remedy = f"give a whole number from 0 to {self.count - 1}"
            raise UseError("study", [f"there is no variant {quote(number)}; {remedy}"])
        part = int(number) // self.manifest.chunk
        if part not in self.parts:
            raise UseError("study", [f"variant {number} is not there yet; let the study go on first"])
        names = list(self.varied)
        table = need("pyarrow.parquet", "study").read_table(str(file_of(self.folder, part)), columns=names)
        line = table.slice(int(number) % self.manifest.chunk, 1).to_pylist()[0]
        return {name.removesuffix(" given"): value for name, value in line.items()}

    def _unknown(self, name: str) -> str:
        known = [one.name for one in self.manifest.columns]
        return f"no column {quote(name)}{near(name, known, '`study.names` lists all outputs')}"

    # --------------------------------------------------------------------------------------------------- text, pictures

    def __repr__(self) -> str:
        return f"<{self._head()}; {', '.join(self.names)}>"

    def __str__(self) -> str:
        """What `print` shows: how much is there, and the distribution of each output."""
        lines = list(self._lines())
        table = columns([HEADS, *lines], right=range(2, len(HEADS))) if lines else "nothing is there yet"
        return "\n".join([f"<{self._head()}>", str(self.folder), "", table])

    def _repr_html_(self) -> str:
        table = html.table(HEADS, list(self._lines()), right=range(2, len(HEADS)))
        return html.page(html.heading(self._head()), html.paragraph(self.folder), table)

    def _head(self) -> str:
        """How many variants there are, and how they ended."""
        ends = ", ".join(f"{count} {name}" for name, count in self.ends.items())
        return f"Study of {self.count} variants, {len(self)} of them there{f': {ends}' if ends else ''}"

    def _lines(self) -> Iterator[tuple[str, ...]]:
        """A line for each output of numbers."""
        for name in self.names if len(self) else ():
            values = self[name]
            if values.dtype.kind != "f":
                continue
            known = values[np.isfinite(values)]
            numbers = ["", "", "", "", ""]
            if len(known):
                low, middle, high = np.quantile(known, [0.05, 0.5, 0.95])
                numbers = [f"{number:.6g}" for number in (known.mean(), known.std(), low, middle, high)]
            yield name, self.units.get(name, ""), *numbers, str(len(values) - len(known))

    @explained("study.plot", path="'study.png'")
    def plot(self, path: str | Path | None = None, names: Any = None) -> Figure:
        """The distribution of each output, written to `path` when given. Needs matplotlib.

        Parameters: names, outputs by name, or wildcards such as `*.heat`, all by default.
        """
        shown = {name: self[name] for name in chosen(names, self.names, self._unknown)}
        return distributions(shown, self.units, path)
