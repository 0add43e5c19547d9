"""How far a lattice will be from a converged shell, foretold from cells and layers before anything is solved.

Of the largest displacement, with cells of side l on a sheet whose shorter side is a,

    e = (A + P p) ((1 + 0.57 γ) l/a)² + B ((1 − γ) l/δ)² + Σ C ((1 − γ) l/δ')²,

δ and δ' the widths of the load's layer and of those at bent edges (`comparisons.models.layers`), p the share
of point loads in the load, γ the grading. That the error goes with l² is the expansion of the lattice's
energy (docs/theory.md, sections 3 and 4: what is left are chords for arcs, oblique waves, the load lumped at
masses); the factors were set on scenes: the seventeen of the transfer study at 9 and 17 masses a
side and 44 drawn as the advisor's are (`--seed` 5 and 11 of `comparisons.advice.validation`), at 9. B depends
on what holds the sheet: it is large where edges hold a deflection in, so that a bent sheet stretches. Of
`consistent-membrane`, where `comparisons.models.method` takes it, only B of two adjacent edges is another. On
scenes that they were not set on `tests/test_expected_error.py` says how good it is: an order of magnitude to
choose a grid by, no error bar.
"""

from __future__ import annotations

from dataclasses import dataclass
from math import prod
from typing import Any

import numpy as np

from comparisons.models.layers import layers
from comparisons.models.method import MEMBRANE
from comparisons.models.scales import scales
from sheetbench.choices import CALIBRATION
from sheetbench.scenes import EDGES, Clamped, Curved, Hinged, PointLoad, Scene
from sheetbench.scenes.grading import Graded, amount
from sheetbench.scenes.grid import LAYERS, Grid

SMOOTH = 0.12  # A
ONE_EDGE, ADJACENT, OPPOSITE, HINGES = (
    0.14,
    0.28,
    0.35,
    0.08,
)  # B of one edge, two, opposite ones, hinges alone
BENT = 0.006  # C
POINT = 0.27  # P
KNOWN = (CALIBRATION, MEMBRANE)
ADJACENT_MEMBRANE = 0.06  # B of two adjacent edges, `consistent-membrane`


@dataclass(frozen=True)
class ExpectedError:
    """value: of the largest displacement; reason: what most of it comes from."""

    value: float
    reason: str

    def __str__(self) -> str:
        return f"about {100 * self.value:.2g} % off a converged shell to expect at this grid: {self.reason}"

    def as_dict(self) -> dict[str, Any]:
        """For JSON."""
        return dict(vars(self))


def expected_error(scene: Scene, method: str, grid: Grid, grading: Graded = 0.0) -> ExpectedError | None:
    """The error to expect of a lattice with the springs of a method, None where nothing is known: of methods
    other than KNOWN, of more than two layers, with actuators, and where edges move, are held in part or cut
    the sheet."""
    edges: set[str] = {s.edge for s in scene.supports}
    known = all(isinstance(s, Clamped | Hinged | Curved) and s.motion is None for s in scene.supports)
    if method not in KNOWN or grid[2] != LAYERS or scene.actuators or not edges or not known:
        return None
    side = min(scene.sheet.lengths)
    cell = max(length / (n - 1) for length, n in zip(scene.sheet.lengths, grid[:2], strict=True))
    by = amount(grading)
    inside, at_edges = (1.0 + (np.pi / 2.0 - 1.0) * by) * cell, (1.0 - by) * cell
    across = f"cells of {1e3 * cell:.3g} mm"
    parts = [(SMOOTH * (inside / side) ** 2, f"{across} on a side of {1e3 * side:.3g} mm")]
    parts.append((POINT * _point_share(scene) * (inside / side) ** 2, f"a point load on {across}"))
    for layer in layers(scene):
        factor = BENT if layer.bent_edge else _of_load(scene, edges, method)
        parts.append((factor * (at_edges / layer.width) ** 2, f"{layer}, on {across}"))
    return ExpectedError(float(sum(value for value, _ in parts)), max(parts)[1])


def _of_load(scene: Scene, edges: set[str], method: str) -> float:
    """B of what holds the sheet."""
    if len(edges) == 1:
        return ONE_EDGE
    if not any(isinstance(s, Clamped | Curved) for s in scene.supports):
        return HINGES
    adjacent = len(edges) == 2 and len({EDGES[edge].normal_axis for edge in edges}) == 2
    if not adjacent:
        return OPPOSITE
    return ADJACENT if method == CALIBRATION else ADJACENT_MEMBRANE


def _point_share(scene: Scene) -> float:
    """The share of point loads in the load."""
    whole = scales(scene).load * prod(scene.sheet.lengths)
    points = [load for load in scene.loads if isinstance(load, PointLoad)]
    pulled = sum(abs(load.last_factor) * float(np.linalg.norm(load.force)) for load in points)
    return pulled / whole if whole else 0.0
