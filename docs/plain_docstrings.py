"""Docstrings as reStructuredText: plain text, code and names in backticks, indented formulas, sections."""

from __future__ import annotations

import re


def as_restructured(lines: list[str]) -> list[str]:
    """Return the lines without markup but backticks, indented text set verbatim.

    Sections of numpydoc, from their headings on, become definition lists, and their examples code.
    """
    rules = [n for n, line in enumerate(lines) if re.fullmatch("-{3,}", line) and n and lines[n - 1]]
    starts = [n - 1 for n in rules]
    out = _prose(lines[: starts[0]] if starts else lines)
    for start, end in zip(starts, [*starts[1:], len(lines)], strict=False):
        heading, body = lines[start], lines[start + 2 : end]
        if heading in ("Notes", "References"):
            body = _prose(body)
        elif heading != "Examples":
            body = [f"{_indent(line)}{_escaped(line.strip())}" for line in body]
        out += ["", f"**{heading}**", "", *body, ""]
    return out


def _indent(line: str) -> str:
    return line[: len(line) - len(line.lstrip())]


def _prose(lines: list[str]) -> list[str]:
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
