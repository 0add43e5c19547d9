"""The answer of `sheetbench identify`: values with intervals, residuals, and how the search ended."""

from dataclasses import asdict, dataclass
from typing import Annotated, Any

import numpy as np

from comparisons.identification.measurements import Displacements, Measured
from comparisons.identification.residuals import Outlier, Runs
from comparisons.identification.unknowns import Estimate
from comparisons.models.grading import choice_notes
from sheetbench.answers.answer import Answer
from sheetbench.answers.report import RASTER, Picture
from sheetbench.answers.table import MILLIMETRES, NUMBER, SECONDS, Table, TableUnit, quantity, unit
from sheetbench.scenes import Scene

SHOWN = 20  # residuals on the terminal; all of them are in the files


@dataclass(frozen=True)
class UnknownRow:
    """An unknown's value and interval, value on finer cells and start; undetermined values are None."""

    unknown: str
    unit: TableUnit
    value: Annotated[float | None, NUMBER(".6g")]
    low: Annotated[float | None, NUMBER(".6g", "from")]
    high: Annotated[float | None, NUMBER(".6g", "to")]
    refined: Annotated[float | None, NUMBER(".6g", "on finer cells")]
    start: Annotated[float, NUMBER(".6g")]


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
        """Sources of error in the intervals: noise, and the grid or mesh; "" without intervals."""
        if all(u.interval is None for u in self.unknowns.values()):
            return ""
        if all(u.interval == u.noise_interval for u in self.unknowns.values()):
            return "noise only"
        return "noise and grid" if self.model == "lumped" else "noise and mesh"

    def document(self) -> dict[str, Any]:
        """Return the JSON document of `sheetbench identify`: SI units, null where nothing was measured."""
        fields = {name: value for name, value in vars(self).items() if name != "measured"}
        return fields | {
            "scene": self.scene.name,
            "unknowns": {name: asdict(u) for name, u in self.unknowns.items()},
            "points": self.measured.points,
            "deviation": self.measured.deviation,
            "runs": {**asdict(self.runs), "probability": self.runs.probability},
            "outliers": [asdict(one) for one in self.outliers],
        }

    def tables(self) -> tuple[Table, ...]:
        """Return a table of the unknowns and one of the residuals of all points."""
        return self._list_unknowns(), self._list_residuals(
            np.arange(len(self.residuals)), "Residuals: model − measurement"
        )

    def printed(self) -> tuple[Table, ...]:
        """Return the tables of unknowns and of the SHOWN largest residuals, in the order of the file."""
        if len(self.residuals) <= SHOWN:
            return self.tables()
        size = np.nan_to_num(np.abs(self.residuals)).reshape(len(self.residuals), -1).max(axis=1)
        caption = f"Residuals (model − measurement): the {SHOWN} points of {len(size)} that fit least"
        return self._list_unknowns(), self._list_residuals(np.sort(np.argsort(size)[-SHOWN:]), caption)

    def _list_unknowns(self) -> Table:
        """Return a row per unknown in its unit, empty for an unknown that the data do not determine."""
        rows = []
        for name, u in self.unknowns.items():
            ends = u.interval or (None, None)
            values: Any = (u.value, *ends, u.refined) if u.determined else [None] * 4
            rows.append(UnknownRow(*(name, unit(u.unit), *values, u.start)))
        caption = f"Values and their 95 % intervals, of {self.contains}" if self.contains else "Values"
        return Table.of(UnknownRow, rows, caption, "unknowns")

    def _list_residuals(self, rows: np.ndarray, caption: str) -> Table:
        """Return a row per measured point (and time): its residual by component, or along the normal."""
        by_component = isinstance(self.measured, Displacements)
        names = [f"off in u{axis}" for axis in "xyz"] if by_component else ["distance"]
        columns, places = [MILLIMETRES("z.2f", axis) for axis in "xyz"], self.measured.points
        columns = columns[: places.shape[1]]
        if self.measured.time is not None:
            columns, places = [SECONDS(".4f", "t"), *columns], np.column_stack([self.measured.time, places])
        values = self.residuals.reshape(len(self.residuals), -1)
        columns += [MILLIMETRES("z.4f", name) for name in names]
        return Table.listed(caption, columns, np.column_stack([places, values])[rows].tolist(), "residuals")

    def figures(self) -> tuple[Picture, ...]:
        compose = "comparisons.identification.figure:compose"
        return (Picture("identification", compose, (self,), formats=RASTER),)

    def result(self) -> str:
        """Return the values and their intervals."""
        return "; ".join(f"{name} {_format_estimate(u)}" for name, u in self.unknowns.items())

    def notes(self) -> tuple[str, ...]:
        return *choice_notes(self.settings), self._explain_fit()

    def _explain_fit(self) -> str:
        """Return a sentence on the model, its residuals and the assumptions of the intervals."""
        counts = "×".join(map(str, self.settings.get("grid") or self.settings["elements"]))
        model = f"{self.model} {counts}"
        if len(self.grids) > 1:
            coarse, fine = ("×".join(map(str, grid[:2])) for grid in (self.grids[0], self.grids[-1]))
            model += f" (the fit refined the lattice from {coarse} to {fine} masses)"
        if not self.contains:
            numbers = "one measured number fixes" if len(self.unknowns) == 1 else "the measured numbers fix"
            return (
                f"{model}: {numbers} {', '.join(self.unknowns)} but no interval: measure more "
                "points, or give their accuracy with --uncertainty."
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


def _format_estimate(u: Estimate) -> str:
    """Return an unknown's value with its interval in words."""
    value, *ends = (quantity(end, u.unit, ".4g") for end in (u.value, *(u.interval or ())))
    if not u.determined:
        return "not determined"
    return f"{value} ({' to '.join(ends) or 'no interval'})"
