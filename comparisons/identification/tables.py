"""The tables of `sheetbench identify`: the unknowns with their intervals, and what does not fit, by point."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from comparisons.identification.measurements import Displacements
from comparisons.models.grading import told
from sheetbench.answers.report import RASTER, Picture, Report
from sheetbench.answers.table import Column, Table, unit

if TYPE_CHECKING:
    from comparisons.identification.found import Identification

SHOWN = 20  # residuals on the terminal; all of them are in the files

_X, _Y, _Z = (Column(name, "m", "mm", 1e3, "z.2f") for name in "xyz")
_PARTS = tuple(Column(f"off in {part}", "m", "mm", 1e3, "z.4f") for part in ("ux", "uy", "uz"))


def report(found: Identification, file: str) -> Report:
    """What `sheetbench identify` shows of what was found from a file."""
    unended = [] if found.converged else [f"the search did not end within {found.evaluations} evaluations"]
    return Report(
        name="identification",
        title=found.scene.name,
        subtitle=found.scene.title,
        document=found.as_dict(),
        tables=(unknowns(found), residuals(found)),
        printed=(unknowns(found), worst(found)),
        notes=(*told(found.settings), explanation(found)),
        complaints=(*found.warnings, *unended),
        pictures=(
            Picture("identification", "comparisons.identification.figure:compose", (found,), formats=RASTER),
        ),
        settings={**found.settings, "measured": file},
        met=found.converged,
    )


def unknowns(found: Identification) -> Table:
    """A row per unknown; values in the unit of the row, none of what the data do not determine."""
    rows = tuple(
        (name, unit(u.unit), *((u.value, *u.interval, u.refined) if u.determined else [None] * 4), u.start)
        for name, u in found.unknowns.items()
    )
    names = ("value", "from", "to", "on finer cells", "started at")
    shown = tuple(Column(name, form=".6g") for name in names)
    columns = (Column("unknown"), Column("unit"), *shown)
    return Table(f"Values and their 95 % intervals, of {found.contains}", columns, rows, "unknowns")


def residuals(found: Identification) -> Table:
    """A row per measured point: model − measurement, or distance of the point from the surface."""
    return _residuals(found, np.arange(len(found.residuals)), "Residuals: model − measurement")


def worst(found: Identification) -> Table:
    """The rows of `residuals` that fit least, at most SHOWN of them, in the order of the file."""
    if len(found.residuals) <= SHOWN:
        return residuals(found)
    size = np.nan_to_num(np.abs(found.residuals)).reshape(len(found.residuals), -1).max(axis=1)
    rows = np.sort(np.argsort(size)[-SHOWN:])
    return _residuals(
        found, rows, f"Residuals (model − measurement): the {SHOWN} points of {len(size)} that fit least"
    )


def _residuals(found: Identification, rows: np.ndarray, caption: str) -> Table:
    points = found.measured.points
    if isinstance(found.measured, Displacements):
        time = found.measured.time
        timed = () if time is None else (Column("t", "s", "s", 1.0, ".4f"),)
        of = [
            (
                *(() if time is None else (float(time[i]),)),
                *map(float, points[i]),
                *map(float, found.residuals[i]),
            )
            for i in rows
        ]
        return Table(caption, (*timed, _X, _Y, *_PARTS), tuple(of), "residuals")
    columns = (_X, _Y, _Z, Column("distance", "m", "mm", 1e3, "z.4f"))
    of_cloud = tuple((*map(float, points[i]), float(found.residuals[i])) for i in rows)
    return Table(caption, columns, of_cloud, "residuals")


def explanation(found: Identification) -> str:
    """What was fitted with what, how well, and what the interval assumes."""
    size = "×".join(map(str, found.settings.get("grid") or found.settings["elements"]))
    tried = " → ".join("×".join(map(str, grid)) for grid in found.grids)
    cells = f" (cells chosen by the fit: {tried})" if len(found.grids) > 1 else ""
    contained = {
        "noise only": "",
        "noise and grid": "contains the grid's error, twice the step to finer cells, and ",
        "noise and mesh": "contains the mesh's error, by a look at elements twice as large, and ",
    }[found.contains]
    return (
        f"{found.model} {size}{cells}: residuals have a standard deviation of {1e3 * found.noise:.3g} mm, "
        f"{100 * found.noise / found.measured.scale:.3g} % of the largest measurement, and reach "
        f"{100 * found.relative:.3g} %. The interval assumes independent noise of equal variance and "
        f"{contained}leaves out other model error."
    )
