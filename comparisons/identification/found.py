"""What an identification found: values with their intervals, what is left, and how the search ended."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from textwrap import wrap
from typing import Any

import numpy as np

from comparisons.identification import tables
from comparisons.identification.measurements import Measured
from comparisons.identification.outliers import Outlier
from comparisons.identification.residual_test import Runs
from sheetbench.answers.report import Report
from sheetbench.answers.table import quantity
from sheetbench.scenes import Scene, summary
from sheetbench.scenes.summary import few


@dataclass(frozen=True)
class Found:
    """An unknown's value, its 95 % interval, the value the search started from and the unit.

    refined: about where a lattice with cells half as large would put it, None where that is not known;
    noise_interval: that of the measurements' noise alone, without the error of the grid or mesh;
    determined: whether the data see it by itself.
    """

    value: float
    interval: tuple[float, float]
    start: float
    unit: str
    refined: float | None
    noise_interval: tuple[float, float]
    determined: bool


@dataclass(frozen=True, repr=False)
class Identification(summary.Summarised):
    """unknowns: name → Found; residuals [m], model − measured: (n, 3) of displacements, nan where nothing
    was measured, or (n,) along the normals at cloud points; noise: s [m]; relative: the largest residual over
    the largest measurement; converged: whether the search ended at a minimum; runs: whether neighbouring
    residuals have one sign; explained: whether what is left is small, or noise; starts: of the search; grids:
    the lattices that were fitted; outliers: rows that do not fit, and the unknowns without them."""

    scene: Scene
    measured: Measured
    model: str
    settings: dict[str, Any]
    unknowns: dict[str, Found]
    residuals: np.ndarray
    noise: float
    relative: float
    evaluations: int
    converged: bool
    warnings: tuple[str, ...]
    runs: Runs
    explained: bool
    starts: int
    grids: tuple[tuple[int, ...], ...]
    outliers: tuple[Outlier, ...]
    without: dict[str, Found]

    @property
    def contains(self) -> str:
        """What the intervals know of: the measurements' noise, and the error of the grid or mesh."""
        if all(u.interval == u.noise_interval for u in self.unknowns.values()):
            return "noise only"
        return "noise and grid" if self.model == "lumped" else "noise and mesh"

    def as_dict(self) -> dict[str, Any]:
        """The JSON document of `sheetbench identify`: SI units, null where nothing was measured."""
        return {
            "scene": self.scene.name,
            "model": self.model,
            "settings": self.settings,
            "unknowns": {name: asdict(u) for name, u in self.unknowns.items()},
            "residuals": self.residuals,
            "points": self.measured.points,
            "noise": self.noise,
            "relative": self.relative,
            "evaluations": self.evaluations,
            "converged": self.converged,
            "explained": self.explained,
            "runs": {**asdict(self.runs), "probability": self.runs.probability},
            "starts": self.starts,
            "grids": [list(grid) for grid in self.grids],
            "outliers": [asdict(one) for one in self.outliers],
            "without_outliers": {name: asdict(u) for name, u in self.without.items()},
            "warnings": list(self.warnings),
        }

    def _summary(self) -> tuple[str, summary.Facts]:
        found = [
            (
                name,
                f"{quantity(u.value, u.unit, '.6g')}, 95 % within {quantity(u.interval[0], u.unit)} and "
                f"{quantity(u.interval[1], u.unit)} ({self.contains})"
                if u.determined
                else "not determined by these data",
            )
            for name, u in self.unknowns.items()
        ]
        cells = [("cells", "×".join(map(str, self.grids[-1])) + " masses")] if self.grids else []
        share = few(100 * self.relative)
        fit = f"residuals {1e3 * self.noise:.3g} mm, the largest {share} % of what moved most"
        ended = "" if self.converged else "the search did not reach a minimum"
        lines = (wrap(one, summary.WIDEST) for one in self.warnings)
        said = [("" if i else "warning", line) for broken in lines for i, line in enumerate(broken)]
        title = f"Identification of {', '.join(self.unknowns)} on {self.scene.name}; .report() has the table"
        return title, [*found, *cells, ("fit", fit), ("search", ended), *said]

    def report(self, file: str = "") -> Report:
        """What is shown of it; file: where the measurements were read from."""
        return tables.report(self, file)
