"""Draw the animation at the top of the README: the page of the six-speed gearbox, in which a knot is dragged.

Usage: PYTHON tools/front_picture.py FILE, in a checkout with `make wasm page` and with Chromium: make picture.
"""

from __future__ import annotations

import json
import math
import shutil
import subprocess
import sys
from pathlib import Path
from tempfile import TemporaryDirectory

from PIL import Image

import clutchwork as cw

ROOT = Path(__file__).resolve().parent.parent
BROWSERS = ("chromium", "chromium-browser", "google-chrome")
KNOT = "F1.pressure, knot 8"
# frames of the way there and back, and how long each is shown [ms]
FRAMES, SHOWN, REST = 28, 110, 900
UP, DOWN = 38.0, 20.0
# what the picture shows has few colours; more make the file larger
COLOURS = 48


def page(path: Path) -> None:
    """The page of the 3-4 shift."""
    run = cw.Driveline.load(ROOT / "examples" / "six_speed" / "model.toml").simulate()
    run.page(
        path, drag=["F1.pressure", "F2.pressure"], sliders=[], show=["w1.speed", "w8.speed", "F1.torque", "F2.torque"]
    )


def way() -> list[tuple[float, float]]:
    """Places of the hand [px]: up and to the left, where it locks early, down, where it slips on, and back."""
    sides = [math.sin(2.0 * math.pi * number / FRAMES) for number in range(FRAMES + 1)]
    return [(0.0, 0.0), *((-6.0 * side, -(UP if side > 0.0 else DOWN) * side) for side in sides)]


def frames(folder: Path) -> list[Image.Image]:
    """What the browser shows at each place."""
    page(folder / "page.html")
    browser = next(filter(None, map(shutil.which, BROWSERS)), None)
    if browser is None:
        raise SystemExit(f"the picture needs one of {', '.join(BROWSERS)}")
    program = [str(ROOT / "tests" / "page" / "frames.mjs"), str(ROOT / "interfaces" / "page")]
    command = ["node", *program, browser, str(folder), str(folder / "page.html"), KNOT, json.dumps(way())]
    done = subprocess.run(command, check=True, stdout=subprocess.PIPE, text=True)  # noqa: S603 - our own program
    if done.stdout:
        raise SystemExit(done.stdout)
    return [Image.open(path).convert("RGB") for path in sorted(folder.glob("*.png"))]


def write(found: list[Image.Image], path: Path) -> None:
    """All frames with the colours of the one that has most of them."""
    palette = found[len(found) // 4].quantize(COLOURS, dither=Image.Dither.NONE)
    drawn = [frame.quantize(palette=palette, dither=Image.Dither.NONE) for frame in found]
    # the hand rests at the begin and where a curve is extreme
    rests = {0, 1 + FRAMES // 4, 1 + 3 * FRAMES // 4}
    shown = [REST if number in rests else SHOWN for number in range(len(drawn))]
    drawn[0].save(path, save_all=True, append_images=drawn[1:], duration=shown, loop=0, optimize=True)


def main() -> None:
    """Write the file."""
    path = Path(sys.argv[1])
    with TemporaryDirectory() as folder:
        write(frames(Path(folder)), path)
    sys.stdout.write(f"{path}: {path.stat().st_size / 1e3:.0f} kB\n")


if __name__ == "__main__":
    main()
