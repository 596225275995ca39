"""Sphinx configuration; `make docs` builds, warnings are errors."""

from __future__ import annotations

import sys
import tomllib
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parent / "tools"), str(HERE / "figures")]

import experiments  # noqa: E402
import launches  # noqa: E402

import gen_docs  # noqa: E402
import gen_lists  # noqa: E402
import parity  # noqa: E402

gen_docs.write(HERE / "reference")
gen_lists.write(HERE / "reference")
experiments.write(HERE / "reference" / "rig")
launches.write(HERE / "reference" / "car")
parity.write(HERE / "reference")

_project = tomllib.loads((HERE.parent / "pyproject.toml").read_text(encoding="utf-8"))["project"]
project = _project["name"]
author = "the clutchwork authors"
copyright = "the clutchwork authors, Apache-2.0"
release = version = _project["version"]

extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.mathjax"]
source_suffix = {".md": "markdown"}
exclude_patterns = ["_build"]
nitpicky = False

myst_enable_extensions = ["dollarmath", "amsmath", "colon_fence", "deflist"]
myst_heading_anchors = 3
myst_dmath_double_inline = True

autodoc_member_order = "bysource"
autodoc_typehints = "description"
autodoc_typehints_description_target = "documented"

html_theme = "furo"
html_title = f"clutchwork {release}"
html_static_path = ["_static"]
html_show_sourcelink = False
