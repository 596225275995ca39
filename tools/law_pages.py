"""The live page of a friction law: three small rigs with the same law, and sliders that turn it in all of them.

The build of the documentation writes the pages, and generated reference pages show them.
"""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from dataclasses import replace
from numbers import Real
from pathlib import Path
from typing import Any

import clutchwork as cw
from clutchwork.declare.schema import REGISTRY, Role, specs
from clutchwork.laws.bases.stribeck import StribeckCurve
from clutchwork.page.data import PageRequest
from clutchwork.page.left_out import LEFT_OUT
from clutchwork.page.page import page
from clutchwork.rig.presets import CLUTCH

T_END = 6.0  # s
SWEEP = 4.0  # largest slip over the Stribeck speed, and over that of the last point of a table
SMALL = 0.008  # rad/s, of the small movements
STIFFNESS = 300.0  # N m/rad, of the spring that holds the disc
DRUM, FAST = 0.5, 4.0  # rad/s, speed of the drum, and where only a law that never rests gets on
# rows close enough for a torque over a slip
OPTIONS = cw.Options(max_step=0.02)
TEMPERATURE = 300.0  # K, of laws over the temperature
# dry clutch whose contact is soft, so that a page runs in milliseconds
SOFT = replace(
    CLUTCH,
    mass=2.0,
    speed=1.0,
    viscous=0.005,
    stiffness=150.0,
    damping=0.02,
    elastic=2e-3,
    width=0.05,
    attraction=100.0,
    order=20.0,
    elements=((0.2, 0.2), (0.5, 0.3), (1.0, 0.3), (2.0, 0.2)),
)
# ends of sliders of numbers that are zero at first
FROM_ZERO = {"viscous": "0:0.05", "damping": "0:0.5"}
# other ends of sliders, between which no combination is refused or needs many steps; none for what stays
ENDS = {
    # the loop gets corners beyond
    "dahl": {"exponent": "1:3"},
    # with less the stack of elements rings
    "gms": {"damping": "0.02:0.5"},
    "leuven": {"damping": "0.02:0.5"},
    "elastoplastic": {
        "kinetic": "0.16:0.27",
        "stiffness": "50:300",
        "elastic": "5e-5:5.2e-4",
        "plastic": "",
    },
}
SHOWN = ("sweep.torque over swept.speed", "loop.torque over moved.angle", "disc.speed", "drum.speed")
TURNED = ("drive.speed=0.1:2", "spring.stiffness=50:1500")
# when the small movements turn: one loop, and a smaller one inside of it [s]
TURNS = (1.0, 3.0, 4.0, 4.5)

RIGS = (
    "Three small rigs with this law: a shaft whose slip sweeps up, down and back, one that is moved by some"
    " milliradians there and back, and a disc on a turning drum, held by a spring. The sliders turn the law in all"
    " three, at 1000 N m for each unit of the coefficient."
)
RIGID = (
    "At rest the law holds exactly: the small movements give a rectangle, and the disc sticks until the spring pulls it"
    " off."
)
ELASTIC = "Before it slides the contact is elastic: its stiffness is the slope of the loop after each reversal."
CREEPS = (
    "Without slip it has no torque: the faster the small movements are the larger theirs is, and a disc that seems to"
    " stick creeps."
)
STEADY = "Its torque never falls with the slip: nothing drives stick-slip, and once broken away the disc only swings."
WORDS = {
    "dahl": f"{ELASTIC} {STEADY}",
    "karnopp": f"{RIGID} Within its band every slip counts as none.",
    "naive_sign": (
        "No solver gets past the first rest of the disc: its drum begins fast and slows down, and when the disc would"
        " stick for the first time the run ends, which the page says; what would follow is grey. Where the slip is"
        " prescribed, in the sweep and the small movements, the law is seen until then."
    ),
    "regularised_stribeck": CREEPS,
    "tanh": f"{CREEPS} {STEADY}",
}


def kinds() -> list[str]:
    """All friction laws that pages have room for."""
    return sorted(set(REGISTRY[Role.LAW]) - set(LEFT_OUT["law"]))


def words(kind: str) -> str:
    """What is to be seen on the page of a law."""
    cls = REGISTRY[Role.LAW][kind]
    tables = [f"`{item.name}`" for item, _ in specs(cls, "curve", "numbers", "table", "rows")]
    stay = f" {' and '.join(tables)} {'stays' if len(tables) == 1 else 'stay'} as in the example." if tables else ""
    return f"{RIGS} {WORDS.get(kind) or (RIGID if cls.sticks else ELASTIC)}{stay}"


