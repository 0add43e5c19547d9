"""A model's converged limit on a scene with its error bar, and pairs of models that can be distinguished.

Let f be the Richardson limit at the probes of a model's answers on its own meshes, and U the error bar by the
grid convergence index (`fem_reference.uncertainty`). Two models a and b are distinguishable if at some probe

    |f_a − f_b| > |U_a| + |U_b|

and the difference exceeds `DIGITS` of the largest displacement, the precision of printed results and of
iterations. Models that are not distinguishable may be equal or not: finer meshes would decide.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations
from operator import attrgetter
from typing import TYPE_CHECKING, Annotated

import numpy as np

from comparisons.sweep.solved import Solved
from sheetbench.answers.solution import Status
from sheetbench.answers.table import PERCENT, Column
from sheetbench.scenes import Scene

if TYPE_CHECKING:
    from fem_reference.uncertainty import Uncertainty

DIGITS = 1e-5  # of the largest displacement


def limit(rows: Iterable[Solved], size: Callable[[Solved], float] | None = None) -> Uncertainty | None:
    """Return limit and error bar of a model's two or three finest answers, None for fewer.

    size: step of a row, the cell size by default. The error of quadratic elements in the layer along edges is
    included at rest and ignored in motion; the order of motions, of steps and of other elements is at most 2.
    """
    from fem_reference.edge_layer import unresolved
    from fem_reference.uncertainty import FITTED, estimate, largest_order

    measure = size or attrgetter("size")
    usable = sorted((row for row in rows if row.usable), key=measure)[:3]
    sizes = [*map(measure, usable)]
    if len(set(sizes)) < 2:
        return None
    request, layers, largest = usable[0].request, [], FITTED
    if request.layered and size is None:
        largest = largest_order(request.scene)
        if request.duration is None:
            layers = [unresolved(row.request.scene, row.row["settings"]) for row in usable]
        else:
            largest = min(largest, FITTED)  # a change of period makes signs of changes alternate
    return estimate([row.u for row in usable], sizes, layers, largest)


def motion_bar(meshes: Sequence[Solved], longer: Solved) -> dict[str, float | None]:
    """Return the error bars by "mesh" and "step" of a motion, fractions of its largest displacement, None for
    failed runs.

    meshes: runs, the finest mesh first; longer: the finest mesh with steps twice as long, of second order.
    """
    limits = {
        "mesh": limit(meshes),
        "step": limit([meshes[0], longer], size=lambda row: 1.0 + (row is longer)),
    }
    usable = meshes[0].usable
    return {name: bar.error if usable and bar is not None else None for name, bar in limits.items()}


def total_bar(bars: Mapping[str, float | None]) -> float | None:
    """Return the sum of a bar's parts, None if one of them is unknown."""
    known = [bar for bar in bars.values() if bar is not None]
    return sum(known) if bars and len(known) == len(bars) else None


@dataclass(frozen=True)
class Limit:
    """A model's rows on its meshes of a scene, coarsest first, and the error bar of the finest answers."""

    scene: Scene
    name: str
    rows: tuple[Solved, ...]
    uncertainty: Uncertainty | None

    @classmethod
    def of(cls, name: str, rows: Sequence[Solved]) -> Limit:
        """Return the limit of a model's rows on one scene."""
        return cls(rows[0].request.scene, name, tuple(rows), limit(rows))

    @property
    def finest(self) -> Solved:
        """The row of the finest mesh with an answer, by default the last row."""
        return min((row for row in self.rows if row.usable), key=lambda row: row.size, default=self.rows[-1])

    @property
    def refused(self) -> bool:
        """Whether the model refuses the scene."""
        return all(row.status == Status.REFUSED for row in self.rows)

    @property
    def failures(self) -> list[str]:
        """One clause per failed mesh; refusals are not failures."""
        return [row.ending for row in self.rows if not row.usable and row.status != Status.REFUSED]

    @property
    def unsound(self) -> list[str]:
        """One clause per compared answer that is not a stable, physical equilibrium."""
        return [row.ending for row in self.rows if row.usable and not row.stable]

    @property
    def meshes(self) -> str:
        """Masses or elements along the shorter side of the meshes with an answer, as text."""
        counts = (min(row.counts) + row.request.spec.IS_LATTICE for row in self.rows if row.usable)
        return ", ".join(map(str, counts))


@dataclass(frozen=True)
class Pair:
    """Difference of models a and b on a scene: its largest component over a's largest displacement; bars: sum
    of both error bars of this component, relative too; distinguishable_at: probes that differ by more."""

    scene: str
    a: Annotated[str, Column("model")]
    b: Annotated[str, Column("and")]
    difference: Annotated[float, PERCENT("z.3f", "differ by")]
    bars: Annotated[float, PERCENT(".2g")]
    distinguishable_at: Annotated[tuple[str, ...], Column("distinguishable at", none="nowhere")]


def pairs(limits: Iterable[Limit]) -> list[Pair]:
    """Return the pairs of a scene's models that both have error bars."""
    return [p for a, b in combinations(limits, 2) if (p := pair(a, b)) is not None]


def pair(a: Limit, b: Limit) -> Pair | None:
    """Return the difference of two models of a scene, None without bars or displacement."""
    if a.uncertainty is None or b.uncertainty is None:
        return None
    size = float(np.max(np.abs(a.uncertainty.extrapolated)))
    if not size > 0.0:
        return None
    difference = b.uncertainty.extrapolated - a.uncertainty.extrapolated
    total = np.linalg.norm(a.uncertainty.bar, axis=1) + np.linalg.norm(b.uncertainty.bar, axis=1)
    differ = np.linalg.norm(difference, axis=1) > np.maximum(total, DIGITS * size)
    at = np.unravel_index(np.argmax(np.abs(difference)), difference.shape)
    bars = float(a.uncertainty.bar[at] + b.uncertainty.bar[at]) / size
    names = tuple(name for name, differs in zip(a.scene.probes, differ, strict=True) if differs)
    return Pair(a.scene.name, a.name, b.name, float(np.abs(difference[at])) / size, bars, names)
