"""A model's limit on a scene with its error bar, and whether two models can be distinguished.

With f the Richardson limit at the probes of a model's answers on meshes of its own and U the bar of its grid
convergence index (`fem_reference.uncertainty`), two models a and b are distinguishable where at some probe

    |f_a − f_b| > |U_a| + |U_b|

and more than `DIGITS` of the largest displacement, which is what programs print and where iterations end.
Models that are not distinguishable may be equal or not: finer meshes would decide.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations
from typing import TYPE_CHECKING, Annotated

import numpy as np

from comparisons.sweep.solved import Solved
from sheetbench.answers.solution import Status
from sheetbench.answers.table import PERCENT, Column
from sheetbench.scenes import Scene

if TYPE_CHECKING:
    from fem_reference.uncertainty import Uncertainty

DIGITS = 1e-5  # of the largest displacement


def limit(
    rows: Iterable[Solved], size: Callable[[Solved], float] = lambda row: row.size
) -> Uncertainty | None:
    """Return limit and bar of a model's finest answers, three of them if there are, None below two.

    size: of a row's cells, or of its steps. Quadratic elements miss some of the layer along edges; of others
    an order of 2 at most counts; in motion the layer counts for nothing.
    """
    from fem_reference.edge_layer import missed_by
    from fem_reference.uncertainty import SECOND_ORDER, estimate, family_of

    usable = sorted((row for row in rows if row.usable), key=size)[:3]
    sizes = [*map(size, usable)]
    if len(set(sizes)) < 2:
        return None
    ask, layers = usable[0].ask, []
    if ask.layered and ask.duration is None:
        layers = [missed_by(row.ask.scene, row.row["settings"]) for row in usable]
    family = family_of(ask.scene) if ask.layered else SECOND_ORDER
    return estimate([row.u for row in usable], sizes, layers, family)


def motion_bar(meshes: Sequence[Solved], longer: Solved) -> dict[str, float | None]:
    """Return what "mesh" and "step" leave uncertain of a motion, shares of its largest displacement, None
    where runs did not end; meshes: the finest first; longer: its run in steps twice as long, which are of
    second order."""
    by = {"mesh": limit(meshes), "step": limit([meshes[0], longer], size=lambda row: 1.0 + (row is longer))}
    known = meshes[0].usable
    return {name: found.error if known and found is not None else None for name, found in by.items()}


def in_all(bars: Mapping[str, float | None]) -> float | None:
    """Return the parts of a bar together, None where one of them is not known."""
    known = [bar for bar in bars.values() if bar is not None]
    return sum(known) if bars and len(known) == len(bars) else None


@dataclass(frozen=True)
class Limit:
    """A model of a scene on its meshes, coarsest first, and the bar of its finest answers."""

    scene: Scene
    name: str
    rows: tuple[Solved, ...]
    uncertainty: Uncertainty | None

    @classmethod
    def of(cls, name: str, rows: Sequence[Solved]) -> Limit:
        """Return the limit of a model's rows on one scene."""
        return cls(rows[0].ask.scene, name, tuple(rows), limit(rows))

    @property
    def finest(self) -> Solved:
        """The row of the finest mesh that has an answer, else the last."""
        return min((row for row in self.rows if row.usable), key=lambda row: row.size, default=self.rows[-1])

    @property
    def refused(self) -> bool:
        """Whether the model does not take the scene."""
        return all(row.status == Status.REFUSED for row in self.rows)

    @property
    def failures(self) -> list[str]:
        """What went wrong on a mesh, a clause each; refusals are no failures."""
        return [row.ending for row in self.rows if not row.usable and row.status != Status.REFUSED]

    @property
    def unsound(self) -> list[str]:
        """The answers that are compared and no stable, physical equilibria, a clause each."""
        return [row.ending for row in self.rows if row.usable and not row.stable]

    @property
    def meshes(self) -> str:
        """The meshes that have an answer, in words: masses or elements along the shorter side."""
        along = (min(row.counts) + row.ask.spec.MASSES for row in self.rows if row.usable)
        return ", ".join(map(str, along))


@dataclass(frozen=True)
class Pair:
    """How far b is from a on a scene: the largest component of their difference, as a fraction of a's largest
    displacement; bars: both bars of that component, likewise; distinguishable_at: where
    they differ by more."""

    scene: str
    a: Annotated[str, Column("model")]
    b: Annotated[str, Column("and")]
    difference: Annotated[float, PERCENT("z.3f", "differ by")]
    bars: Annotated[float, PERCENT(".2g")]
    distinguishable_at: Annotated[tuple[str, ...], Column("distinguishable at", none="nowhere")]


def pairs(limits: Iterable[Limit]) -> list[Pair]:
    """Return every two models of a scene that have bars, beside each other."""
    found = [pair(a, b) for a, b in combinations(limits, 2)]
    return [one for one in found if one is not None]


def pair(a: Limit, b: Limit) -> Pair | None:
    """Return two models of a scene beside each other, None where one has no bar or nothing moves."""
    if a.uncertainty is None or b.uncertainty is None:
        return None
    size = float(np.max(np.abs(a.uncertainty.extrapolated)))
    if not size > 0.0:
        return None
    off = b.uncertainty.extrapolated - a.uncertainty.extrapolated
    both = [np.linalg.norm(of.bar, axis=1) for of in (a.uncertainty, b.uncertainty)]
    differ = np.linalg.norm(off, axis=1) > np.maximum(both[0] + both[1], DIGITS * size)
    at = np.unravel_index(np.argmax(np.abs(off)), off.shape)
    bars = a.uncertainty.bar[at] + b.uncertainty.bar[at]
    names = tuple(name for name, differs in zip(a.scene.probes, differ, strict=True) if differs)
    return Pair(a.scene.name, a.name, b.name, float(np.abs(off[at])) / size, float(bars) / size, names)
