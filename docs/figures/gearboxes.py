"""Draw the gearboxes of the documentation."""

from __future__ import annotations

from pathlib import Path

import clutchwork as cw

# file -> gearbox, kind of the picture, gear, whether levers are merged
PICTURES: dict[str, tuple[str, str, str | None, bool]] = {
    "eight_speed": ("zf-8hp70", "stick", None, False),
    "eight_speed_fourth": ("zf-8hp70", "stick", "4", False),
    "lepelletier": ("zf-6hp26", "stick", "5", False),
    "lever": ("zf-6hp26", "lever", "2", False),
    "merged": ("chrysler-62te", "lever", None, True),
    "plan": ("ford-aode", "speeds", None, False),
    "chart": ("zf-6hp26", "chart", None, False),
    "dual_clutch": ("vw-dq250", "axes", "3", False),
}


# file -> gearbox, kind, mode; speed and torque of the input, speed of the output
POINTS: dict[str, tuple[str, str, str, tuple[float, float, float]]] = {
    "power_split": ("toyota-p410", "stick", "split", (200.0, 100.0, 60.0)),
    "power_split_lever": ("toyota-p410", "lever", "split", (200.0, 100.0, 60.0)),
    "two_modes": ("gm-2ml70", "lever", "EVT2", (200.0, 200.0, 200.0)),
}


def write(folder: Path) -> list[Path]:
    """The pictures of the guide."""
    folder.mkdir(parents=True, exist_ok=True)
    for name, (box, kind, gear, merged) in PICTURES.items():
        cw.diagram(box, kind, gear=gear, merged=merged, path=folder / f"{name}.svg")
    for name, (known, kind, mode, (speed, torque, output_speed)) in POINTS.items():
        loaded = cw.Gearbox.load(known)
        point = loaded.operating_point(
            mode, speed=speed, torque=torque, output_speed=output_speed
        )
        cw.diagram(loaded, kind, point=point, path=folder / f"{name}.svg")
    return [folder / f"{name}.svg" for name in (*PICTURES, *POINTS)]
