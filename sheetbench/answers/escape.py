"""Escaping of foreign text for display: on a terminal, in Markdown and HTML, in CSV.

A scene's name, its title and its probes' names may hold anything: escape sequences for a terminal, markup for
a browser, formulas for a spreadsheet. Every display of text calls one function of this module, once.
"""

import re
from typing import Any

from sheetbench.errors import printable as terminal

_FORMULA = ("=", "+", "-", "@", "\t", "\r")


def html(text: str) -> str:
    """Return the text with its tags escaped, for HTML and for Markdown; lines stay lines."""
    plain = terminal(text, keep="\n")
    return plain.replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;")


def markdown(text: str) -> str:
    """Return the text on one line, without markup and links."""
    line = html(" ".join(text.split()))
    return re.sub(r"([\\`*]|\](?=[(\[:])|(?<!\w)_|_(?!\w)|^[#>+-](?=\s))", r"\\\1", line)


def cell(text: str) -> str:
    """Return the text in a cell of a Markdown table."""
    return markdown(text).replace("|", "\\|")


def csv_cell(value: Any) -> Any:
    """Return the value of a CSV cell, with an apostrophe before text that starts like a formula."""
    return f"'{value}" if isinstance(value, str) and value.startswith(_FORMULA) else value
