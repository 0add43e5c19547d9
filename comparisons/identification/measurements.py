"""Measurements of a deformed sheet: displacements of marked points, or the shape of its surface.

CSV (`comparisons.identification.columns`), in metres and in the scene's axes, with the columns

    x,y,ux,uy,uz    plan point on the flat sheet, then its displacement; a component may be left empty
    x,y,uz          plan point on the flat sheet, then its deflection
    x,y,z           points of the deformed surface, a height map or a scan

A further column sd is the standard deviation of the numbers of each row. A column probe with names of probes
of the scene may replace x,y. Displacements with a further column time [s] are samples of a motion from rest.
Other columns are ignored.

VTP or PLY: points (x, y, z) [m] of the deformed surface, in the scene's axes. Their material points need not
be known.

C3D: markers of a motion capture that have the names of probes, in the scene's axes; displacements are from
the first frame, which is the sheet at rest at time 0.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import ClassVar, Self

import numpy as np

from comparisons.identification.columns import Columns, Row, read_columns
from comparisons.identification.point_files import read_markers, read_points
from sheetbench.errors import BadInput, foreign
from sheetbench.scenes import Scene, Sheet

PLACE = ("x", "y")
MOVED = ("ux", "uy", "uz")
CLOUDS = (".vtp", ".ply")
FARTHEST = 2.0  # a displacement of so many sides is a wrong unit
STILL = 0.1  # of the largest displacement: what may move at time 0, as noise


@dataclass(frozen=True)
class Displacements:
    """Measured displacements of a sheet, a row each.

    Parameters
    ----------
    points : ndarray, (n, 2) [m]
        Plan points of the flat sheet.
    displacement : ndarray, (n, 3) [m]
        Displacements, nan for components that were not measured.
    time : ndarray, (n,) [s], optional
        Time of each row, None for an equilibrium.
    source : str, optional
        Origin of the numbers, named in refusals.
    lines : tuple of str, optional
        Lines of the file by row.
    deviation : ndarray, (n,) [m], optional
        Standard deviation of each row's numbers, None if unknown.
    """

    points: np.ndarray
    displacement: np.ndarray
    time: np.ndarray | None = None
    source: str = "measured"
    lines: tuple[str, ...] = ()
    deviation: np.ndarray | None = None

    @property
    def measured(self) -> np.ndarray:
        """Whether each component was measured, (n, 3)."""
        return np.isfinite(self.displacement)

    @property
    def scale(self) -> float:
        """The largest measured component [m]."""
        return float(np.nanmax(np.abs(self.displacement)))

    def without(self, rows: Sequence[int]) -> Self:
        """Return the measurements with nothing measured in some rows."""
        displacement = self.displacement.copy()
        displacement[list(rows)] = np.nan
        return replace(self, displacement=displacement)

    def until(self, end: float) -> Self:
        """Return the rows of a motion up to a time [s]."""
        assert self.time is not None
        rows = np.flatnonzero(self.time <= end)
        return replace(
            self,
            points=self.points[rows],
            displacement=self.displacement[rows],
            time=self.time[rows],
            lines=tuple(self.lines[i] for i in rows) if self.lines else (),
            deviation=None if self.deviation is None else self.deviation[rows],
        )

    def name_of(self, row: int) -> str:
        """Return a row's name in a sentence: its line in the file, else its number."""
        return self.lines[row] if self.lines else f"row {row}, counted from 0,"


@dataclass(frozen=True)
class Surface:
    """Points of the deformed surface (n, 3) [m]; source, deviation: as of `Displacements`."""

    points: np.ndarray
    source: str = "measured"
    deviation: np.ndarray | None = None
    time: ClassVar[None] = None  # a cloud is of an equilibrium

    @property
    def scale(self) -> float:
        """The largest height over or under the flat sheet [m]."""
        return float(np.abs(self.points[:, 2]).max())


Measured = Displacements | Surface


