"""Sphinx configuration; `make docs` builds, warnings are errors."""

from __future__ import annotations

import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parent / "tools"), str(HERE / "figures"), str(HERE)]

import calibrations  # noqa: E402
import drawings  # noqa: E402
import experiments  # noqa: E402
import gearboxes  # noqa: E402
import kept  # noqa: E402
import launches  # noqa: E402
import live  # noqa: E402
import schematics  # noqa: E402
import shuffle  # noqa: E402
import stories  # noqa: E402

import clutchwork  # noqa: E402
import examples  # noqa: E402
import gen_docs  # noqa: E402
import gen_lists  # noqa: E402
import parity  # noqa: E402
import shifts  # noqa: E402
import studies  # noqa: E402
import sweeps  # noqa: E402

gen_docs.write(HERE / "reference")
gen_lists.write(HERE / "reference")
kept.write(experiments.write, HERE / "reference" / "rig")
kept.write(launches.write, HERE / "reference" / "car")
kept.write(calibrations.write, HERE / "reference" / "calibrations")
kept.write(live.write, HERE / "reference" / "pages", live.built())
kept.write(studies.write, HERE / "reference" / "studies")
kept.write(sweeps.write, HERE / "reference" / "sweeps")
kept.write(drawings.write, HERE / "reference" / "pictures")
kept.write(schematics.write, HERE / "reference" / "schematics")
kept.write(gearboxes.write, HERE / "reference" / "diagrams")
kept.write(shifts.write, HERE / "reference" / "shifts")
kept.write(examples.write, HERE / "reference" / "examples")
kept.write(stories.write, HERE / "reference" / "stories")
kept.write(shuffle.write, HERE / "reference" / "linear")
parity.write(HERE / "reference")

# what is public is documented by its public name, wherever it is defined
for _thing in (getattr(clutchwork, name) for name in clutchwork.__all__):
    if callable(_thing):
        _thing.__module__ = "clutchwork"

project = "clutchwork"
author = "the clutchwork authors"
copyright = "the clutchwork authors, Apache-2.0"
release = version = clutchwork.__version__

extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx_design", "mathml"]
source_suffix = {".md": "markdown"}
exclude_patterns = ["_build", "elements", "reference/pages", "fingerprint"]
nitpicky = False

myst_enable_extensions = [
    "dollarmath",
    "amsmath",
    "attrs_block",
    "colon_fence",
    "deflist",
]
myst_heading_anchors = 3
myst_dmath_double_inline = True

autodoc_member_order = "bysource"
autodoc_typehints = "description"
autodoc_typehints_description_target = "documented"
maximum_signature_line_length = 88

html_theme = "furo"
html_title = "clutchwork"
html_static_path = ["_static", "reference/static"]
# pages that compute, below live/
html_extra_path = ["reference/pages"]
html_css_files = ["site.css"]
html_math_renderer = "mathml"
html_show_sourcelink = False
html_theme_options = {"footer_icons": [], "top_of_page_buttons": []}
