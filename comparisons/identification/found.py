"""What an identification found: values with their intervals, what is left, and how the search ended."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from comparisons.identification import tables
from comparisons.identification.measurements import Measured
from comparisons.report.report import Report
from sheetbench.scenes import Scene, summary


@dataclass(frozen=True)
class Found:
    """An unknown's value, its 95 % interval, the value the search started from, the unit, and about where a
    lattice with cells half as large would put it (None: not asked)."""

    value: float
    interval: tuple[float, float]
    start: float
    unit: str
    refined: float | None = None


@dataclass(frozen=True, repr=False)
class Identification(summary.Summarised):
    """unknowns: name → Found; residuals [m], model − measured: (n, 3) of displacements, nan where nothing
    was measured, or (n,) along the normals at cloud points; noise: s [m]; relative: the largest residual over
    the largest measurement; converged: whether the search ended at a minimum."""

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

    def as_dict(self) -> dict[str, Any]:
        """The JSON document of `sheetbench identify`: SI units, null where nothing was measured."""
        return {
            "scene": self.scene.name,
            "model": self.model,
            "settings": self.settings,
            "unknowns": {
                name: {
                    "value": u.value,
                    "interval": list(u.interval),
                    "refined": u.refined,
                    "start": u.start,
                    "unit": u.unit,
                }
                for name, u in self.unknowns.items()
            },
            "residuals": self.residuals,
            "points": self.measured.points,
            "noise": self.noise,
            "relative": self.relative,
            "evaluations": self.evaluations,
            "converged": self.converged,
            "warnings": list(self.warnings),
        }

    def _summary(self) -> tuple[str, summary.Facts]:
        found = [
            (name, f"{u.value:.6g} {u.unit}, 95 % within {u.interval[0]:.6g} and {u.interval[1]:.6g}")
            for name, u in self.unknowns.items()
        ]
        fit = f"noise {1e3 * self.noise:.3g} mm, largest residual {100 * self.relative:.2g} %"
        ended = "" if self.converged else "the search did not reach a minimum"
        title = f"Identification of {', '.join(self.unknowns)} on {self.scene.name}; .report() has the table"
        return title, [*found, ("fit", fit), ("search", ended)]

    def report(self, file: str = "") -> Report:
        """What is shown of it; file: where the measurements were read from."""
        return tables.report(self, file)