def weights(measured: Measured) -> np.ndarray:
    """Return the weights (n,) of rows: in inverse proportion to their standard deviations, with a mean square
    of 1."""
    if measured.deviation is None:
        return np.ones(len(measured.points))
    return typical_deviation(measured) / measured.deviation


def typical_deviation(measured: Measured) -> float:
    """Return the standard deviation [m] of a number of weight 1, 0 where it is not known."""
    return 0.0 if measured.deviation is None else float(np.mean(measured.deviation**-2.0) ** -0.5)


def read(path: Path, scene: Scene) -> Measured:
    """Return the measurements of a file. Raises BadInput naming the file and the fault."""
    kind = path.suffix.lower()
    if kind == ".c3d":
        measured: Measured = _read_marker_file(path, scene)
    else:
        measured = _read_cloud(path, scene.sheet) if kind in CLOUDS else _read_table(path, scene)
    if measured.scale == 0.0:
        raise BadInput(f"{path}: nothing moved: every displacement is 0")
    return measured


def _read_marker_file(path: Path, scene: Scene) -> Displacements:
    """Return rows of the markers that have names of probes, frame by frame."""
    markers = read_markers(path)
    probes = {_fold_label(name): point for name, point in scene.probes.items()}
    matches = [(i, probes[key]) for i, key in enumerate(map(_fold_label, markers.labels)) if key in probes]
    if not matches:
        raise BadInput(
            f"{path}: markers {', '.join(markers.labels)}; none has the name of a probe of scene "
            f"'{scene.name}': {', '.join(scene.probes)}"
        )
    moved = np.concatenate([markers.position[i] - markers.position[i, 0] for i, _ in matches])
    points = np.repeat([point for _, point in matches], len(markers.time), axis=0)
    _require_metres(moved, scene.sheet, [str(path)] * len(moved))
    return Displacements(points, moved, np.tile(markers.time, len(matches)), str(path))


def _fold_label(label: str) -> str:
    return "".join(label.lower().split())


def _read_table(path: Path, scene: Scene) -> Measured:
    columns = read_columns(path)
    components = [name for name in MOVED if name in columns.names]
    if "z" in columns.names and not components and set(PLACE) <= set(columns.names):
        return _read_heights(path, columns, scene.sheet)
    by_name = "probe" in columns.names and not set(PLACE) & set(columns.names)
    required = (*(() if by_name else PLACE), *(MOVED if components != ["uz"] else ()))
    missing = [name for name in required if name not in columns.names]
    if missing:
        raise BadInput(
            f"{path}: column {', '.join(missing)} missing; the header is {','.join(PLACE + MOVED)}, x,y,uz, "
            "or x,y,z of points of the deformed surface (metres)"
        )
    rows, lines = columns.rows, tuple(row.where for row in columns.rows)
    points = [_find_probe(row, scene) if by_name else [row.number(name) for name in PLACE] for row in rows]
    values = [[row.measured(name) if name in columns.names else np.nan for name in MOVED] for row in rows]
    displacement = np.array(values, dtype=float).reshape(-1, 3)
    time = columns.numbers("time") if "time" in columns.names else None
    if not np.isfinite(displacement).any():
        raise BadInput(f"{path}: no displacement in it")
    _require_metres(displacement, scene.sheet, lines)
    if time is not None:
        require_flat_start(path, time, displacement)
    return Displacements(np.array(points), displacement, time, str(path), lines, _read_deviation(columns))


def _read_heights(path: Path, columns: Columns, sheet: Sheet) -> Surface:
    """Return the points of the surface with a measured z."""
    if "time" in columns.names:
        raise BadInput(f"{path}: column time: a motion is measured as ux,uy,uz of marked points")
    rows = [[row.number("x"), row.number("y"), row.measured("z")] for row in columns.rows]
    points, deviation = np.array(rows, dtype=float).reshape(-1, 3), _read_deviation(columns)
    measured = np.isfinite(points[:, 2])
    surface = _make_surface(path, points[measured], sheet)
    return surface if deviation is None else replace(surface, deviation=deviation[measured])


