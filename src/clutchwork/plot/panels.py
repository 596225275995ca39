"""The panels of a picture; each draws one view of a run on given axes."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from clutchwork.declare.node import Domain
from clutchwork.declare.schema import specs
from clutchwork.plot.style import DASHES, EVENT_LINE, MILLIMETRE, NARROW, colours, looks
from clutchwork.results.channels import LOCKED

if TYPE_CHECKING:
    from matplotlib.axes import Axes

    from clutchwork.assembly.wiring import Branch
    from clutchwork.results.events import Event
    from clutchwork.results.recorded import Recorded

MOST_CURVES = 24
# in a zoom; of more only those that the contact joins
MOST_IN_ZOOM = 10
MOST_ROWS = 15  # of one column of a legend
# what presses contacts together where they have different words for it
SEVERAL = "actuating force"
# (unit in the result, from this size on, unit in the picture, factor)
LETTER = 0.03  # share of the width of a panel that the letter of a frame needs
SCALES = (
    ("Pa", 1e5, "MPa", 1e-6), ("N m", 5e3, "kN m", 1e-3), ("N", 5e3, "kN", 1e-3), ("W", 5e3, "kW", 1e-3),
    ("J", 5e6, "MJ", 1e-6), ("J", 5e3, "kJ", 1e-3),
)  # fmt: skip


def speeds(axes: Axes, run: Recorded, domain: Domain) -> None:
    """Speeds of all members of one domain over time."""
    for name, look in member_looks(run, domain).items():
        axes.plot(run.time, run[f"{name}.speed"], label=named(name), **look)
    unit = "rad/s" if domain is Domain.ROTATION else "m/s"
    axes.set_ylabel(f"speed, {unit}")
    legend(axes)


def frame(axes: Axes, run: Recorded, event: Event, label: str) -> None:
    """Frame around what the zoom shows, with its letter."""
    left, right = window(run, event)
    low, high = _meeting(fine(run, left, right), event)
    corner, size = (left, low), (right - left, high - low)
    axes.add_patch(_rectangle(corner, *size, fill=False, edgecolor="#404040", linewidth=0.7, zorder=3))
    # beside the frame, unless the letter would leave the panel
    room = axes.transAxes.inverted().transform(axes.transData.transform((right, low)))[0] < 1.0 - LETTER
    place, shift, side = (right, 2, "left") if room else (left, -2, "right")
    axes.annotate(label, (place, low), (shift, 1), textcoords="offset points", va="top", ha=side, fontsize=8.0)


def zoom(axes: Axes, run: Recorded, event: Event) -> None:
    """Speeds near one lock-up, cut to the members that meet there."""
    left, right = window(run, event)
    part = fine(run, left, right)
    low, high = _meeting(part, event)
    domain = domain_of(run, event)
    # of many members, those that the contact joins may be none of the first
    first = member_looks(run, domain)
    styles = first | {name: {"color": "#000000"} for name in _ends(run, event) if name not in first}
    speeds = {name: part[f"{name}.speed"] for name in styles}
    seen = [name for name, speed in speeds.items() if np.max(speed) >= low and np.min(speed) <= high]
    if len(seen) > MOST_IN_ZOOM:
        seen = [name for name in _ends(run, event) if name in seen]
    for name in seen:
        axes.plot(part.time, speeds[name], label=named(name), **styles[name])
    axes.axvline(event.time, **EVENT_LINE)
    axes.annotate(
        f"{event.element} locks at {event.time:.4f} s", (event.time, 1.0), (4, -4), xycoords=("data", "axes fraction"),
        textcoords="offset points", va="top", fontsize=7.5,
    )  # fmt: skip
    axes.set_xlim(left, right)
    axes.set_ylim(low, high)
    axes.set_ylabel("speed, rad/s" if domain is Domain.ROTATION else "speed, m/s")
    legend(axes)


def inputs(axes: Axes, run: Recorded, names: dict[str, str]) -> None:
    """What presses some contacts together, signals of one unit by contact."""
    factor, unit = scale(run, list(names.values()))
    for (contact, signal), look in zip(names.items(), contact_looks(run, names).values(), strict=True):
        axes.plot(run.time, factor * run[signal], label=named(contact), **look)
    axes.set_ylabel(f"{pressing(run, names)}, {'share' if unit == '1' else unit}")
    axes.margins(y=0.08)
    legend(axes)


def torques(axes: Axes, run: Recorded, names: list[str]) -> None:
    """Torques of some contacts, or forces: thin while slipping, thick while locked."""
    factor, unit = scale(run, [f"{name}.torque" for name in names])
    for name, look in contact_looks(run, names).items():
        torque = factor * run[f"{name}.torque"]
        axes.plot(run.time, torque, **{**look, "linewidth": 0.9}, label=named(name))
        is_locked = run[f"{name}.mode"] == LOCKED
        axes.plot(run.time, np.where(is_locked, torque, np.nan), **{**look, "linewidth": 2.4})
    axes.axhline(0.0, color="#B0B0B0", linewidth=0.5, zorder=1)
    axes.margins(y=0.08)
    axes.set_ylabel(f"{carrying(run, names)} on follower, {unit}")
    legend(axes, "thick: locked")


def temperatures(axes: Axes, run: Recorded) -> None:
    """Temperatures of thermal nodes and ambients."""
    names = [node.name for node in run.wiring.thermal][:MOST_CURVES]
    for name, look in zip(names, looks(len(names)), strict=True):
        axes.plot(run.time, run[f"{name}.temperature"], label=named(name), **look)
    axes.margins(y=0.08)
    axes.set_ylabel("temperature, K")
    legend(axes)


def locks(axes: Axes, run: Recorded) -> None:
    """Bars over time: full while locked, pale while slipping under load, none while open."""
    names = busy(run)
    for row, (name, look) in enumerate(contact_looks(run, names).items()):
        locked, slipping = run[f"{name}.mode"] == LOCKED, np.abs(run[f"{name}.mode"]) == 1
        loaded = slipping & (run[f"{name}.torque"] != 0.0)
        axes.broken_barh(spans(run.time, loaded), (row - 0.36, 0.72), facecolor=look["color"], alpha=0.25, linewidth=0)
        axes.broken_barh(spans(run.time, locked), (row - 0.36, 0.72), facecolor=look["color"], linewidth=0)
    axes.set_yticks(range(len(names)), names)
    axes.set_ylim(len(names) - 0.4, -0.6)
    axes.grid(visible=False, axis="y")
    axes.text(1.012, 0.5, "full: locked\npale: slipping", transform=axes.transAxes, va="center", fontsize=7.0)


def dotted(lines: Iterable[Any]) -> None:
    """A line over a single instant is a dot, for it would not be seen."""
    for line in lines:
        if np.ptp(line.get_xdata()) == 0.0 and line.get_marker() == "None":
            line.set(marker="o", markersize=3.0)


def named(name: str) -> str:
    """A name as label; one with a leading underscore would be left out of the legend."""
    return f" {name}" if name.startswith("_") else name


def member_looks(run: Recorded, domain: Domain) -> dict[str, dict[str, Any]]:
    """Colour and dashes of every member, the same in all panels."""
    names = [node.name for node in run.wiring.nodes if node.domain is domain]
    return dict(zip(names, looks(min(len(names), MOST_CURVES)), strict=False))


def contact_looks(run: Recorded, names: Any) -> dict[str, dict[str, Any]]:
    """Colour of the chosen contacts, the same in all panels."""
    places = {name: place for place, name in enumerate(busy(run))}
    hues = colours()
    count = len(hues)
    return {
        name: {"color": hues[i % count], "linestyle": DASHES[i // count % len(DASHES)]}
        for name in names
        for i in [places[name]]
    }


def busy(run: Recorded) -> list[str]:
    """Contacts that carry torque at some time, the first ones where there are many."""
    return _carriers(run)[:MOST_CURVES]


def carriers(run: Recorded) -> int:
    """How many contacts carry torque at some time."""
    return len(_carriers(run))


def _carriers(run: Recorded) -> list[str]:
    names = [branch.name for branch in run.wiring.contacts]
    return [name for name in names if np.any(run[f"{name}.torque"] != 0.0)]


def loaded(run: Recorded) -> list[list[str]]:
    """Contacts that carry torque, those of one unit together."""
    return list(_by_unit(run, {name: f"{name}.torque" for name in busy(run)}))


def carrying(run: Recorded, names: list[str]) -> str:
    """What some contacts of one unit carry, in one word."""
    return "torque" if run.units[f"{names[0]}.torque"] == "N m" else "force"


def driven(run: Recorded) -> list[dict[str, str]]:
    """Contacts that carry torque, with the signal that presses each, those of one unit together."""
    names = {
        *(name for name, _ in run.wiring.inputs if name not in run.wiring.unused),
        *(link.name for link in run.wiring.links),
    }
    found = {
        name: [f"{name}.{word}" for word in _pressing(run, name) if f"{name}.{word}" in names] for name in busy(run)
    }
    signals = {contact: given[0] for contact, given in found.items() if given}
    return [{name: signals[name] for name in group} for group in _by_unit(run, signals)]


def _pressing(run: Recorded, contact: str) -> dict[str, str]:
    """Inputs that press a contact together, and what each presses with."""
    declared = specs(type(_branch(run, contact).component), "signal", "alternative")
    # what a gain multiplies is the load
    return {item.name: item.name.replace("_", " ") for item, spec in declared if spec.presses or spec.gain}


def pressing(run: Recorded, names: dict[str, str]) -> str:
    """What presses some contacts together, in one word or two."""
    words = {_pressing(run, contact)[signal.rpartition(".")[2]] for contact, signal in names.items()}
    return words.pop() if len(words) == 1 else SEVERAL


def _by_unit(run: Recorded, signals: dict[str, str]) -> Iterable[list[str]]:
    """Contacts whose signals have the same unit, in the order in which they come."""
    groups: dict[str, list[str]] = {}
    for contact, signal in signals.items():
        groups.setdefault(run.units[signal], []).append(contact)
    return groups.values()


def scale(run: Recorded, names: list[str]) -> tuple[float, str]:
    """Factor and unit in which some signals of one unit are shown."""
    unit = run.units[names[0]] if names else "1"
    largest = max((float(np.max(np.abs(run[name]), initial=0.0)) for name in names), default=0.0)
    for from_unit, size, to_unit, factor in SCALES:
        if unit == from_unit and largest >= size:
            return factor, to_unit
    return 1.0, unit


def spans(time: NDArray[np.float64], holds: NDArray[np.bool_]) -> list[tuple[float, float]]:
    """(begin, duration) of the stretches in which a condition holds."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], holds, [False]]).astype(int)))
    last = len(time) - 1
    pairs = zip(edges[::2], edges[1::2], strict=True)
    return [(float(time[first]), float(time[min(stop, last)] - time[first])) for first, stop in pairs]


