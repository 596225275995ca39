"""Make the pages that compute for the documentation, whose build calls this; they are never committed."""

from __future__ import annotations

import sys
from pathlib import Path

import clutchwork as cw
from clutchwork.page import static
from clutchwork.page.static import missing

EXAMPLES = Path(__file__).resolve().parents[2] / "examples"
sys.path[:0] = [str(EXAMPLES / "calibrate_shift"), str(EXAMPLES.parent / "tools")]

import calibrate_shift  # noqa: E402

import law_pages  # noqa: E402

NOT_BUILT = (
    "<p>This page computes, but was not built here: run make wasm page docs.</p>"
)


def shift(path: Path) -> None:
    """The shift of the front page."""
    run = cw.Driveline.load(EXAMPLES / "six_speed" / "model.toml").simulate()
    run.page(
        path,
        drag=["F1.pressure", "F2.pressure"],
        show=["w1.speed", "w8.speed", "F1.slip", "F1.torque", "F2.torque"],
    )


def stick_slip(path: Path) -> None:
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
    d.simulate(10.0).page(
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


def hysteresis(path: Path) -> None:
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
    d.simulate(4.0).page(
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


def calibrated(path: Path) -> None:
    """The shift of examples/calibrate_shift, by hand."""
    case = calibrate_shift.eight_speed()
    run = cw.simulate(case.system, case.t_end)
    run.page(
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


def built() -> list[Path]:
    """Files that all pages are made of, as far as they are there."""
    return [
        path
        for path in static.FOLDER.glob("*")
        if path.suffix in (".js", ".css", ".wasm")
    ]


def _names() -> list[str]:
    return [*PAGES, *(f"law-{kind}" for kind in law_pages.kinds()), *cw.catalogue()]


def write(folder: Path) -> list[Path]:
    """All pages, below `live` of the folder, as they are in the documentation."""
    made = [folder / "live" / f"{name}.html" for name in _names()]
    made[0].parent.mkdir(parents=True, exist_ok=True)
    if missing():
        for path in made:
            path.write_text(NOT_BUILT, encoding="utf-8")
        return made
    for name, page in PAGES.items():
        page(folder / "live" / f"{name}.html")
    for kind in law_pages.kinds():
        law_pages.write(kind, folder / "live" / f"law-{kind}.html")
    for name, box in cw.catalogue().items():
        box.page(folder / "live" / f"{name}.html")
    return made
