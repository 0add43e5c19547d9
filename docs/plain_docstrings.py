"""Docstrings as reStructuredText: plain text unchanged, code and names in backticks, formulas indented.

Numpydoc sections (Parameters, Returns, …) are rendered by Sphinx' own extension napoleon.
"""

import re

from sphinx.ext.napoleon import Config, NumpyDocstring

UNDERLINE = re.compile(r"-{3,}")


def as_restructured(lines: list[str]) -> list[str]:
    """Return plain text, with indented blocks as literals and backticks as the only markup, then sections."""
    heads = [i - 1 for i, line in enumerate(lines) if UNDERLINE.fullmatch(line)]
    sections = [lines[i:j] for i, j in zip(heads, [*heads[1:], len(lines)], strict=False)]
    escaped = ["", *(line for section in sections for line in _section(section))]
    fields = NumpyDocstring(escaped, Config(napoleon_use_rtype=False)).lines() if sections else []
    fields = [re.sub(r"^(:(?:param|type) \w+)_:", r"\1\_:", line) for line in fields]  # no reference
    return _text(lines[: min(heads, default=len(lines))]) + fields


def _section(lines: list[str]) -> list[str]:
    """Return a numpydoc section for napoleon, with the text of its entries (or of its notes) escaped."""
    if lines[0] == "Examples":
        return lines
    if lines[0] == "Notes":
        return [*lines[:2], *_text(lines[2:])]
    return [f"    {_escaped(line.strip())}" if line.startswith(" ") else line for line in lines]


def _text(lines: list[str]) -> list[str]:
    """Return text with indented blocks as literals, and everything else without markup but backticks."""
    out: list[str] = []
    verbatim = listing = False
    for line in lines:
        indented = line.startswith(" ") and not listing
        if indented and not verbatim:
            out += ["", "::", ""]
        elif verbatim and line and not indented:
            out.append("")
        if line:
            verbatim = indented
            listing = line.startswith("- ") or (listing and line.startswith("  "))
        out.append(f"    {line}" if indented else _escaped(line))
    return out


def _escaped(line: str) -> str:
    parts = re.split(r"`+([^`]+)`+", line)
    plain = [re.sub(r"([\\*|_])", r"\\\1", part) for part in parts[::2]]
    code = [f"\\ ``{part}``\\ " for part in parts[1::2]]
    return "".join(text for pair in zip(plain, [*code, ""], strict=True) for text in pair)
