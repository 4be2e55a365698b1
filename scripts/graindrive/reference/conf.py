"""Sphinx's settings for the reference; every reference that leads nowhere is an error (scripts/docs calls it with -n -W)."""

from graindrive.reference import docstrings

project = "Graindrive"
copyright = "its authors, GPL-2.0-or-later"
extensions = ["myst_parser", "sphinx.ext.autodoc"]
root_doc = "index"
source_suffix = {".rst": "restructuredtext", ".md": "markdown"}
myst_heading_anchors = 4  # links as GitHub's, FILE.md#heading
# READMEs may begin below the first level, and hold blocks of programs that no lexer of Pygments reads.
suppress_warnings = ["myst.header", "misc.highlighting_failure"]
autodoc_docstring_signature = False  # of compiled functions: it would link to types that have no page
autodoc_typehints = "none"
autodoc_member_order = "bysource"
smartquotes = False  # values are in straight quotes
html_theme = "alabaster"
html_theme_options = {"page_width": "1100px", "sidebar_width": "260px"}
html_show_sourcelink = False


def setup(app):
    """Read docstrings as plain English."""
    app.connect("autodoc-process-docstring", docstrings.in_autodoc)
