"""The site of the documents, which `cargo xtask site` lays out; it gives the address of the repository."""

import sys
from pathlib import Path

from sphinx.ext.napoleon.docstring import GoogleDocstring

project = "Concio"
author = "The Concio developers"
copyright = author  # noqa: A001
extensions = ["myst_parser", "sphinx.ext.autodoc"]
html_theme = "sphinx_book_theme"
html_title = "Concio"
html_theme_options = {
    "use_repository_button": True,
    "use_download_button": False,
    "home_page_in_toc": True,
    "show_navbar_depth": 1,
}
html_copy_source = False
# GitHub's anchors, down to the headings that documents link to.
myst_heading_anchors = 4
# Equations, listings of terminals and wall files stand as they are.
highlight_language = "none"
# The pages of python/ are the docstrings of the package. Its extension module is not needed: it says nothing of its own.
sys.path.insert(0, str(Path(__file__).parents[2] / "crates/concio-python/python"))
autodoc_mock_imports = ["concio._native"]
autodoc_default_options = {
    "members": True,
    "member-order": "bysource",
    "special-members": "__getitem__",
    "exclude-members": "__new__",
}
# Classes say in a docstring of their own what they are made of.
autodoc_class_signature = "separated"


def setup(app):
    """Reads Google's docstrings, which Sphinx's own extension does too: of properties it takes what stands before a colon for a type."""
    app.connect("autodoc-process-docstring", parsed)


def parsed(app, what, name, obj, options, lines):
    """A docstring as Sphinx reads it."""
    kind = "method" if what in ("attribute", "property") else what
    lines[:] = GoogleDocstring(lines, what=kind, name=name, obj=obj, options=options).lines()
