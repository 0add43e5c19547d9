"""The study of Habibi et al. again, part by part.

tables    tests 1 and 2: published model and experiment, our lattices, our shell with its error bar
settling  the run from rest, and what it takes

What in the published figures contradicts itself, and which sheets come nearest to them, is a study
(`studies.reproduction`).
"""

from __future__ import annotations

from collections.abc import Callable, Collection
from typing import Any

from comparisons.models.grids import Elements
from comparisons.report.work import Work, silent
from comparisons.reproduction.answers import answers
from comparisons.reproduction.settling import settling
from comparisons.reproduction.tables import Reproduction
from sheetbench.choices import ELEMENTS

PARTS = ("tables", "settling")


def reproduce(
    parts: Collection[str] = PARTS,
    *,
    elements: Elements = ELEMENTS,
    progress: Callable[[str | Work], None] = silent,
) -> Reproduction:
    """Return these parts of the study; elements: of the shell; progress: called with what is being done."""
    parts_done: dict[str, Any] = {}
    if "tables" in parts:
        parts_done["answers"] = tuple(answers(elements, progress))
    if "settling" in parts:
        parts_done["settling"] = settling(progress=progress)
    return Reproduction(tuple(part for part in PARTS if part in parts), elements, **parts_done)