def law_of(kind: str) -> Any:
    """A law with the numbers of the soft clutch, or with the examples of its declaration."""
    law: Any = SOFT.law(kind)
    if isinstance(law, cw.ElastoPlastic):
        law = replace(law, elastic=4e-4)
    if isinstance(law, cw.GMS | cw.Leuven):
        law = replace(law, damping=0.05)
    if isinstance(law, StribeckCurve):
        # the same curve, whose exponent can be turned
        law = replace(law, shape="power")
    warm = any(specs(type(law), "signal")) and law.reads("temperature")
    return replace(law, temperature=TEMPERATURE) if warm else law


def driveline(kind: str) -> cw.Driveline:
    """The three rigs of a law."""
    law = law_of(kind)
    d = cw.Driveline(type(law).__name__)
    rests = kind != "naive_sign"
    swept, moved = d.shaft("swept", inertia=1.0), d.shaft("moved", inertia=1.0)
    drum = d.shaft("drum", inertia=1.0)
    disc = d.shaft("disc", inertia=SOFT.mass, speed=DRUM if rests else 0.0)
    d.add(cw.PrescribedSpeed("swing", shaft=swept, speed=_there_and_back(_fastest(law))))
    d.add(cw.PrescribedSpeed("move", shaft=moved, speed=_small()))
    slowing = cw.Table([(0.0, FAST), (0.6 * T_END, FAST), (T_END, 0.0)])
    d.add(cw.PrescribedSpeed("drive", shaft=drum, speed=DRUM if rests else slowing))
    # of a disc that slides steadily
    twist = 0.0 if rests else SOFT.curve(FAST) / STIFFNESS
    d.add(cw.Spring("spring", base=d.housing, follower=disc, stiffness=STIFFNESS, initial_twist=twist))
    for name, base, follower in (("sweep", swept, d.housing), ("loop", moved, d.housing), ("stick", drum, disc)):
        d.add(cw.Clutch(name, base=base, follower=follower, friction=law, gain=1.0, normal_force=SOFT.load))
    return d


def sliders(kind: str) -> list[str]:
    """A slider for each number of a law, then for the rig of the disc."""
    law = law_of(kind)
    found = [f"*.friction.{name}={ends}" for name, ends in _ends(law)]
    return found + ([] if kind == "naive_sign" else list(TURNED))


def write(kind: str, path: Path) -> None:
    """Write the page of a law."""
    with warnings.catch_warnings():
        # of laws that ring: their damping is more than is passive at any slip
        warnings.simplefilter("ignore", cw.ModelWarning)
        system = driveline(kind).assemble()
    path.write_text(page(system, T_END, OPTIONS, wanted(kind)), encoding="utf-8")


def wanted(kind: str) -> PageRequest:
    """What the page of a law has."""
    return PageRequest(["drive.speed"] if kind == "naive_sign" else [], sliders(kind), SHOWN)


def _ends(law: Any) -> Iterator[tuple[str, str]]:
    """Numbers of a law, and the ends of their sliders: between these every combination is one."""
    middle = _middle(law)
    for item, spec in specs(type(law)):
        value = getattr(law, item.name)
        if spec.flag or spec.choices or spec.whole or isinstance(value, bool) or not isinstance(value, Real):
            continue
        name, number = item.name, float(value)
        own = ENDS.get(type(law).kind, {})
        if name in own:
            yield from [(name, own[name])] if own[name] else []
        elif name == "temperature":
            yield name, "280:500"
        elif number == 0.0:
            yield name, FROM_ZERO[name]
        elif name == "static" and middle:
            yield name, f"{middle:.4g}:{2.0 * number:.4g}"
        elif name in ("kinetic", "slow") and middle:
            yield name, f"{0.2 * number:.4g}:{middle:.4g}"
        else:
            yield name, f"{0.25 * number:.4g}:{4.0 * number:.4g}"


def _middle(law: Any) -> float:
    """Between the static coefficient and what must stay below it; 0 where a law has no static one."""
    static = getattr(law, "static", None)
    if not isinstance(static, Real):
        return 0.0
    below = getattr(law, "slow", law.kinetic)
    if not isinstance(below, Real):
        values = [value for _, value in law.kinetic]
        below = values[0] if isinstance(law, cw.CoefficientTable) else max(values)
    return 0.5 * (float(static) + float(below))


def _fastest(law: Any) -> float:
    """The largest slip of the sweep [rad/s]."""
    points: Any = getattr(law, "kinetic", 0.0)
    if hasattr(law, "speeds"):
        return 1.2 * float(law.speeds[-1])
    if isinstance(law, cw.FrictionTable):
        return 1.2 * float(points[-1][0])
    return SWEEP * SOFT.speed


def _there_and_back(fastest: float) -> cw.Table:
    return cw.Table([(0.0, 0.0), (0.25 * T_END, fastest), (0.75 * T_END, -fastest), (T_END, 0.0)])


def _small() -> cw.Table:
    """A speed that changes its sign at each turn."""
    points, speed = [(0.0, SMALL)], SMALL
    for time in TURNS:
        points += [(time, speed), (time, -speed)]
        speed = -speed
    return cw.Table([*points, (T_END, speed)])
