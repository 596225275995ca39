"""Launch, locked drive and engine braking with three friction laws: python examples/launch/launch.py [FOLDER]."""

from __future__ import annotations

import sys
from pathlib import Path

from clutchwork import rig


def check(result: rig.Result) -> None:
    """What the example claims."""
    naive, smooth, exact = (result[law] for law in ("naive_sign", "mykhalevych", "stribeck"))
    assert naive.status == "chatter", naive.status
    assert naive.time[-1] < 1.2, naive.time[-1]
    assert smooth.finished
    assert exact.finished
    assert exact["clutch.state"][-1] == "locked"
    # both carry the same torque once the clutch has closed: forwards, then backwards
    for law in (smooth, exact):
        torque = law["clutch.torque"]
        assert torque[law.time > 1.2].max() > 100.0
        assert abs(torque[-1] - exact["clutch.torque"][-1]) < 0.5


def main(folder: Path) -> None:
    """Run, tell, draw."""
    result = rig.stall(["naive_sign", "mykhalevych", "stribeck"])
    print(result)
    for path in result.save(folder):
        print(f"wrote {path}")
    check(result)


if __name__ == "__main__":
    main(Path(sys.argv[1] if len(sys.argv) > 1 else "out/launch"))
