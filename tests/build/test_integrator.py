"""A new integrator is its header, a line in run/methods.hpp and its name; nothing else counts them."""

from __future__ import annotations

import subprocess
from pathlib import Path

from support import project
from support.refused import edit

RUN = "cpp/include/clutchwork/run"
NAMES = "src/clutchwork/declare/layout.py"


def compiled(copy: Path) -> str:
    """What the compiler says about all phases of the sparse form, and about the C API."""
    made = project.generate(copy)
    assert made.returncode == 0, made.stderr
    include = [f"-I{copy / folder}" for folder in ("cpp/include", "cpp/src", "gen")]
    units = [str(copy / "cpp/src" / name) for name in ("phases_sparse.cpp", "c_api.cpp")]
    command = ["c++", "-std=c++20", "-fsyntax-only", "-Wall", "-Wextra", "-Werror", *include, *units]
    return subprocess.run(command, capture_output=True, text=True, check=False).stderr


def write_header(copy: Path) -> None:
    """Ralston's name on the coefficients of another method: what it computes is not asked here."""
    text = (copy / f"{RUN}/integrator/dopri5.hpp").read_text()
    text = text.replace("struct Dopri5", "struct Ralston").replace("Method::dopri5", "Method::ralston")
    (copy / f"{RUN}/integrator/ralston.hpp").write_text(text)


def write_name(copy: Path) -> None:
    # steps of one length, which have no phases, are the last
    edit(copy / NAMES, '"fixed": 3', '"ralston": 3, "fixed": 4')


def write_line(copy: Path) -> None:
    edit(copy / f"{RUN}/methods.hpp", "Dopri5>", "Dopri5, Ralston>")
    edit(copy / f"{RUN}/methods.hpp", "dopri5.hpp>", "dopri5.hpp>\n#include <clutchwork/run/integrator/ralston.hpp>")


def test_a_third_integrator_costs_a_header_and_a_line(copy: Path) -> None:
    for write in (write_header, write_name, write_line):
        write(copy)
    assert compiled(copy) == ""


def test_a_name_without_an_integrator_ends_the_build(copy: Path) -> None:
    write_name(copy)
    assert "as many integrators as Method names" in compiled(copy)
