"""Text that is not ours escaped where it is shown: on a terminal, in Markdown and HTML, CSV.

A scene's name, its title and its probes' names may hold anything: escape sequences for a terminal, markup for
a browser, formulas for a spreadsheet. Every way to show text goes through one of these functions, once.
"""

from __future__ import annotations

import re
import unicodedata
from typing import Any

_CONTROL = ("Cc", "Cs", "Zl", "Zp")  # control characters, surrogates, separators of lines and paragraphs
_TURNING = "\u202a\u202b\u202c\u202d\u202e\u2066\u2067\u2068\u2069"  # change the direction of writing
_FORMULA = ("=", "+", "-", "@", "\t", "\r")


def terminal(text: str, keep: str = "") -> str:
    """Return the text with its control characters spelled out, as `\\x1b`, but for those in `keep`."""
    acting = {c for c in set(text) if c in _TURNING or unicodedata.category(c) in _CONTROL} - set(keep)
    spelled = {ord(c): c.encode("unicode_escape").decode("ascii") for c in acting}
    return text.translate(spelled)


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
