"""What users hold of a run: its data, and the verbs that read, draw and write it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import field
from functools import cached_property
from typing import TYPE_CHECKING, Any

from numpy.typing import NDArray

from clutchwork.base import ClutchworkError, OptionError, counted, dataclass
from clutchwork.base.verbs import do
from clutchwork.declare.calls import explained, explained_methods
from clutchwork.results.events import Events
from clutchwork.run.exports import Exports

if TYPE_CHECKING:
    from pathlib import Path

    from clutchwork.declare.node import Number
    from clutchwork.hints.hint import Hints
    from clutchwork.plot.canvas import Picture
    from clutchwork.results.dependence import DependentPhase
    from clutchwork.results.energy import EnergyBalance
    from clutchwork.results.events import Event
    from clutchwork.results.gears import GearTable
    from clutchwork.results.gradient import Gradient
    from clutchwork.results.state import State
    from clutchwork.run.input_schedule import Schedule
    from clutchwork.run.losses import Losses


class SimulationError(ClutchworkError, RuntimeError):
    """A run failed; `trajectory` holds what was computed before."""

    def __init__(self, message: str, trajectory: Trajectory | None = None) -> None:
        super().__init__(message)
        self.trajectory = trajectory

    def __reduce__(self) -> tuple[Any, ...]:
        return type(self), (str(self), self.trajectory)


@explained_methods("run")
@dataclass(frozen=True, eq=False)
class Trajectory(Exports):
    """The result of a run.

    `run.time` [s] and `run["engine.speed"]` are arrays over the same instants; an instant that appears twice gives
    the left and the right limit at an event. `run.names` lists all signals, `run.units` their units,
    `run.events`, `run.energy` and `run.statistics` what else is known, `run.hints` what may not be meant.
    """

    capture: Callable[[float], State] = field(repr=False)  # the state of the same run at a time [s]
    start: State | None = field(repr=False)  # where it began, None: at the numbers of the model
    course: Schedule = field(repr=False)  # what was done to it from outside

    def raise_for_status(self) -> Trajectory:
        """Return itself when the run is complete, else raise SimulationError."""
        if not self.finished:
            raise SimulationError(self.message, self)
        return self

    def in_units(self, name: str, unit: str) -> NDArray[Any]:
        """A signal over `time` in another unit: `run.in_units("engine.speed", "rpm")`.

        UseError, a TypeError, where the unit is not one of the signal, with those that are; KeyError with near names
        where there is no such signal.
        """
        from clutchwork.results.units import converter

        self.channels[name]
        found: NDArray[Any] = converter(self, {name: unit}).values(self, name)
        return found

    @explained("run.state")
    def state(self, at: Number | None = None) -> State:
        """What the run is at a time [s, or with a unit], by default at its end; `simulate(start=state)` goes on.

        The run is repeated up to there; at an event it is the right limit, before what controllers do then. Where a
        step of the solver ends at that time the motion that follows is that of this run, bit for bit, else within the
        tolerance.
        """
        from clutchwork.results.state import instant

        return self.capture(instant(at, self.options.t_start, self.reached))

    @explained("run.save", path="'run.cwrun'")
    def save(self, path: str | Path) -> None:
        """Write the whole run to one file, from which `cw.load_run` makes it again; nothing in it is code.

        Parameters: path, such as "run.cwrun", whatever its ending.
        """
        from clutchwork.base.paths import fitting
        from clutchwork.run.save import save

        save(self, fitting("run.save", path, "run.cwrun"), self.start, self.course)

    @cached_property
    def energy(self) -> EnergyBalance:
        """Energy balance between the first and the last instant."""
        if not self.options.work:
            raise OptionError(["the energy balance needs the work integrals: run with work=True"])
        if not len(self):
            raise SimulationError(f"no instant was computed, so there is no energy balance: {self.message}", self)
        from clutchwork.results.energy import balance

        window = [e for e in self.events if self.time[0] <= e.time <= self.time[-1]]
        return balance(self.wiring, self.rows, Events(window), self.options.t_start)

    @explained("run.gears", name="'gearbox'")
    def gears(self, name: str = "") -> GearTable:
        """Which gear of a gearbox was in when: stretches with begin and end [s], gear and closed elements; print it.

        Parameters: name, of the `Transmission`, which may be left out where there is one. A gear is in while exactly
        the elements of its row are closed; freewheels that hold beside them change nothing. It is "neutral" where no
        element carries torque, and None while elements slip. UnknownName, a KeyError, where there is no such gearbox.
        """
        from clutchwork.results.gears import gears_of

        return gears_of(self, name)

    @explained("run.losses", start="1.0", end="2.0")
    def losses(self, start: Number | None = None, end: Number | None = None, *, power: bool = False) -> Losses:
        """What each element takes, gives on, stores and loses between two instants, by default over the whole run.

        Parameters: start and end [s, or with a unit]; power, mean powers in W in place of energies in J.

        The run is repeated for it, at the points at which the solver sums up work. At an event an instant is its left
        limit. Print the table to read it; `.sankey()` draws it.
        """
        from clutchwork.results.flows import flows, window
        from clutchwork.results.losses import losses
        from clutchwork.run.losses import Losses

        return losses(Losses, self, flows(self, *window(self, start, end, "run.losses")), power)

    @explained("run.sankey", start="1.0", end="2.0", path="'sankey.svg'")
    def sankey(
        self,
        path: str | Path | None = None,
        *,
        start: Number | None = None,
        end: Number | None = None,
        power: bool = False,
    ) -> Picture:
        """Sankey picture of the energy between two instants, by default over the whole run. Needs matplotlib.

        Parameters: path, where it is written: png, svg or pdf by its ending; the others are those of `losses`.

        Sources are on the left, loads on the right; heat goes down, what is stored goes up.
        """
        return self.losses(start, end, power=power).sankey(path)

    @explained("run.gradient", of="['load.speed', cw.lock('c1')]", by="['c1.gain', 'engine.inertia']")
    def gradient(self, of: Any, by: Sequence[str] | str, *, side: str | None = None) -> Gradient:
        """Derivatives of what the run gave by numbers of its driveline: how much later it locks for 1 % more inertia.

        Parameters: of, values as `outputs` of `cw.sweep`: "load.speed", at the end, `cw.at`, `cw.lock`, `cw.maximum`,
        `cw.integral`, `cw.squared_jerk` ..., one or several; by, names of numbers as in `System.changed`: "c1.gain",
        "engine.speed", at the start, of a table "c1.pressure.values" or "c1.pressure.times[3]"; side, "left" or
        "right", which derivatives are given where those from both sides differ.

        Events move with the numbers, and so do the derivatives jump at them, which is exact. A derivative that does
        not exist is NaN, and `problems` of what is found says why; `NoGradient`, a ValueError, is raised where there is
        none at all. `cw.differentiable` is for many points. docs/guide/gradients.md
        """
        found: Gradient = do("run.gradient", self, of, by, side)
        return found

    @explained("run.page", path="'shift.html'", drag="['F1.pressure']", sliders="['c1.gain']", show="['*.speed']")
    def page(
        self,
        path: str | Path,
        *,
        drag: Sequence[str] | str | None = None,
        sliders: Sequence[str] | str | None = None,
        show: Sequence[str] | str | None = None,
    ) -> Path:
        """Write a page that computes: one HTML file, in which a reader moves pressures and numbers of this run.

        Parameters: path, of the file; drag, signals whose knots are dragged, by default pressures that vary; sliders,
        numbers as in `System.changed`, with ends where half and twice are not meant, "c1.gain=2e-4:8e-4", several of
        them by a wildcard or commas, "F*.gain"; show, curves by name or wildcard, by default speeds, slips, torques,
        heats and temperatures; acceleration and jerk of the output are there where a pressure, force or torque is
        dragged, or where they are named. Returns the path.

        The page runs the model from its begin, with these options; UseError names what cannot be changed in it. It
        needs no network and no installation, and sends nothing anywhere. docs/guide/page.md
        """
        written: Path = do("run.page", self, path, drag, sliders, show)
        return written

    @explained("run.widget", drag="['F1.pressure']", sliders="['c1.gain']", show="['*.speed']")
    def widget(
        self,
        *,
        drag: Sequence[str] | str | None = None,
        sliders: Sequence[str] | str | None = None,
        show: Sequence[str] | str | None = None,
    ) -> Any:
        """The same page in a notebook, whose changes come back to Python. Needs anywidget.

        Parameters: as those of `page`. The widget has `knots`, {"F1.pressure": [[time, value], ...]}, and `values`,
        {"c1.gain": value}, in SI, which may be set too; `widget.system` is the driveline as its reader left it.
        """
        return do("run.widget", self, drag, sliders, show)

    @cached_property
    def dependent(self) -> tuple[DependentPhase, ...]:
        """When contacts were locked whose directions depend on each other, so that the torque of each is a convention.

        Their motion and the load that they carry together are unique; it is shared in proportion to capacity or, beside
        gears with losses, in some way that keeps all limits.
        """
        from clutchwork.results.dependence import dependent_phases

        return dependent_phases(self) if len(self) else ()

    @cached_property
    def hints(self) -> Hints:
        """What an expert would say of this run and its model, with numbers and a remedy; print it to read it.

        Looked for when it is first asked for. A run whose output has instants of its own is repeated for that.
        """
        from clutchwork.hints.registry import of_run

        return of_run(self)

    @explained("plot")
    def plot(
        self,
        *signals: str | Sequence[str] | Path,
        unit: str | Sequence[str] | None = None,
        path: str | Path | None = None,
        zoom: tuple[Number, Number] | None = None,
        events: bool | str | Sequence[str] | Events | Event = True,
        lockup: Event | None = None,
        measured: Mapping[str, Any] | None = None,
        units: Mapping[str, str] | None = None,
        width: float | str | None = None,
    ) -> Picture:
        """Picture of some signals, or of speeds, lock-up, inputs, torques, states and temperatures. Needs matplotlib.

        Parameters: signals, names such as "c1.torque" and wildcards such as "c1.*", drawn with a panel for each unit; a
        list of names is a panel of its own, with a second axis where it has two units. A string that ends in .png, .svg
        or .pdf is the path. unit, takes only signals in it ("N m"), of all where none is named; path, where the picture
        is written: png, svg or pdf by its ending; zoom, (begin, end) [s], computed anew on a fine grid; events, which
        ones are marked: True for all unless there are more than 30, False, contacts by name, or events of the run;
        lockup, the event to look at closely where nothing is named, by default the last one in which a contact locks;
        measured, samples by the name of the signal: (times [s], values in SI), a `Column`, or a pandas Series; units,
        in which signals are drawn, `{"*.speed": "rpm"}`, as in `to_pandas`; each has a panel where nothing is named;
        width, "single column" or "double column" of a journal, 88 or 180 mm, or a number [mm].

        Settings of matplotlib that you changed, such as a style, stay. The figure that it returns shows itself in a
        notebook. docs/guide/pictures.md
        """
        from clutchwork.plot.chosen import PlotArguments
        from clutchwork.plot.run import plot

        chosen = PlotArguments(signals, unit, path, zoom, events, measured, units, width)
        return plot(self, chosen, lockup)

    @explained("explore")
    def explore(
        self,
        *signals: str | Sequence[str] | Path,
        unit: str | Sequence[str] | None = None,
        path: str | Path | None = None,
        zoom: tuple[Number, Number] | None = None,
        events: bool | str | Sequence[str] | Events | Event = True,
        measured: Mapping[str, Any] | None = None,
        points: int | None = 20_000,
        units: Mapping[str, str] | None = None,
    ) -> Any:
        """The same as `plot`, to zoom into and to hover over in a browser or a notebook. Needs plotly.

        Parameters: those of `plot`; path, one html file that needs no network; points, the most of each curve, none of
        whose peaks is lost, or None for all of them. What is left out stays out when you zoom in;
        zoom=(begin, end) shows every detail of a stretch.

        Returns a figure of plotly.
        """
        from clutchwork.plot.chosen import PlotArguments
        from clutchwork.plot.explore import explore

        return explore(self, PlotArguments(signals, unit, path, zoom, events, measured, units), points)

    def _repr_mimebundle_(self, **_: Any) -> dict[str, Any]:
        from clutchwork.base.rich import bundle
        from clutchwork.plot.run import parts

        return bundle(self, *parts(self))

    def __repr__(self) -> str:
        end = self.time[-1] if len(self) else 0
        return (
            f"<Trajectory {self.status}, {self.options.t_start:g} to {end:g} s, {counted(len(self), 'instants')}"
            f", {counted(len(self.names), 'signals')}, {counted(len(self.events), 'events')}>"
        )
