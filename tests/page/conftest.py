"""What tests of pages need: the built files, node, and a browser."""

from __future__ import annotations

import json
import shutil
import subprocess
from pathlib import Path
from typing import Any

import pytest

from clutchwork.page import static
from support.project import ROOT

ENGINE = ROOT / "build" / "page" / "node.mjs"
HERE = Path(__file__).parent
RUNNER = HERE / "run.mjs"
MODULES = ROOT / "interfaces" / "page"
BROWSERS = {"chromium": ("chromium", "chromium-browser", "google-chrome"), "firefox": ("firefox", "firefox-esr")}


@pytest.fixture(scope="session")
def built() -> None:
    """Pages can be made."""
    lacking = static.missing()
    if lacking:
        pytest.skip(f"{', '.join(lacking)} not built: make wasm page")


@pytest.fixture(scope="session")
def node(built: None) -> str:
    """The program that runs the engine of a page without a browser."""
    found = shutil.which("node")
    if found is None or not ENGINE.is_file():
        pytest.skip("node or the engine of the page is missing: make page")
    return found


@pytest.fixture(scope="session")
def engine(node: str, tmp_path_factory: pytest.TempPathFactory) -> Any:
    """A function of (data of a page, jobs) -> what its engine made of each."""
    folder = tmp_path_factory.mktemp("engine")

    def run(data: dict[str, Any], jobs: list[dict[str, Any]]) -> list[dict[str, Any]]:
        asked = folder / "asked.json"
        asked.write_text(json.dumps({"data": data, "jobs": jobs}), encoding="utf-8")
        command = [node, str(RUNNER), str(ENGINE), str(static.FOLDER / static.CORE), str(asked)]
        done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=600)
        assert done.returncode == 0, done.stderr[-2000:]
        made: list[dict[str, Any]] = json.loads(done.stdout)
        return made

    return run


@pytest.fixture(scope="session")
def browse(node: str) -> Any:
    """A function of (program here, browser, what it is given) -> what it printed, of JSON."""

    def run(program: str, browser: str, *given: Any) -> Any:
        found = next(filter(None, map(shutil.which, BROWSERS[browser])), None)
        if found is None:
            pytest.skip(f"no browser: none of {', '.join(BROWSERS[browser])} is installed")
        if not (MODULES / "node_modules" / "puppeteer-core").is_dir():
            pytest.skip("puppeteer-core is missing: make page")
        command = [node, str(HERE / program), str(MODULES), found, *map(str, given)]
        done = subprocess.run(command, capture_output=True, text=True, check=False, timeout=900)
        assert done.returncode == 0, done.stderr[-2000:]
        return json.loads(done.stdout)

    return run
