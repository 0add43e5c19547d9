"""The style of a picture: for a page with its tables, or for a column of a paper.

A paper's picture has the width of one column (89 mm) or of both (183 mm), as in most journals, and no title:
the caption has it. Text that is needed to read the picture, as the scale of displacements, stays in it.
"""

from dataclasses import dataclass

from sheetbench.errors import BadInput, require_choice

FORMATS = ("pdf", "svg", "png")
INCH = 25.4  # mm
WIDTHS = {"single": 89.0 / INCH, "double": 183.0 / INCH}  # inches


@dataclass(frozen=True)
class FigureStyle:
    """Style of a picture. formats: the files' suffixes, each picture's own if empty. narrow: one column wide.
    titled: with the scene's title over it."""

    formats: tuple[str, ...] = ()
    narrow: bool = False
    titled: bool = True

    @property
    def width(self) -> float:
        """Return the width of the whole picture [inches]."""
        return WIDTHS["single" if self.narrow else "double"]

    def panels(self, count: int) -> tuple[int, int]:
        """Return the rows and columns of a number of panels: side by side, or in one column if narrow."""
        return (count, 1) if self.narrow else (1, count)


PLAIN = FigureStyle()


def parse_figure(text: str | None) -> tuple[FigureStyle, ...]:
    """Return the styles that the value of `--figure` names, one per width. Formats are separated by commas; a
    width follows the formats after a colon: `pdf`, `pdf,png:single`, `pdf:single,png:double`. Raises
    BadInput, which names the option."""
    if text is None:
        return (PLAIN,)
    width_of, width = dict[str, str](), "double"
    for item in reversed([*filter(str.strip, text.lower().split(","))]):
        name, colon, given = (part.strip() for part in item.partition(":"))
        require_choice("--figure", name, FORMATS)
        if name in width_of:
            raise BadInput(f"--figure = '{text}': {name} is named twice")
        if colon:
            require_choice("the width in --figure", given, WIDTHS)
            width = given
        width_of[name] = width
    if not width_of:
        raise BadInput(f"--figure = '{text}': name a format: {', '.join(FORMATS)}")
    formats = {wide: tuple(name for name in reversed(width_of) if width_of[name] == wide) for wide in WIDTHS}
    return tuple(FigureStyle(of, wide == "single", False) for wide, of in formats.items() if of)