def _read_deviation(columns: Columns) -> np.ndarray | None:
    """Return the column sd (n,) [m], None where there is none. Raises BadInput unless all are above 0."""
    if "sd" not in columns.names:
        return None
    deviation = columns.numbers("sd")
    if not (deviation > 0.0).all():
        raise columns.rows[int(np.argmin(deviation > 0.0))].refused("sd", "must be greater than 0")
    return deviation


def _find_probe(row: Row, scene: Scene) -> list[float]:
    if row.cells["probe"] not in scene.probes:
        raise row.refused("probe", f"scene '{scene.name}' has {', '.join(scene.probes)}")
    return list(scene.probes[row.cells["probe"]])


def require_flat_start(path: Path, time: np.ndarray, displacement: np.ndarray) -> None:
    """Raise BadInput where a motion does not begin at time 0, or a sample there is moved by more than noise.

    time: (n,) [s]; displacement: (n, 3) [m], nan where not measured."""
    if time.min() < 0.0 or time.max() == 0.0:
        raise BadInput(f"{path}: time: the motion starts at 0 and goes on to later times")
    filled = np.nan_to_num(displacement)
    allowed = STILL * float(np.abs(filled).max(initial=0.0))
    first = filled[time == 0.0]
    if np.abs(first).max(initial=0.0) > allowed:
        row, axis = np.unravel_index(np.abs(first).argmax(), first.shape)
        raise BadInput(
            f"{path}: {MOVED[axis]} = {first[row, axis]:g} m at time = 0: a run begins with the flat "
            f"sheet at rest; up to {allowed:.2g} m, a tenth of the largest displacement, passes as noise"
        )


def _require_metres(displacement: np.ndarray, sheet: Sheet, names: Sequence[str]) -> None:
    """Raise BadInput for displacements too large to be in metres.

    displacement: (n, 3), nan where not measured; names: name of each row in the message."""
    sizes = np.abs(np.nan_to_num(displacement)).max(axis=1)
    row, side = int(sizes.argmax()), max(sheet.lengths)
    if sizes[row] > FARTHEST * side:
        raise BadInput(
            f"{names[row]}: a displacement of {sizes[row]:g} m on a sheet of {side:g} m: displacements are "
            "in metres"
        )


def _read_cloud(path: Path, sheet: Sheet) -> Surface:
    if not path.is_file():
        raise BadInput(f"{path}: no such file")
    try:
        with np.errstate(invalid="ignore"):  # a damaged file's numbers are looked at below
            points = read_points(path) if path.suffix.lower() == ".ply" else _read_vtp(path)
    except BadInput:
        raise
    except Exception as error:  # VTK's reader has no error of its own for a damaged file
        raise BadInput(f"{path}: cannot be read as a point cloud: {foreign(error)}") from None
    finite = np.isfinite(points).all(axis=1)
    if not finite.all():
        raise BadInput(f"{path}: point {int(np.argmin(finite))} is not finite")
    return _make_surface(path, points, sheet)


def _read_vtp(path: Path) -> np.ndarray:
    import pyvista
    from vtkmodules.vtkCommonCore import vtkObject

    chatty = vtkObject.GetGlobalWarningDisplay()
    vtkObject.GlobalWarningDisplayOff()  # VTK reports a bad file on the terminal and answers with no points
    try:
        return np.asarray(pyvista.read(path).points, dtype=float).reshape(-1, 3)
    finally:
        vtkObject.SetGlobalWarningDisplay(chatty)


def _make_surface(path: Path, points: np.ndarray, sheet: Sheet) -> Surface:
    if not len(points):
        raise BadInput(f"{path}: no points in it")
    centre = np.array([*sheet.lengths, 0.0]) / 2.0
    distances = np.abs(points - centre).max(axis=1)
    if distances.max() > FARTHEST * max(sheet.lengths):
        worst = points[int(np.argmax(distances))]
        raise BadInput(
            f"{path}: point ({', '.join(f'{c:g}' for c in worst)}) is off the sheet; points are in metres, "
            "in the scene's axes"
        )
    return Surface(points, str(path))
