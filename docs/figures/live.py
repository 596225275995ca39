"""Make the pages that compute."""

from __future__ import annotations

import sys
from pathlib import Path

import kept

import clutchwork as cw
from clutchwork.declare.core import core
from clutchwork.page import static
from clutchwork.page.static import missing

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"
PACKAGE = Path(cw.__file__).parent
sys.path[:0] = [str(EXAMPLES / "calibrate_shift"), str(EXAMPLES.parent / "tools")]

import calibrate_shift  # noqa: E402

import law_pages  # noqa: E402

NOT_BUILT = (
    "<p>This page computes, but was not built here: run make wasm page docs.</p>"
)


def shift_run() -> cw.Trajectory:
    """The launch and shift of the front page."""
    return cw.Driveline.load(EXAMPLES / "six_speed" / "model.toml").simulate()


def shift(path: Path) -> None:
    """The shift of the front page."""
    shift_run().page(
        path,
        drag=["F1.pressure", "F2.pressure"],
        show=["w1.speed", "w8.speed", "F1.slip", "F1.torque", "F2.torque"],
    )


def stick_slip_run() -> cw.Trajectory:
    """A block on a belt, held by a spring."""
    d = cw.Driveline("block on a belt")
    block = d.mass("block", mass=1.0)
    wall = d.mass("wall", mass=1.0, speed=0.0)
    belt = d.mass("belt", mass=1.0)
    d.add(
        cw.PrescribedSpeed(
            "drive", shaft=belt, speed=cw.Table([(0.0, 0.1), (6.0, 0.1), (10.0, 1.0)])
        )
    )
    d.add(cw.PrescribedSpeed("fixed", shaft=wall, speed=0.0))
    d.add(
        cw.SpringDamper(
            "spring", base=wall, follower=block, stiffness=60.0, damping=0.2
        )
    )
    law = cw.Stribeck(static=0.6, kinetic=0.3, speed=0.2, viscous=0.52)
    d.add(
        cw.Clutch(
            "contact",
            base=belt,
            follower=block,
            friction=law,
            gain=1.0,
            normal_force=10.0,
        )
    )
    return d.simulate(10.0)


def stick_slip(path: Path) -> None:
    """The block on a belt, whose speed is dragged."""
    stick_slip_run().page(
        path,
        drag=["drive.speed"],
        sliders=[
            "contact.friction.static=0.3:1.0",
            "contact.friction.kinetic=0.1:0.6",
            "contact.friction.speed=0.02:1.0",
            "spring.stiffness=10:400",
        ],
        show=["block.speed", "contact.torque", "contact.torque over contact.slip"],
    )


def hysteresis_run() -> cw.Trajectory:
    """A contact that is moved back and forth before it slides."""
    d = cw.Driveline("small movements")
    plate = d.shaft("plate", inertia=1.0)
    points = [
        (0.0, 1e-3),
        (0.5, 1e-3),
        (0.5, -1e-3),
        (1.5, -1e-3),
        (1.5, 1e-3),
        (2.2, 1e-3),
        (2.2, -5e-4),
        (2.6, -5e-4),
        (2.6, 1e-3),
        (4.0, 1e-3),
    ]
    d.add(cw.PrescribedSpeed("move", shaft=plate, speed=cw.Table(points)))
    law = cw.LuGre(
        static=0.15, kinetic=0.1, speed=1e-3, stiffness=400.0, damping=0.9, viscous=0.5
    )
    d.add(cw.Brake("contact", shaft=plate, friction=law, gain=1.0, normal_force=100.0))
    return d.simulate(4.0)


def hysteresis(path: Path) -> None:
    """The contact that is moved back and forth, whose law is turned."""
    hysteresis_run().page(
        path,
        drag=[],
        sliders=[
            "contact.friction.stiffness=50:2000",
            "contact.friction.damping=0:20",
            "contact.friction.static=0.1:0.3",
            "contact.friction.speed=1e-4:1e-2",
        ],
        show=["contact.torque over plate.angle", "contact.torque", "plate.speed"],
    )


def calibrated_run() -> cw.Trajectory:
    """The shift of examples/calibrate_shift before it is calibrated."""
    case = calibrate_shift.eight_speed()
    return cw.simulate(case.system, case.t_end)


def calibrated(path: Path) -> None:
    """The shift of examples/calibrate_shift, by hand."""
    calibrated_run().page(
        path,
        drag=["gearbox.C.pressure", "gearbox.E.pressure"],
        sliders=["gearbox.C.gain"],
        show=["gearbox.C.slip", "gearbox.C.torque", "gearbox.E.torque", "car.speed"],
    )


PAGES = {
    "shift": shift,
    "stick_slip": stick_slip,
    "hysteresis": hysteresis,
    "calibrated": calibrated,
}


def _names() -> list[str]:
    return [*PAGES, *(f"law-{kind}" for kind in law_pages.kinds()), *cw.catalogue()]


def computing(name: str, path: Path) -> None:
    """Write the page of a model or of a law."""
    if name in PAGES:
        PAGES[name](path)
    else:
        law_pages.write(name.removeprefix("law-"), path)


def gearbox(name: str, path: Path) -> None:
    """Write the page of a gearbox of the catalogue."""
    cw.catalogue()[name].page(path)


def write(folder: Path) -> list[Path]:
    """All pages, below `live` of the folder, as they are in the documentation; those that have not changed are kept."""
    made = [folder / "live" / f"{name}.html" for name in _names()]
    made[0].parent.mkdir(parents=True, exist_ok=True)
    if missing():
        for path in made:
            path.write_text(NOT_BUILT, encoding="utf-8")
        return made
    boxes = [path for path in made if path.stem in cw.catalogue()]
    own = (Path(__file__), static.FOLDER)
    # a gearbox is drawn without the core
    rooms = (PACKAGE / name for name in ("base", "diagrams", "gearbox", "page"))
    kept.write(gearbox, boxes, (*own, *rooms))
    others = [path for path in made if path not in boxes]
    programs = (EXAMPLES, EXAMPLES.parent / "tools")
    kept.write(computing, others, (*own, PACKAGE, Path(core().__file__), *programs))
    return made
