"""The style of a picture: to be read beside its tables, or for a column of a paper.

A paper's picture has the width of one column (89 mm) or of both (183 mm), as most journals have them, and no
title over it: that is the caption's. What cannot be read without it, as how much displacements are enlarged,
stays in the picture.
"""

from __future__ import annotations

from dataclasses import dataclass

from sheetbench.errors import BadInput, require_choice

FORMATS = ("pdf", "svg", "png")
INCH = 25.4  # mm
WIDTHS = {"single": 89.0 / INCH, "double": 183.0 / INCH}  # inches


@dataclass(frozen=True)
class FigureStyle:
    """formats: the files' suffixes, each picture's own where there are none; narrow: of one column; titled:
    whether the scene's title stands over it."""

    formats: tuple[str, ...] = ()
    narrow: bool = False
    titled: bool = True

    @property
    def width(self) -> float:
        """Of the whole picture [inches]."""
        return WIDTHS["single" if self.narrow else "double"]

    def panels(self, count: int) -> tuple[int, int]:
        """Rows and columns of so many panels: side by side, or one above the other in one column."""
        return (count, 1) if self.narrow else (1, count)


PLAIN = FigureStyle()


def parse_figure(text: str | None) -> tuple[FigureStyle, ...]:
    """Return the styles that `--figure` names, one per width: formats with commas between them, a width after
    a colon for the formats before it, as `pdf`, `pdf,png:single` or `pdf:single,png:double`. Raises BadInput,
    naming the option."""
    if text is None:
        return (PLAIN,)
    found, width = dict[str, str](), "double"
    for item in reversed([*filter(str.strip, text.lower().split(","))]):
        name, colon, given = (part.strip() for part in item.partition(":"))
        require_choice("--figure", name, FORMATS)
        if name in found:
            raise BadInput(f"--figure = '{text}': {name} is there twice, and has one file")
        if colon:
            require_choice("the width in --figure", given, WIDTHS)
            width = given
        found[name] = width
    if not found:
        raise BadInput(f"--figure = '{text}': name a format: {', '.join(FORMATS)}")
    formats = {wide: tuple(name for name in reversed(found) if found[name] == wide) for wide in WIDTHS}
    return tuple(FigureStyle(of, wide == "single", False) for wide, of in formats.items() if of)
