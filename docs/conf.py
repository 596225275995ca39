"""Sphinx configuration; `make docs` builds, warnings are errors."""

from __future__ import annotations

import sys
from pathlib import Path

HERE = Path(__file__).resolve().parent
sys.path[:0] = [str(HERE.parent / "tools"), str(HERE / "figures"), str(HERE)]

import live  # noqa: E402

import clutchwork  # noqa: E402
import element_figures  # noqa: E402
import gen_docs  # noqa: E402
import gen_lists  # noqa: E402
import parity  # noqa: E402

element_figures.draw_all()
gen_docs.write(HERE / "reference")
gen_lists.write(HERE / "reference")
live.write(HERE / "reference" / "pages")
parity.write(HERE / "reference")

# what is public is documented by its public name, wherever it is defined
for _thing in (getattr(clutchwork, name) for name in clutchwork.__all__):
    if callable(_thing):
        _thing.__module__ = "clutchwork"

project = "clutchwork"
author = "the clutchwork authors"
copyright = "the clutchwork authors, Apache-2.0"
release = version = clutchwork.__version__

extensions = ["myst_parser", "sphinx.ext.autodoc", "mathml", "forge"]
source_suffix = {".md": "markdown"}
exclude_patterns = [
    "_build",
    "elements",
    "reference/pages",
    "*.fingerprint",
    "**/*.fingerprint",
]
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
html_favicon = "_static/favicon.svg"
html_static_path = ["_static", "reference/static"]
# pages that compute, below live/
html_extra_path = ["reference/pages"]
html_css_files = ["site.css"]
html_math_renderer = "mathml"
html_show_sourcelink = False
html_theme_options = {"footer_icons": [], "top_of_page_buttons": []}
