"""Docstrings as reStructuredText: plain text as they are, code and names in backticks, formulas indented."""

from __future__ import annotations

import re


def as_restructured(lines: list[str]) -> list[str]:
    """The lines with what is indented set as it stands, and everything else without markup but backticks."""
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