def legend(axes: Axes, title: str = "") -> None:
    """Legend to the right of the axes, where it covers nothing."""
    handles, labels = axes.get_legend_handles_labels()
    if handles and is_narrow(axes):
        above(axes, handles, labels, 3, title)
    elif handles:
        columns = 1 + (len(handles) - 1) // MOST_ROWS
        axes.legend(
            loc="upper left", bbox_to_anchor=(1.0, 1.02), borderaxespad=0.3, title=title or None, title_fontsize=7.5,
            alignment="left", ncols=columns, handlelength=2.4, labelspacing=0.3, columnspacing=0.8,
        )  # fmt: skip


def is_narrow(axes: Axes) -> bool:
    """Whether a picture has no room for legends beside its panels."""
    figure = axes.get_figure(root=True)
    return figure is not None and figure.get_figwidth() < NARROW * MILLIMETRE


def above(axes: Axes, handles: Sequence[Any], labels: Sequence[str], columns: int, title: str = "") -> None:
    """Legend above axes of a narrow picture, over the words at events."""
    axes.legend(
        handles, labels, loc="lower left", bbox_to_anchor=(0.0, 1.0), borderaxespad=1.3, ncols=columns,
        title=title or None, title_fontsize=7.5, alignment="left", handlelength=2.0, labelspacing=0.3,
        columnspacing=0.8,
    )  # fmt: skip


