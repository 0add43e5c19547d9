"""Lattice against shell on drawn sheets: errors at the probes as the grid is refined, and how fast they fall.

Required of 17 masses along the shorter side: 2 % of the largest displacement where rims lie along the axes,
4 % where they are oblique or round; that the error falls with order 1.5 and 1 from 9 to 33 masses. The shell
is taken as exact: `bar` is what its mesh leaves uncertain (`fem_reference.uncertainty`).

At a re-entrant corner of 270° with free sides a plate's moments go like r^(a − 1), sin(3πa/2) =
a (1 − ν)/(3 + ν), a = 0.65 at ν = 0.45 (Williams, J. Appl. Mech. 19 (1952) 526–528): on evenly refined grids
deflections come nearer with order 2a = 1.3 in the end, of every model whose cells do not shrink towards it.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from comparisons.comparison.comparison import error
from comparisons.models.resolve import resolve
from comparisons.models.solve import solve
from comparisons.models.spec import Lattice
from fem_reference.uncertainty import solve_with_bar
from sheetbench.scenes import Scene
from studies.drawn.scenes import OBLIQUE

GRIDS = (9, 17, 33)
ELEMENTS = 32
MASSES = 17  # masses along the shorter side


@dataclass(frozen=True)
class Row:
    """A scene's errors, shares of the largest displacement, by the number of masses along the shorter side;
    bar: the shell's."""

    scene: str
    oblique: bool
    errors: dict[int, float]
    bar: float

    @property
    def allowed(self) -> float:
        return 0.04 if self.oblique else 0.02

    @property
    def least_order(self) -> float:
        return 1.0 if self.oblique else 1.5

    def order(self, coarse: int, fine: int) -> float:
        """By which the error falls from one grid to another."""
        ratio = (fine - 1) / (coarse - 1)
        return float(np.log(self.errors[coarse] / self.errors[fine]) / np.log(ratio))

    @property
    def overall_order(self) -> float:
        return self.order(min(self.errors), max(self.errors))

    @property
    def misses(self) -> str:
        """Which requirement is missed, "" where none is."""
        near, steep = self.errors[MASSES] <= self.allowed, self.overall_order >= self.least_order
        return ", ".join(name for name, holds in (("error", near), ("order", steep)) if not holds)


def measure(scene: Scene, grids: Sequence[int] = GRIDS, elements: int = ELEMENTS) -> Row:
    """Solve a scene on lattices and on the shell."""
    points = scene.probe_points()
    _, shell = solve_with_bar(scene, points, elements=elements)
    if shell is None:
        raise RuntimeError(f"{scene.name}: the shell has no equilibrium")
    errors: dict[int, float] = {}
    for masses in grids:
        found = solve(resolve(scene, Lattice(grid=masses)))
        away = error(found.displacement(points), shell.answer) if found.comparable else None
        errors[masses] = np.inf if away is None else away
    return Row(scene.name, scene.name in OBLIQUE, errors, shell.error)


def table(rows: Iterable[Row]) -> str:
    """Markdown: errors in percent, and orders."""
    rows = list(rows)
    grids = list(rows[0].errors)
    pairs = [*pairwise(grids), (grids[0], grids[-1])]
    heads = ["scene", "rims", *(f"{n} [%]" for n in grids), *(f"order {a}–{b}" for a, b in pairs), "bar [%]"]
    lines = [" | ".join(["", *heads, "missed", ""]).strip(), "|" + " --- |" * (len(heads) + 1)]
    for row in rows:
        cells = [row.scene, "oblique" if row.oblique else "aligned"]
        cells += [f"{100.0 * each:.2f}" for each in row.errors.values()]
        cells += [f"{row.order(*pair):.1f}" for pair in pairs]
        lines.append(" | ".join(["", *cells, f"{100.0 * row.bar:.2f}", row.misses, ""]).strip())
    return "\n".join(lines)
