"""Which signals a page shows, in panels by unit, and the output whose acceleration and jerk it shows."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from clutchwork.base import dataclass
from clutchwork.declare.node import Domain
from clutchwork.results.channels import Channel, Channels
from clutchwork.results.forms import Mode
from clutchwork.results.selection import chosen

if TYPE_CHECKING:
    from clutchwork.assembly.system import System
    from clutchwork.assembly.wiring import Wiring

# curves in one panel where nothing is asked for, panels, and signals of a page
MOST_USUAL, MOST_SHOWN = 8, 60
TITLES = {
    "rad/s": "Speed",
    "m/s": "Speed",
    "N m": "Torque",
    "N": "Force",
    "W": "Power",
    "J": "Heat and work",
    "K": "Temperature",
    "degC": "Temperature",
    "Pa": "Pressure",
    "rad": "Angle",
    "m": "Position",
    "rad/s2": "Acceleration",
    "m/s2": "Acceleration",
    "rad/s3": "Jerk",
    "m/s3": "Jerk",
}
# what stands between two signals of which one is drawn over the other
OVER = " over "
JERK = {"rad/s2": "rad/s3", "m/s2": "m/s3"}
# what is dragged and felt: a pressure, a force, a torque
FELT = ("Pa", "N", "N m")


@dataclass(frozen=True)
class PagePanel:
    """Curves over one axis."""

    title: str
    unit: str
    names: tuple[str, ...]


def output_of(system: System, wiring: Wiring) -> str:
    """The shaft or mass whose motion is felt: a vehicle, the output of a gearbox, or the last one."""
    driven = _driven(system)
    masses = [n.name for n in wiring.nodes if n.domain is Domain.TRANSLATION and n.inertia and n.name not in driven]
    if masses:
        return masses[-1]
    if system.gearboxes:
        return system.gearboxes[-1].output
    own = {node.name for node in system.source.nodes} if system.source else {node.name for node in wiring.nodes}
    heavy = [node.name for node in wiring.nodes if node.inertia and node.name in own - driven]
    return heavy[-1] if heavy else ""


def _driven(system: System) -> set[str]:
    """Shafts and masses whose motion is prescribed, which no passenger feels."""
    found: Sequence[Any] = system.source.elements if system.source else ()
    return {part.shaft.name for part in found if type(part).kind.startswith("prescribed_")}


def panels(
    known: Channels, wiring: Wiring, wanted: Sequence[str] | None, output: str, felt: bool = True
) -> list[PagePanel]:
    """The signals shown: those requested, or speeds, slips, torques, heats and temperatures; the output last.

    Parameters: felt, whether acceleration and jerk of the output are shown without being asked for.
    """
    if wanted is None:
        found = _usual(known, wiring)
    else:
        single = [name for name in wanted if not _is_loop(name, known)]
        jerks = [name for name in single if _is_jerk(name, known)]
        named = [name for name in single if name not in jerks]
        names = [name for name in chosen(named, known, known.fault, "page") if _is_number(known[name])]
        found = _by_unit(known, names[:MOST_SHOWN])
        found += [PagePanel("Jerk", JERK[known[_slope(name)].unit], (name,)) for name in dict.fromkeys(jerks)]
    return _with_output(found, known, output) if felt else found


def _with_output(found: list[PagePanel], known: Channels, output: str) -> list[PagePanel]:
    """Panels, and those of how the output feels as the last ones."""
    acceleration, jerk = f"{output}.acceleration", f"{output}.jerk"
    if acceleration not in known:
        return found
    unit = known[acceleration].unit
    found = [one for one in found if one.names not in ((acceleration,), (jerk,))]
    found.append(PagePanel("Acceleration of the output", unit, (acceleration,)))
    if unit in JERK:
        found.append(PagePanel("Jerk of the output", JERK[unit], (jerk,)))
    return found


def _slope(jerk: str) -> str:
    """The acceleration whose slope a jerk is."""
    return jerk.removesuffix("jerk") + "acceleration"


def _is_jerk(name: str, known: Channels) -> bool:
    """Whether it is the jerk of a shaft or mass, which no run has as a signal."""
    return name.endswith(".jerk") and name not in known and _slope(name) in known and known[_slope(name)].unit in JERK


def _is_loop(name: str, known: Channels) -> bool:
    """Whether it is one signal over another; names may have the word themselves."""
    return OVER in name and name not in known


def loops(known: Channels, wanted: Sequence[str] | None) -> list[tuple[str, str]]:
    """Pairs of signals of which the first is drawn over the second: "c1.torque over c1.slip"."""
    pairs = [_both(name, known) for name in wanted or () if _is_loop(name, known)]
    chosen([name for pair in pairs for name in pair], known, known.fault, "page")
    return pairs


def _both(name: str, known: Channels) -> tuple[str, str]:
    """The two signals; where names have the word themselves, those that there are."""
    parts = name.split(OVER)
    cuts = [(OVER.join(parts[:n]).strip(), OVER.join(parts[n:]).strip()) for n in range(1, len(parts))]
    return next((cut for cut in cuts if cut[0] in known and cut[1] in known), cuts[0])


def _usual(known: Channels, wiring: Wiring) -> list[PagePanel]:
    nodes = [node.name for node in wiring.nodes]
    speeds = [name for node in nodes if (name := f"{node}.speed") in known]
    contacts = [branch.name for branch in wiring.contacts if f"{branch.name}.slip" in known]
    names = {
        "Speed": _evenly(speeds),
        "Slip": [f"{name}.slip" for name in contacts],
        "Torque": [f"{name}.torque" for name in contacts] or [n for n in known if n.endswith(".torque")],
        "Heat": [name for contact in contacts if (name := f"{contact}.heat") in known],
        "Temperature": [name for name in known if known[name].unit in ("K", "degC")],
    }
    return [
        PagePanel(title, part.unit, part.names)
        for title, some in names.items()
        for parts in [_by_unit(known, some[:MOST_USUAL])]
        for part in parts
    ]


def _evenly(names: list[str]) -> list[str]:
    """At most `MOST_USUAL` names, evenly spaced, the first and the last among them."""
    if len(names) <= MOST_USUAL:
        return names
    step = (len(names) - 1) / (MOST_USUAL - 1)
    return list(dict.fromkeys(names[round(number * step)] for number in range(MOST_USUAL)))


def _by_unit(known: Channels, names: Sequence[str]) -> list[PagePanel]:
    groups = dict[str, list[str]]()
    for name in names:
        groups.setdefault(known[name].unit, []).append(name)
    return [PagePanel(TITLES.get(unit, "Value"), unit, tuple(some)) for unit, some in groups.items()]


def _is_number(channel: Channel) -> bool:
    """Whether it can be drawn; modes are shown as bars."""
    return not isinstance(channel.evaluate, Mode)


def listed(known: Channels, names: Sequence[str]) -> dict[str, dict[str, Any]]:
    """Units and forms of signals by name; a jerk is the slope of an acceleration, which then is among them."""
    found = dict[str, dict[str, Any]]()
    slopes = [_slope(name) for name in names if _is_jerk(name, known)]
    for name in dict.fromkeys([*names, *slopes]):
        if name in known:
            found[name] = {"unit": known[name].unit, "form": known[name].evaluate.data()}
        elif name.endswith(".jerk"):
            channel = known[_slope(name)]
            found[name] = {"unit": JERK[channel.unit], "form": ["d", channel.evaluate.data()]}
    return found


def plain_panels(found: Sequence[PagePanel]) -> list[Mapping[str, Any]]:
    """As a page has them."""
    return [{"title": one.title, "unit": one.unit, "names": list(one.names)} for one in found]
