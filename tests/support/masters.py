"""Runs an FMU in a master that is compiled from C or C++, in a process of its own: MASTER FMU STEPS NAME...

Prints the reals of these names at the end of STEPS steps of 1 ms as JSON, after what the master itself has to say.
"""

from __future__ import annotations

import ctypes
import json
import subprocess
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

STEP = 1e-3  # s


def libcosim(path: str, steps: int, names: Sequence[str]) -> list[float]:
    """The library of the Open Simulation Platform, over FMILibrary."""
    from libcosimpy.CosimExecution import CosimExecution
    from libcosimpy.CosimLogging import CosimLogLevel, log_output_level
    from libcosimpy.CosimObserver import CosimObserver
    from libcosimpy.CosimSlave import CosimLocalSlave

    log_output_level(CosimLogLevel.WARNING)
    master = CosimExecution.from_step_size(step_size=1e9 * STEP)
    one = master.add_local_slave(CosimLocalSlave(fmu_path=path, instance_name="one"))
    seen = CosimObserver.create_last_value()
    master.add_observer(seen)
    assert master.step(steps)
    number = {variable.name.decode(): variable.reference for variable in master.slave_variables(one)}
    return list(seen.last_real_values(one, [number[name] for name in names]))


def ecos(path: str, steps: int, names: Sequence[str]) -> list[float]:
    """Ecos, over importers of its own for both versions of FMI."""
    for library in Path(sys.prefix, "lib").glob("libtbb.so.12"):
        ctypes.CDLL(str(library))
    from ecospy import EcosSimulation, EcosSimulationStructure

    structure = EcosSimulationStructure()
    structure.add_model("one", path)
    with EcosSimulation(structure=structure, step_size=STEP) as master:
        master.init()
        master.step(steps)
        return [master.get_real(f"one::{name}") for name in names]


MASTERS: dict[str, Callable[[str, int, Sequence[str]], list[float]]] = {"libcosim": libcosim, "ecos": ecos}


def run(master: str, path: Path, steps: int, names: Sequence[str]) -> tuple[dict[str, float], str]:
    """The reals at the end, and what the master wrote beside them."""
    command: list[Any] = [sys.executable, __file__, master, path, str(steps), *names]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr
    printed, _, last = done.stdout.rstrip().rpartition("\n")
    return dict(zip(names, json.loads(last), strict=True)), printed + done.stderr


if __name__ == "__main__":
    chosen, file, count, *wanted = sys.argv[1:]
    found = MASTERS[chosen](file, int(count), wanted)
    print(json.dumps(found), flush=True)
