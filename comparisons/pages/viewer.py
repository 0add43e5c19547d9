"""The viewer's script and style, to be put into a page: they ask for nothing and evaluate nothing.

The script is `source/` bundled with three.js by `make viewer`; the page calls `Sheets.createViewer(element,
options)`, whose options `source/index.js` describes and `comparisons.pages.sheets` makes.
"""

from __future__ import annotations

from functools import cache
from importlib import resources


@cache
def script() -> str:
    """JavaScript that defines `Sheets`."""
    return _read("viewer.js")


@cache
def style() -> str:
    """Return the style sheet, light and dark."""
    return _read("viewer.css")


def _read(name: str) -> str:
    return resources.files("comparisons.pages").joinpath(name).read_text(encoding="utf-8")
