"""Damaged files: the package's own errors only, each within 2 s and 500 MB."""

from __future__ import annotations

import os
import subprocess
import sys

import pytest

from support.amount import amount
from support.fuzz.cases import CASES

# a process that hangs where no signal is heard
LONGEST = 2.0


@pytest.mark.random
@pytest.mark.parametrize("kind", CASES)
def test_damaged_files_are_refused_in_words(kind, root):
    count = amount()
    command = [sys.executable, "-m", "support.fuzz.worker", kind, "0", str(count)]
    done = subprocess.run(
        command,
        capture_output=True,
        text=True,
        check=False,
        cwd=root,
        env={**os.environ, "PYTHONPATH": str(root / "tests")},
        timeout=120.0 + LONGEST * count,
    )
    assert done.stdout + done.stderr == ""
    assert done.returncode == 0
