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


def parse_figure(text: str | None) -> FigureStyle:
    """Return the style that `--figure` asks for: formats with commas between them, a width after a colon, as
    `pdf`, `pdf,png` or `svg:single`. Raises BadInput, naming the option."""
    if text is None:
        return PLAIN
    names, colon, width = text.partition(":")
    formats = tuple(dict.fromkeys(name.strip().lower() for name in names.split(",") if name.strip()))
    if not formats:
        raise BadInput(f"--figure = '{text}': name a format: {', '.join(FORMATS)}")
    for name in formats:
        require_choice("--figure", name, FORMATS)
    if colon:
        require_choice("the width in --figure", width.strip(), WIDTHS)
    return FigureStyle(formats, narrow=width.strip() == "single", titled=False)
