"""The site of the documents, which `cargo xtask site` lays out; it gives the address of the repository."""

project = "Concio"
author = "The Concio developers"
copyright = author  # noqa: A001
extensions = ["myst_parser"]
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
