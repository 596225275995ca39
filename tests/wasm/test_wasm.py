"""The core as WebAssembly has the bits of the native one."""

from __future__ import annotations

import shutil
import subprocess
import warnings
from collections.abc import Iterator

import pytest

import clutchwork as cw
from clutchwork.declare.core import core
from clutchwork.declare.layout import METHODS
from clutchwork.page import core as module
from support import example_models, random_drivelines, random_parts, random_stops, six_speed
from support.amount import seeds
from support.project import ROOT
from support.wasm import WASM, Answer, Job, Stretch, grid, here, in_node

CASES = max(4, len(seeds()) // 6)


def jobs() -> Iterator[Job]:
    """Two shifts, one of them with another table on the way, all examples, random drivelines of every sort."""
    system = cw.Driveline.load(ROOT / "examples" / "six_speed" / "model.toml").assemble()
    yield Job(system, [Stretch(grid(4.0, 201))])
    system = six_speed.gearbox(six_speed.SHIFT, {"w1": 150.0, "w2": 150.0, "w8": 0.0}).assemble()
    yield Job(system, [Stretch(grid(4.0, 201))])
    number = next(k for k, item in enumerate(system.inputs) if item.name == "F1.pressure")
    later = cw.Table(((2.0, 0.0), (2.15, 0.2e6), (2.7, 0.7e6), (3.1, 2e6))).segments()[1:]
    yield Job(system, [Stretch(grid(2.1, 21)), Stretch(grid(4.0, 101, 2.1), number, later)])
    for name in example_models.MODELS:
        system, t_end = example_models.model(name)
        yield Job(system, [Stretch(grid(t_end))])
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        for seed in range(CASES):
            driveline = random_drivelines.describe(seed).driveline().assemble()
            yield Job(driveline, [Stretch(grid(2.0))], method=seed % len(METHODS))
            yield Job(random_parts.driveline(seed).assemble(), [Stretch(grid(1.0))])
            yield Job(random_stops.driveline(seed).assemble(), [Stretch(grid(0.5))])


JOBS = list(jobs())


@pytest.fixture(scope="module")
def as_wasm() -> list[Answer]:
    return in_node(JOBS)


def test_the_module_was_built_from_the_declarations_of_this_core() -> None:
    if not WASM.is_file():
        pytest.skip("core.wasm was not built: run make wasm")
    assert module.fits(WASM.read_bytes())


def test_what_is_no_module_or_another_one_is_seen() -> None:
    name = bytes([len(module.SECTION)]) + module.SECTION
    content = name + str(core().schema_hash() + 1).encode()
    other = module.MAGIC + b"\1\2ab" + b"\0" + bytes([len(content)]) + content
    assert module.schema_of(other) == core().schema_hash() + 1
    assert not module.fits(other)
    assert module.schema_of(module.MAGIC + b"\1\2ab") is None
    assert module.schema_of(b"<html>") is None


def test_it_is_small_and_asks_for_nothing() -> None:
    node = shutil.which("node")
    if node is None or not WASM.is_file():
        pytest.skip("needs node, and make wasm")
    import gzip

    # the size that the guide names, and what a small change adds
    assert len(gzip.compress(WASM.read_bytes(), 9)) <= 349e3
    asked = "const m = new WebAssembly.Module(require('fs').readFileSync(process.argv[1]));"
    asked += "console.log(WebAssembly.Module.imports(m).length)"
    done = subprocess.run([node, "-e", asked, str(WASM)], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "0"


@pytest.mark.always
def test_runs_have_the_bits_of_the_native_core(as_wasm: list[Answer]) -> None:
    """Another compiler, another processor, other forms of motion: the same bits of rows and events."""
    for place, (job, one, other) in enumerate(zip(JOBS, as_wasm, here(JOBS), strict=True)):
        name = f"{place}, {job.system.name}"
        assert one.status == other.status, name
        assert one.rows.tobytes() == other.rows.tobytes(), name
        assert one.events.tobytes() == other.events.tobytes(), name