def window(run: Recorded, event: Event) -> tuple[float, float]:
    """Time window [s] around a lock-up."""
    half = 0.025 * (run.time[-1] - run.time[0])
    return max(float(run.time[0]), event.time - half), min(float(run.time[-1]), event.time + half)


def fine(run: Recorded, left: float, right: float) -> Recorded:
    """The run on a fine grid in a window, events included; a run that stopped early as it is."""
    if not run.finished:
        return run
    inside = [e.time for e in run.events if left <= e.time <= right]
    return run.at(np.concatenate([np.linspace(left, right, 801), inside, inside]))


def _meeting(part: Recorded, event: Event) -> tuple[float, float]:
    """Range of speed that holds the members of a contact around its lock-up."""
    names = _ends(part, event)
    values = np.concatenate([part[f"{name}.speed"] for name in names])
    pad = 0.12 * (float(np.ptp(values)) or 1.0)
    return float(np.min(values)) - pad, float(np.max(values)) + pad


def _ends(run: Recorded, event: Event) -> list[str]:
    """Members that the contact of an event joins."""
    return [run.wiring.nodes[i].name for i in _branch(run, event.element).direction if i >= 0]


def domain_of(run: Recorded, event: Event) -> Domain:
    """Kind of motion of the contact of an event."""
    return _branch(run, event.element).domain


def _rectangle(*place: Any, **look: Any) -> Any:
    from matplotlib.patches import Rectangle

    return Rectangle(*place, **look)


def _branch(run: Recorded, name: str) -> Branch:
    return next(branch for branch in run.wiring.contacts if branch.name == name)
