"""What was measured of a deformed sheet: displacements of marked points, or the shape of its surface.

CSV with the header x,y,ux,uy,uz: plan point on the flat sheet, then its displacement, all in metres and in
the scene's axes; a component may be left empty. In the place of x,y a column probe may name probes of the
scene. With a further column time [s] the rows are samples of a motion from rest. Other columns are passed
over.

VTP or PLY: points (x, y, z) [m] of the deformed surface, in the scene's axes. Which material point each of
them is need not be known.
"""

from __future__ import annotations

import csv
from dataclasses import dataclass
from math import isfinite
from pathlib import Path

import numpy as np

from sheetbench.scenes import Scene, Sheet
from sheetbench.scenes.errors import BadInput

PLACE = ("x", "y")
MOVED = ("ux", "uy", "uz")
CLOUDS = (".vtp", ".ply")
FARTHEST = 2.0  # a displacement of so many sides is a wrong unit


@dataclass(frozen=True)
class Displacements:
    """points: (n, 2) [m] of the flat sheet; displacement: (n, 3) [m], nan where not measured; time: (n,) [s]
    of each row, or None for an equilibrium; source: where they come from, to be named in a refusal."""

    points: np.ndarray
    displacement: np.ndarray
    time: np.ndarray | None = None
    source: str = "measured"

    @property
    def measured(self) -> np.ndarray:
        """(n, 3) bool."""
        return np.isfinite(self.displacement)

    @property
    def scale(self) -> float:
        """The largest measured component [m]."""
        return float(np.nanmax(np.abs(self.displacement)))


@dataclass(frozen=True)
class Surface:
    """points: (n, 3) [m] of the deformed surface; source: as of `Displacements`."""

    points: np.ndarray
    source: str = "measured"

    @property
    def scale(self) -> float:
        """The largest height over or under the flat sheet [m]."""
        return float(np.abs(self.points[:, 2]).max())


Measured = Displacements | Surface


def read(path: Path, scene: Scene) -> Measured:
    """The measurements of a file. Raises BadInput naming the file and what is wrong in it."""
    measured = _cloud(path, scene.sheet) if path.suffix.lower() in CLOUDS else _table(path, scene)
    if measured.scale == 0.0:
        raise BadInput(f"{path}: nothing moved: every displacement is 0")
    return measured


def _table(path: Path, scene: Scene) -> Displacements:
    try:
        text = path.read_text(encoding="utf-8-sig")
    except OSError as error:
        raise BadInput(f"{path}: cannot be read: {error.strerror}") from None
    except UnicodeDecodeError:
        raise BadInput(f"{path}: not a text file; a point cloud is named {' or '.join(CLOUDS)}") from None
    reader = csv.DictReader(text.splitlines(), skipinitialspace=True)
    header = [name.strip() for name in reader.fieldnames or ()]
    reader.fieldnames = header
    named = "probe" in header and not set(PLACE) & set(header)
    missing = [name for name in (*(() if named else PLACE), *MOVED) if name not in header]
    if missing:
        raise BadInput(
            f"{path}: column {', '.join(missing)} missing; the header is {','.join(PLACE + MOVED)} (metres)"
        )
    rows, times = [], []
    for row in reader:
        where = f"{path}, line {reader.line_num}"
        if named:
            point = _probe(row["probe"], scene, where)
        else:
            point = [_number(row[name], where, name) for name in PLACE]
            _require_on_sheet(point, scene.sheet, where)
        moved = [_number(row[name], where, name, optional=True) for name in MOVED]
        _require_metres(moved, scene.sheet, where)
        rows.append([*point, *moved])
        if "time" in header:
            times.append(_number(row["time"], where, "time"))
    values = np.array(rows, dtype=float).reshape(-1, 5)
    if not np.isfinite(values[:, 2:]).any():
        raise BadInput(f"{path}: no displacement in it")
    if times and (min(times) < 0.0 or max(times) == 0.0):
        raise BadInput(f"{path}: time: the motion starts at 0 and goes on to later times")
    return Displacements(values[:, :2], values[:, 2:], np.array(times) if times else None, str(path))


def _probe(name: str | None, scene: Scene, where: str) -> list[float]:
    if name not in scene.probes:
        raise BadInput(f"{where}: probe = '{name}': scene '{scene.name}' has {', '.join(scene.probes)}")
    return list(scene.probes[name])


def _number(text: str | None, where: str, name: str, optional: bool = False) -> float:
    if optional and not (text or "").strip():
        return np.nan
    try:
        value = float(text or "")
    except ValueError:
        value = np.nan
    if not isfinite(value):
        raise BadInput(f"{where}: {name} = '{text or ''}': not a number")
    return value


def _require_on_sheet(point: list[float], sheet: Sheet, where: str) -> None:
    slack = 1e-9 * max(sheet.lengths)
    if not all(-slack <= c <= length + slack for c, length in zip(point, sheet.lengths, strict=True)):
        raise BadInput(
            f"{where}: x, y = {point[0]:g}, {point[1]:g} is off the sheet, which is "
            f"0 ≤ x ≤ {sheet.length_x:g} m, 0 ≤ y ≤ {sheet.length_y:g} m"
        )


def _require_metres(moved: list[float], sheet: Sheet, where: str) -> None:
    largest = max((abs(u) for u in moved if isfinite(u)), default=0.0)
    if largest > FARTHEST * max(sheet.lengths):
        raise BadInput(
            f"{where}: a displacement of {largest:g} m on a sheet of {max(sheet.lengths):g} m: "
            "displacements are in metres"
        )


def _cloud(path: Path, sheet: Sheet) -> Surface:
    if not path.is_file():
        raise BadInput(f"{path}: no such file")
    import pyvista
    from vtkmodules.vtkCommonCore import vtkObject

    chatty = vtkObject.GetGlobalWarningDisplay()
    vtkObject.GlobalWarningDisplayOff()  # VTK reports a bad file on the terminal and answers with no points
    try:
        points = np.asarray(pyvista.read(path).points, dtype=float)
    except (OSError, ValueError, RuntimeError, AttributeError) as error:
        raise BadInput(f"{path}: cannot be read as a point cloud: {error}") from None
    finally:
        vtkObject.SetGlobalWarningDisplay(chatty)
    if not len(points):
        raise BadInput(f"{path}: no points in it")
    if not np.isfinite(points).all():
        raise BadInput(f"{path}: point {int(np.argmin(np.isfinite(points).all(axis=1)))} is not finite")
    centre = np.array([*sheet.lengths, 0.0]) / 2.0
    away = np.linalg.norm(points - centre, axis=1)
    if away.max() > FARTHEST * max(sheet.lengths):
        worst = points[int(np.argmax(away))]
        raise BadInput(
            f"{path}: point ({', '.join(f'{c:g}' for c in worst)}) is off the sheet; points are in metres, "
            "in the scene's axes"
        )
    return Surface(points, str(path))
