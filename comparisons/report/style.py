"""The dress of plots for papers, and their two neutral colours."""

from __future__ import annotations

from typing import Any

DARK, GREY = "#222222", "#8a8a8a"
STYLE: Any = {
    "font.family": "DejaVu Sans",
    "font.size": 7.5,
    "axes.edgecolor": GREY,
    "axes.linewidth": 0.6,
    "axes.labelcolor": DARK,
    "text.color": DARK,
    "xtick.color": DARK,
    "ytick.color": DARK,
    "pdf.fonttype": 42,
}
