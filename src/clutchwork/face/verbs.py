"""Who does the verbs of what users hold where that room lies above theirs; imported when a verb is used."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from clutchwork.base.verbs import does

if TYPE_CHECKING:
    from pathlib import Path

    from clutchwork.assembly.system import System
    from clutchwork.declare.node import Law, Signal
    from clutchwork.driveline.driveline import Driveline
    from clutchwork.gearbox.gearbox import Gearbox
    from clutchwork.results.gradient import Gradient
    from clutchwork.run.trajectory import Trajectory


@does("law.show")
def show_law(law: Law) -> Any:
    """The curve of a friction law, and its parameters."""
    from clutchwork.driveline.laws import parts

    return parts(law)


@does("signal.show")
def show_signal(signal: Signal) -> Any:
    """The curve of a signal, and its parameters."""
    from clutchwork.plot.signals import parts

    return parts(signal)


@does("system.show")
def show_system(system: System) -> Any:
    """Tables of a System."""
    from clutchwork.results.overview import parts

    return parts(system)


@does("driveline.fmu")
def to_fmu(driveline: Driveline, path: Any, given: Any) -> Path:
    """An FMU of a driveline."""
    from clutchwork.fmu.export import export_fmu

    return export_fmu(driveline, path, **given)


@does("run.gradient")
def gradient(run: Trajectory, of: Any, by: Any, side: Any) -> Gradient:
    """Derivatives of what a run gave."""
    from clutchwork.gradients.run import gradient_of

    return gradient_of(run, of, by, side)


@does("run.page")
def page(run: Trajectory, path: Any, drag: Any, sliders: Any, show: Any) -> Path:
    """A page that computes a run."""
    from clutchwork.page.page import page_of

    return page_of(run, path, drag, sliders, show)


@does("run.widget")
def widget(run: Trajectory, drag: Any, sliders: Any, show: Any) -> Any:
    """The same page in a notebook."""
    from clutchwork.page.widget import widget_of

    return widget_of(run, drag, sliders, show)


@does("box.page")
def gearbox_page(box: Gearbox, path: Any) -> Path:
    """A page of a gearbox."""
    from clutchwork.page.gearbox import page_of_gearbox

    return page_of_gearbox(box, path)
