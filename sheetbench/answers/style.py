"""Style of plots for papers: fonts, neutral colours, text from scenes, and files in every format."""

import textwrap
from collections.abc import Iterable
from pathlib import Path
from typing import Any

from cycler import cycler
from matplotlib import rc_context
from matplotlib.figure import Figure

from sheetbench.files import replacing

DPI = 300  # of pictures as PNG, and of rendered parts in PDF and SVG
PIXELS = 1080  # across a rendered sheet: 1.5 times those of a third of the page at DPI
MOST = 12  # probes with a panel or a line of their own
DARK, GREY = "#222222", "#8a8a8a"
# Okabe and Ito's colours, which everyone can distinguish.
SERIES = ("#0072b2", "#e69f00", "#009e73", "#cc79a7", "#56b4e9", "#d55e00", "#999933", "#882255")
COMPONENTS = dict(zip(("ux", "uy", "uz"), (SERIES[0], SERIES[2], SERIES[5]), strict=True))
STYLE: Any = {
    "font.family": "DejaVu Sans",
    "font.size": 7.5,
    "axes.prop_cycle": cycler(color=SERIES),
    "axes.edgecolor": GREY,
    "axes.linewidth": 0.6,
    "axes.spines.right": False,
    "axes.spines.top": False,
    "axes.labelcolor": DARK,
    "text.color": DARK,
    "xtick.color": DARK,
    "ytick.color": DARK,
    "pdf.fonttype": 42,  # TrueType, embedded: journals refuse Type 3
    "svg.fonttype": "path",  # text as curves, for machines without this font
    "svg.hashsalt": "sheetbench",
}
DESCRIPTION = {".pdf": "Subject", ".svg": "Description", ".png": "Description"}
UNDATED: Any = {".pdf": {"CreationDate": None}, ".svg": {"Date": None}, ".png": {}}


def save(figure: Figure, paths: Iterable[Path], description: str = "") -> None:
    """Write a figure to every path, in the format of its suffix (.png, .pdf, .svg), whole or not at all.

    description: kept in the file's metadata. Files of equal figures have equal bytes: they contain no date.
    """
    for path in paths:
        words = {DESCRIPTION[path.suffix]: description} if description else {}
        with replacing(path) as partial, rc_context(STYLE):
            figure.savefig(partial, dpi=DPI, facecolor="white", metadata={**UNDATED[path.suffix], **words})


def plain(text: str, width: int | None = None, longest: int | None = None) -> str:
    """Return text of a scene for a figure, without control characters and mathematics.

    width: of lines, which are broken; longest: of the text, which is cut with an ellipsis.
    """
    shown = " ".join("".join(c if c.isprintable() else " " for c in text).split())
    if longest is not None and len(shown) > longest:
        shown = shown[: longest - 1].rstrip() + "…"
    if width is not None:
        shown = textwrap.fill(shown, width)
    return shown.replace("$", r"\$")
