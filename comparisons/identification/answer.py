"""The answer of `sheetbench identify`: values with intervals, residuals, and how the search ended."""

from __future__ import annotations

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from comparisons.identification.measurements import Displacements, Measured
from comparisons.identification.residuals import Outlier, Runs
from comparisons.identification.unknowns import Estimate
from comparisons.models.grading import choice_notes
from sheetbench.answers.answer import Answer
from sheetbench.answers.report import RASTER, Picture
from sheetbench.answers.table import MILLIMETRES, NUMBER, SECONDS, Table, quantity, unit
from sheetbench.scenes import Scene

UNKNOWNS = (
    *("unknown", "unit", NUMBER(".6g", "value"), NUMBER(".6g", "from"), NUMBER(".6g", "to")),
    *(NUMBER(".6g", "on finer cells"), NUMBER(".6g", "start")),
)
SHOWN = 20  # residuals on the terminal; all of them are in the files


@dataclass(frozen=True, repr=False)
class Identification(Answer):
    """Values of unknowns of a scene with intervals, and the fit's residuals.

    unknowns: name → Estimate; residuals [m], model − measured: (n, 3) of displacements, nan where nothing was
    measured, or (n,) along the normals at cloud points; noise: s [m]; relative: the largest residual over the
    largest measurement; converged: whether the search ended at a minimum; runs: the runs test of neighbouring
    residuals; explained: whether the residuals are small, or noise; starts: number of starts of the search;
    grids: the lattices that were fitted; outliers: rows that do not fit."""

    file_name = "identification"
    scene: Scene
    measured: Measured
    model: str
    settings: dict[str, Any]
    unknowns: dict[str, Estimate]
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

    @property
    def contains(self) -> str:
        """Sources of error in the intervals, the measurements' noise and the grid or mesh; "" without
        intervals."""
        if all(u.interval is None for u in self.unknowns.values()):
            return ""
        if all(u.interval == u.noise_interval for u in self.unknowns.values()):
            return "noise only"
        return "noise and grid" if self.model == "lumped" else "noise and mesh"

    def document(self) -> dict[str, Any]:
        """Return the JSON document of `sheetbench identify`: SI units, null where nothing was measured."""
        own = {name: value for name, value in vars(self).items() if name != "measured"}
        return own | {
            "scene": self.scene.name,
            "unknowns": {name: asdict(u) for name, u in self.unknowns.items()},
            "points": self.measured.points,
            "deviation": self.measured.deviation,
            "runs": {**asdict(self.runs), "probability": self.runs.probability},
            "outliers": [asdict(one) for one in self.outliers],
        }

    def tables(self) -> tuple[Table, ...]:
        """Return a table of the unknowns and one of the residuals of all points."""
        return self._unknowns(), self._residuals(
            np.arange(len(self.residuals)), "Residuals: model − measurement"
        )

    def printed(self) -> tuple[Table, ...]:
        """Return the tables of unknowns and of residuals, the SHOWN largest at most, in the order of the
        file."""
        if len(self.residuals) <= SHOWN:
            return self.tables()
        size = np.nan_to_num(np.abs(self.residuals)).reshape(len(self.residuals), -1).max(axis=1)
        caption = f"Residuals (model − measurement): the {SHOWN} points of {len(size)} that fit least"
        return self._unknowns(), self._residuals(np.sort(np.argsort(size)[-SHOWN:]), caption)

    def _unknowns(self) -> Table:
        """Return a row per unknown in its unit, empty for an unknown that the data do not determine."""
        rows = [
            (
                name,
                unit(u.unit),
                *((u.value, *(u.interval or [None] * 2), u.refined) if u.determined else [None] * 4),
                u.start,
            )
            for name, u in self.unknowns.items()
        ]
        caption = f"Values and their 95 % intervals, of {self.contains}" if self.contains else "Values"
        return Table.listed(caption, UNKNOWNS, rows, "unknowns")

    def _residuals(self, points: np.ndarray, caption: str) -> Table:
        """Return a row per measured point (and time): its residual by component, or along the normal."""
        flat = isinstance(self.measured, Displacements)
        names = [f"off in u{axis}" for axis in "xyz"] if flat else ["distance"]
        columns, at = [MILLIMETRES("z.2f", axis) for axis in "xyz"], self.measured.points
        columns = columns[: at.shape[1]]
        if self.measured.time is not None:
            columns, at = [SECONDS(".4f", "t"), *columns], np.column_stack([self.measured.time, at])
        off = self.residuals.reshape(len(self.residuals), -1)
        columns += [MILLIMETRES("z.4f", name) for name in names]
        return Table.listed(caption, columns, np.column_stack([at, off])[points].tolist(), "residuals")

    def figures(self) -> tuple[Picture, ...]:
        compose = "comparisons.identification.figure:compose"
        return (Picture("identification", compose, (self,), formats=RASTER),)

    def result(self) -> str:
        """Return the values and their intervals."""
        return "; ".join(f"{name} {_in_words(u)}" for name, u in self.unknowns.items())

    def notes(self) -> tuple[str, ...]:
        return *choice_notes(self.settings), self._explanation()

    def _explanation(self) -> str:
        """Return a sentence with the model, the size of the residuals and the assumptions of the
        intervals."""
        size = "×".join(map(str, self.settings.get("grid") or self.settings["elements"]))
        tried = " → ".join("×".join(map(str, grid)) for grid in self.grids)
        cells = f" (cells chosen by the fit: {tried})" if len(self.grids) > 1 else ""
        model = f"{self.model} {size}{cells}"
        if not self.contains:
            return (
                f"{model}: as many unknowns as measured numbers: there is no interval; measure more points, "
                "or give the standard deviation of a number (--uncertainty)."
            )
        contained = {
            "noise only": "It contains no ",
            "noise and grid": "It contains the grid's error, twice the change on finer cells, and no other ",
            "noise and mesh": "It contains the mesh's error, found on elements twice as large, and no other ",
        }[self.contains]
        noise = "equal variance"
        if self.measured.deviation is not None:
            noise = "the standard deviation given, or of the residuals' where that is larger"
        return (
            f"{model}: residuals have a standard deviation of {1e3 * self.noise:.3g} mm, "
            f"{100 * self.noise / self.measured.scale:.3g} % of the largest measurement, and reach "
            f"{100 * self.relative:.3g} %. The interval assumes independent noise of {noise}. "
            f"{contained}error of the model."
        )

    def complaints(self) -> list[str]:
        ended = f"the search did not end within {self.evaluations} evaluations"
        return [*self.warnings, *([] if self.converged else [ended])]

    def choices(self) -> dict[str, Any]:
        return {**self.settings, "measured": self.measured.source}

    @property
    def succeeded(self) -> bool:
        return self.converged


def _in_words(found: Estimate) -> str:
    """Return an unknown's value with its interval in words."""
    value, *ends = (quantity(one, found.unit, ".4g") for one in (found.value, *(found.interval or ())))
    if not found.determined:
        return "not determined"
    return f"{value} ({' to '.join(ends) or 'no interval'})"
