"""Text that is not ours escaped where it is shown: on a terminal, in Markdown and HTML, CSV.

A scene's name, its title and its probes' names may hold anything: escape sequences for a terminal, markup for
a browser, formulas for a spreadsheet. Every way to show text goes through one of these functions, once.
"""

from __future__ import annotations

import re
from typing import Any

from sheetbench.errors import printable as terminal

_FORMULA = ("=", "+", "-", "@", "\t", "\r")


def html(text: str) -> str:
    """Return the text without tags, for Markdown that is ours; lines stay lines."""
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
    """Return the value of a CSV cell: text that a spreadsheet would take for a formula starts with an
    apostrophe."""
    return f"'{value}" if isinstance(value, str) and value.startswith(_FORMULA) else value
