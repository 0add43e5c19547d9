"""How much finer a lattice's cells are at the edges of the sheet: towards all of them, or towards some.

A number from 0 (cells of one size) to 1 is of every edge, a `Grading` of those that it names; in text
0.5:x0 or 0.5:x0,x1. Of two opposite edges both, one or neither may be named: where it is one the cells at the
other are as long as in the middle of a sheet twice as long that is graded at both ends, where it is neither
they are of one size.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import Any

from sheetbench.errors import BadInput
from sheetbench.scenes.sheet import EDGES


@dataclass(frozen=True)
class Grading:
    """by: above 0, to 1; edges: those towards which cells are finer, some of the four."""

    by: float
    edges: tuple[str, ...]

    def __format__(self, form: str) -> str:
        return f"{self.by:{form}}:{','.join(self.edges)}"

    def __str__(self) -> str:
        return f"{self:g}"

    def ends(self, axis: int) -> tuple[bool, bool]:
        """Whether cells are finer towards the lower and towards the upper end of an axis."""
        return f"{'xy'[axis]}0" in self.edges, f"{'xy'[axis]}1" in self.edges


Graded = float | Grading


def towards(by: float, edges: Iterable[str] | None = None) -> Graded:
    """Graded by a number from 0 to 1 towards the edges named, all of them for None: the number where
    that is towards all or 0. Raises BadInput for anything else."""
    if not 0.0 <= by <= 1.0:
        raise BadInput(f"grading = {by:g}: 0 (all cells alike) to 1 (finest at the edges)")
    named = tuple(EDGES) if edges is None else tuple(edges)
    if unknown := [edge for edge in named if edge not in EDGES]:
        raise BadInput(f"grading = {by:g}:{','.join(named)}: {unknown[0]!r} is none of {', '.join(EDGES)}")
    if not named:
        raise BadInput(f"grading = {by:g}: towards no edge; name some of {', '.join(EDGES)}")
    chosen = tuple(edge for edge in EDGES if edge in named)
    return by if not by or chosen == tuple(EDGES) else Grading(by, chosen)


def amount(grading: Graded) -> float:
    """The number, whatever edges it is of."""
    return grading.by if isinstance(grading, Grading) else grading


def mirrored(grading: Graded, axis: int) -> bool:
    """Whether cells are the same from either end of an axis."""
    return not isinstance(grading, Grading) or len(set(grading.ends(axis))) == 1


def as_settings(grading: Graded) -> dict[str, Any]:
    """As documents have it: `grading`, and `graded_edges` where it is not of all edges."""
    if isinstance(grading, Grading):
        return {"grading": grading.by, "graded_edges": list(grading.edges)}
    return {"grading": grading}


def of_settings(settings: Mapping[str, Any]) -> Graded:
    """What `as_settings` has written; 0 where nothing is said."""
    return towards(settings.get("grading") or 0.0, settings.get("graded_edges"))
