"""A model's convergence on a scene, with its error bar, and whether two models can be distinguished.

A model answers on three meshes. With f its Richardson limit at the probes and U the bar of its grid
convergence index (`fem_reference.uncertainty`), two models a and b are distinguishable where at some probe

    |f_a − f_b| > |U_a| + |U_b|

and more than `DIGITS` of the largest displacement, which is what programs print and where iterations end.
Models that are not distinguishable may be equal or not: finer meshes would decide.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated, Any

import numpy as np

from fem_reference.edge_layer import missed_by
from fem_reference.uncertainty import ASSUMED_ORDER, OWN_ORDER, Uncertainty, estimate
from sheetbench.answers.table import PERCENT, Column
from sheetbench.scenes import Scene, Status, comparable

DIGITS = 1e-5  # of the largest displacement


@dataclass(frozen=True)
class Convergence:
    """A model on its meshes, coarsest first: `rows` as `comparisons.crosscheck.crosscheck.answer` has them,
    with a status and a message where there is no more. uncertainty: of the finest answers, None below two of
    them."""

    scene: str
    name: str
    version: str | None
    rows: tuple[dict[str, Any], ...]
    uncertainty: Uncertainty | None

    @classmethod
    def of(
        cls, scene: Scene, name: str, version: str | None, rows: Sequence[dict[str, Any]], layered: bool
    ) -> Convergence:
        """Return the convergence of a model's rows; layered: its elements are quadratic and have the layer of
        `fem_reference.edge_layer`; of others an order of 2 at most counts."""
        usable = sorted((row for row in rows if _answered(row)), key=lambda row: float(row["size"]))
        bar = None
        if len(usable) >= 2:
            sizes = [float(row["size"]) for row in usable[:3]]
            displacements = [np.array([*row["probes"].values()], dtype=float) for row in usable[:3]]
            layers = [missed_by(scene, row["settings"]) for row in usable[:3]] if layered else ()
            bar = estimate(displacements, sizes, layers, OWN_ORDER if layered else ASSUMED_ORDER)
        return cls(scene.name, name, version, tuple(rows), bar)

    @property
    def finest(self) -> dict[str, Any]:
        """The row of the finest mesh that has an answer, else the last."""
        usable = [row for row in self.rows if _answered(row)]
        return min(usable, key=lambda row: float(row["size"])) if usable else self.rows[-1]

    @property
    def refused(self) -> bool:
        """Whether the model does not take the scene."""
        return all(row["status"] == Status.REFUSED for row in self.rows)

    @property
    def failures(self) -> list[str]:
        """What went wrong on a mesh, a clause each; refusals are no failures."""
        return [_said(row) for row in self.rows if not _answered(row) and row["status"] != Status.REFUSED]

    @property
    def unsound(self) -> list[str]:
        """The answers that are compared and no stable, physical equilibria, a clause each."""
        return [_said(row) for row in self.rows if _answered(row) and row["status"] != Status.CONVERGED]

    @property
    def meshes(self) -> str:
        """The meshes that have an answer, in words."""
        counts = [
            row["settings"].get("elements") or row["settings"]["grid"] for row in self.rows if _answered(row)
        ]
        return ", ".join(str(min(count[:2])) for count in counts)


def _answered(row: dict[str, Any]) -> bool:
    return "probes" in row and comparable(row["status"], row["load_factor"])


def _said(row: dict[str, Any]) -> str:
    return ": ".join(filter(None, [row["label"], row["status"], row["message"]]))


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

    def document(self) -> dict[str, Any]:
        """For JSON."""
        return {"apart" if key == "distinguishable_at" else key: value for key, value in vars(self).items()}


def pair(a: Convergence, b: Convergence, probes: Sequence[str]) -> Pair | None:
    """Two models of a scene beside each other, where both have bars."""
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
    names = tuple(name for name, differs in zip(probes, differ, strict=True) if differs)
    return Pair(a.scene, a.name, b.name, float(np.abs(off[at])) / size, float(bars) / size, names)
