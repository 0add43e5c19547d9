"""The documentation: `make docs` makes it of these pages, the docstrings and the scripts of examples/."""

import logging
import sys
from importlib.metadata import version as version_of
from pathlib import Path
from typing import Any

import pyvista

sys.path.insert(0, str(Path(__file__).parents[1]))
sys.path.insert(0, str(Path(__file__).parent))
from plain_docstrings import as_restructured
from study_pages import write_study_pages
from try_page import build as build_try_page
from verb_pages import write_verb_pages
from version_page import write_version_page

pyvista.BUILDING_GALLERY = pyvista.OFF_SCREEN = True
logging.getLogger("skfem").setLevel(logging.WARNING)  # it tells of every basis

project = "sheetbench"
version = release = version_of("sheetbench")
copyright = "the sheetbench developers, MIT licence"

extensions = ["myst_nb", "sphinx.ext.autodoc", "sphinx.ext.viewcode", "sphinx_gallery.gen_gallery"]
extensions += ["run_directive"]  # of this folder
source_suffix = {".md": "myst-nb", ".ipynb": "myst-nb", ".rst": "restructuredtext"}
TRY = Path(__file__).parent / "_try"  # the page that steps lattices in the browser, as it is copied
TRY.mkdir(exist_ok=True)
html_extra_path = ["_try"]
exclude_patterns = ["_build", "_try", "try", "examples/*.ipynb"]  # of the gallery: downloads
html_static_path, html_css_files = ["_static"], ["site.css"]
html_theme = "furo"
html_title = "sheetbench"
smartquotes_action = "qe"  # quotes and ellipses; an option's two dashes stay
templates_path: list[str] = []

myst_heading_anchors = 3
nb_execution_mode, nb_execution_timeout = "cache", 600  # run again only when their cells change
nb_execution_raise_on_error, nb_merge_streams, nb_output_stderr = True, True, "remove"
myst_enable_extensions = ["dollarmath"]

autodoc_typehints = "description"
autodoc_member_order = "bysource"
autodoc_default_options = {"members": True, "show-inheritance": False}

sphinx_gallery_conf = {
    "examples_dirs": "../examples",
    "gallery_dirs": "examples",
    "filename_pattern": r"/\d\d_",
    "within_subsection_order": "FileNameSortKey",
    "abort_on_example_error": True,
    "download_all_examples": False,
    "image_scrapers": ("matplotlib", "pyvista"),
    "show_memory": False,
    "write_computation_times": False,
    "min_reported_time": 1e9,  # times of a loaded machine are no documentation
}


def _plain(app: Any, what: str, name: str, what_of: Any, options: Any, lines: list[str]) -> None:
    lines[:] = as_restructured(lines)


def setup(app: Any) -> None:
    """The verbs', studies' and versions' pages before the pages are read, docstrings as they are written."""
    app.connect("builder-inited", lambda built: write_verb_pages(Path(built.srcdir) / "verbs"))
    app.connect("builder-inited", lambda built: write_study_pages(Path(built.srcdir)))
    app.connect("builder-inited", lambda built: write_version_page(Path(built.srcdir) / "versions.md"))
    app.connect("builder-inited", lambda built: print(f"docs/try: {build_try_page(TRY / 'try')}"))
    app.connect("autodoc-process-docstring", _plain)
